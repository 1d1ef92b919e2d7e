"""The front page: findings that follow their verdicts, questions that are answered from tables, and their ways."""

import re
from pathlib import Path

import pandas as pd
import pytest

from stages.report.cells import CLAIMS as OF_CLAIMS
from stages.report.site import FINDINGS, findings_html, questions, questions_html
from stages.report.topics import CLAIMS, KINDS, TOPICS

REPORTS = Path(__file__).parents[2] / "reports"
ASKED = 10


def of_claim(one, effect=10.0, low=5.0, high=15.0):
    """(claims, differences) of a single finding with its verdict."""
    verdict = "supported" if low > 0 else "contradicted" if high < 0 else "open"
    row = {"key": one.key, "claim": "The sentence.", "verdict": verdict, "effect": effect, "low": low, "high": high}
    pairs = pd.DataFrame({"key": one.key, "pair": ["a<b", "c", "other set"], "difference": [low, high, 1.0]})
    row |= {"pairs": 2, "over": "objects", "section": "ours", "of": ""}
    return pd.DataFrame([row]), pairs.assign(judged=[True, True, False])


def test_findings_are_claims_of_their_topics_and_two_of_them_fail():
    of_topic = {claim.key: topic.__name__.rpartition(".")[2] for topic in TOPICS for claim in topic.CLAIMS}
    assert len(FINDINGS) == 5
    assert all(of_topic[one.key] == one.topic for one in FINDINGS)
    assert sum(one.verdict != "supported" for one in FINDINGS) >= 2


@pytest.mark.parametrize("one", FINDINGS, ids=lambda one: one.key)
def test_the_stored_verdicts_are_those_of_the_titles(one):
    claims = pd.read_csv(REPORTS / "claims.csv").set_index("key")
    assert claims.loc[one.key, "verdict"] == one.verdict


def test_a_card_has_its_figure_its_chart_and_its_pairs():
    text = findings_html(*of_claim(FINDINGS[0], 1.0, 0.5, 1.5))
    assert FINDINGS[0].title in text and "+1.00 [0.50, 1.50]" in text
    assert re.findall(r"<title>(.*?) · ", text) == ["a&lt;b", "c", "mean"]
    assert f'href="site/claims.html#{FINDINGS[0].key}"' in text


def test_a_title_that_a_run_does_not_bear_out_gives_way_to_the_claim():
    text = findings_html(*of_claim(FINDINGS[0], 0.0, -0.5, 0.5))
    assert FINDINGS[0].title not in text and "The sentence. (open)" in text


def test_what_is_shown_of_a_difference_is_ordered_after_it_is_turned():
    kept = next(one for one in FINDINGS if one.shown == "times:")
    assert "3.00 [1.00, 4.00]" in findings_html(*of_claim(kept, -100.0, -120.0, 0.0))


def test_without_measured_findings_there_is_no_section():
    assert findings_html(pd.DataFrame(columns=["key", "low", "verdict"]), pd.DataFrame()) == ""


def test_ten_questions_are_answered_from_what_the_repository_holds():
    names = {f"{kind}/{name}" for topic in TOPICS for kind, held in KINDS.items() for name in getattr(topic, held)}
    keys = {f"key={claim.key}" for claim in CLAIMS}

    def link(source, where):
        assert source in names or (source == OF_CLAIMS and where in keys)
        return source

    found = questions(REPORTS, link)
    assert len(found) == ASKED
    assert all(re.search(r"\d", answer) and "{" not in answer for _, answer, _ in found)
    assert questions_html(found).count("<h3>") == ASKED


def test_questions_without_measurements_are_left_out(tmp_path):
    assert questions(tmp_path, lambda *_: "") == [] and questions_html([]) == ""

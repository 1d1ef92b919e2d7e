"""Parts of the pages: tables and charts with their numbers, findings and questions; some of them in a browser."""

import base64
import io
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure as Drawing
from PIL import Image

from stages.report.cells import CLAIMS as OF_CLAIMS
from stages.report.claims import load
from stages.report.items import Built, Figure, Table
from stages.report.page import frame_html, item_html, prose, small_picture
from stages.report.site import FINDINGS, findings_html, front_main, page, questions, questions_html
from stages.report.tables import Ranking
from stages.report.topics import KINDS, TOPICS

REPORTS = Path(__file__).parents[2] / "reports"
ASKED = 10


def show(tab, tmp_path, main):
    """Opens a page of the site with this text."""
    (tmp_path / "page.html").write_text(page([], "", "", main, ["site.js"]), encoding="utf-8")
    tab.goto((tmp_path / "page.html").as_uri())


def column(tab, number):
    """The visible cells of a column."""
    return tab.locator(f"tbody tr:visible td:nth-child({number})").all_inner_texts()


def chart(tmp_path):
    """A figure of three points with one interval, written and with its words."""
    drawing = Drawing()
    axes = drawing.subplots()
    axes.plot([1, 2, 3], [0.1, 0.2, 0.3], "o-", label="kNN")
    axes.plot([2, 2], [0.15, 0.25])
    item = Figure(drawing, name="chart", title="A chart", alt="What it shows to all", caption="See `this`.")
    item.write(tmp_path / "figures")
    return item


def test_a_chart_has_its_numbers_behind_it(tmp_path):
    text = item_html(chart(tmp_path))
    assert "<svg" in text and "<img" not in text
    assert text.count("<tr><td") == 3 and "<td>[0.150, 0.250]</td>" in text.replace(' class="number"', "")


def test_the_summary_stands_over_a_table_and_the_notes_are_folded():
    notes, paths = ["first `x`", "second"], [Path("tables/t.csv")]
    text = item_html(Table(pd.DataFrame({"x": [1]}), notes=notes, paths=paths, summary="Found: `1`."))
    assert prose("`a<b` and ` alone") == "<code>a&lt;b</code> and ` alone"
    shown, _, hidden = text.partition("<details>")
    assert shown.index("Found: <code>1</code>.") < shown.index("<table>") and "first" not in shown
    assert "first <code>x</code>" in hidden and "second" in hidden


def test_columns_that_do_not_answer_the_question_can_be_unfolded():
    frame = pd.DataFrame({"name": ["a", "b"], "score": [1, 2], "detail": [3, 4]})
    table = Table(frame, paths=[Path("tables/t.csv")], best=Ranking("score"), answer=["name", "score"])
    shown, _, hidden = item_html(table).partition("<details>")
    assert "detail" not in shown and "All 3 columns" in hidden and "detail" in hidden
    assert '<tr class="best"><td>b</td>' in shown and shown.count('class="best"') == hidden.count('class="best"') == 1


@pytest.mark.slow
def test_a_click_on_a_head_sorts_by_number_both_ways_and_gaps_stay_below(tab, tmp_path):
    values = ["9", "–", "1,000 [900, 1,100]", "+12.5", "-3", "> 45"]
    show(tab, tmp_path, frame_html(pd.DataFrame({"name": list("abcdef"), "value": values}), "Values"))
    tab.get_by_role("button", name="value").click()
    assert column(tab, 1) == ["e", "a", "d", "f", "c", "b"]
    assert tab.locator("th").nth(1).get_attribute("aria-sort") == "ascending"
    tab.get_by_role("button", name="value").press("Enter")
    assert column(tab, 1) == ["c", "f", "d", "a", "e", "b"]
    tab.get_by_role("button", name="name").click()
    assert column(tab, 1) == list("abcdef")
    assert tab.locator("th[aria-sort]").count() == 1


@pytest.mark.slow
def test_a_filter_shows_the_rows_that_hold_all_words(tab, tmp_path):
    frame = pd.DataFrame(
        {"name": [f"row {k}" for k in range(10)], "kind": ["odd" if k % 2 else "even" for k in range(10)]}
    )
    show(tab, tmp_path, frame_html(frame, "Rows"))
    tab.get_by_label("Filter").fill("ODD row 3")
    assert column(tab, 1) == ["row 3"]
    assert "1 of 10 rows" in tab.locator(".filter").inner_text()
    tab.get_by_label("Filter").fill("")
    assert len(column(tab, 1)) == 10


@pytest.mark.slow
def test_a_chart_tells_its_values_to_pointer_and_keyboard(tab, tmp_path):
    show(tab, tmp_path, item_html(chart(tmp_path)))
    tab.locator(".hits circle").nth(1).hover()
    assert tab.locator("#tip").inner_text() == "kNN · 2 · 0.200 [0.150, 0.250]"
    tab.mouse.move(0, 0)
    assert tab.locator("#tip").is_hidden()
    box = tab.locator(".wide")
    for key, value in (
        ("ArrowRight", "0.100"),
        ("ArrowRight", "0.200"),
        ("ArrowLeft", "0.100"),
        ("ArrowLeft", "0.300"),
    ):
        box.press(key)
        assert value in tab.locator("#tip").inner_text()
    box.press("Escape")
    assert tab.locator("#tip").is_hidden()


def test_a_picture_of_many_colours_is_shrunk(tmp_path):
    noise = np.random.default_rng(0).integers(0, 255, (400, 1200, 3), dtype=np.uint8)
    Image.fromarray(noise).save(tmp_path / "noise.png")
    shown = Image.open(io.BytesIO(base64.b64decode(small_picture(tmp_path / "noise.png"))))
    assert shown.size == (900, 300)


@pytest.mark.parametrize(("cell", "whole"), [("not run · 3", False), ("3", True)])
def test_a_table_with_gaps_is_listed_among_what_was_not_run(cell, whole):
    table = Table(pd.DataFrame({"x": [cell]}), name="gaps", topic="none", paths=[Path("tables/t.csv")])
    parts = {kind: Built() for kind in ("figures", "tradeoff")} | {"tables": Built([table]), "claims": pd.DataFrame()}
    parts |= {"first": [], "not_run": {}, "meshes": None, "own": True, "dataset": ""}
    page = front_main(parts, {}, {}, Path("reports"))
    assert ("Everything that this report knows was measured" in page) == whole
    assert ("<code>tables/gaps</code>: in part" in page) != whole


def of_claim(claim_of_page, effect=10.0, low=5.0, high=15.0):
    """(claims, differences) of a single finding with its verdict."""
    verdict = "supported" if low > 0 else "contradicted" if high < 0 else "open"
    row = {
        "key": claim_of_page.key,
        "claim": "The sentence.",
        "verdict": verdict,
        "effect": effect,
        "low": low,
        "high": high,
    }
    pairs = pd.DataFrame({"key": claim_of_page.key, "pair": ["a<b", "c", "other set"], "difference": [low, high, 1.0]})
    row |= {"pairs": 2, "over": "objects", "section": "ours", "of": ""}
    return pd.DataFrame([row]), pairs.assign(judged=[True, True, False])


def test_findings_are_claims_with_the_stored_verdicts_and_two_of_them_fail():
    stored = pd.read_csv(REPORTS / "claims.csv").set_index("key")["verdict"]
    assert [stored[finding.key] for finding in FINDINGS] == [finding.verdict for finding in FINDINGS]
    assert sum(finding.verdict != "supported" for finding in FINDINGS) >= 2


def test_a_card_has_its_figure_its_chart_and_its_pairs():
    text = findings_html(*of_claim(FINDINGS[0], 1.0, 0.5, 1.5))
    assert FINDINGS[0].title in text and "+1.00 [0.50, 1.50]" in text
    assert re.findall(r"<title>(.*?) · ", text) == ["a&lt;b", "c", "mean"]
    assert f'href="site/claims.html#{FINDINGS[0].key}"' in text


@pytest.mark.slow
def test_a_title_that_a_run_does_not_bear_out_gives_way_to_the_claim():
    text = findings_html(*of_claim(FINDINGS[0], 0.0, -0.5, 0.5))
    assert FINDINGS[0].title not in text and "The sentence. (open)" in text
    kept = next(
        finding for finding in FINDINGS if finding.shown == "times:"
    )  # whose ends are ordered after they are turned
    assert "3.00 [1.00, 4.00]" in findings_html(*of_claim(kept, -100.0, -120.0, 0.0))
    assert findings_html(pd.DataFrame(columns=["key", "low", "verdict"]), pd.DataFrame()) == ""


def test_ten_questions_are_answered_from_what_the_repository_holds(tmp_path):
    names = {f"{kind}/{name}" for topic in TOPICS for kind, held in KINDS.items() for name in getattr(topic, held)}
    keys = {f"key={claim.key}" for claim in load()}

    def link(source, where):
        assert source in names or (source == OF_CLAIMS and where in keys)
        return source

    answers = questions(REPORTS, link)
    assert len(answers) == ASKED
    assert all(re.search(r"\d", answer) and "{" not in answer for _, answer, _ in answers)
    assert questions_html(answers).count("<h3>") == ASKED
    assert questions(tmp_path, link) == [] and questions_html([]) == ""  # without measurements

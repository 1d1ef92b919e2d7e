"""What became of the thesis: its rows, their words and where they are shown."""

import re
from pathlib import Path

import pandas as pd
import pytest
import yaml

from haptic_glance.base.files import write_table
from stages.charts.cells import PLACE
from stages.report import thesis_page
from stages.report.claims import load
from stages.report.parts import KINDS, PARTS
from stages.report.thesis_page import COLUMNS, thesis_frame, thesis_html, thesis_text

REPORTS = Path(__file__).parents[2] / "reports"
ENTRIES = yaml.safe_load((Path(thesis_page.__file__).parent / "page/thesis.yaml").read_text())


def test_twelve_to_fifteen_conclusions_are_claims_in_a_few_words_each():
    keys = {claim.key for claim in load()}
    names = {
        f"{kind}/{name}" for part in PARTS.values() for kind, held in KINDS.items() for name in getattr(part, held)
    }
    assert 12 <= len(ENTRIES) <= 15
    for entry in ENTRIES:
        assert entry["claim"] in keys and entry["see"] in names
        assert len(entry["conclusion"].split()) <= 12 and len(PLACE.sub("1", entry["why"]).split()) <= 25
        for table, where, _ in PLACE.findall(entry["why"]):
            assert table in names if "/" in table else re.search(r"key=(\w+)", where)[1] in keys
        assert len(PLACE.findall(entry["why"])) <= 1


def test_every_conclusion_is_published_with_its_numbers():
    frame = thesis_frame(REPORTS)
    assert len(frame) == len(ENTRIES) and not (frame[list(COLUMNS)] == "").any().any()
    assert frame["measured"].str.contains(r"\d").all() and not frame["why"].str.contains("[{}]").any()
    assert (REPORTS / "thesis.md").read_text().strip() == thesis_text(frame).strip()


@pytest.fixture
def one(tmp_path):
    """The frame of a single conclusion that was measured."""
    row = {"key": "equal_over_itti", "verdict": "contradicted", "effect": -7.61, "low": -11.8, "high": -3.47}
    row |= {"unit": "points", "printed": "12 points, table 4.1", "size": "opposite"}
    rival = row | {"key": "itti_over_blind", "effect": 12.0, "low": 8.0, "high": 16.5}
    write_table(tmp_path / "claims.csv", pd.DataFrame([row, rival]))
    return thesis_frame(tmp_path)


def test_a_row_has_the_printed_effect_beside_ours_and_those_that_were_not_measured_go(one):
    (row,) = one.itertuples()
    assert (row.printed, row.measured, row.verdict) == ("+12 points", "-7.6 [-11.8, -3.5] points", "contradicted")
    assert "| contradicted, opposite sign |" in thesis_text(one) and "[table 4.1](tables/table_4_1.md)" in thesis_text(
        one
    )


def test_the_page_links_each_verdict_to_its_claim_and_names_its_cells(one):
    text = thesis_html(one, lambda see: f"site/know.html#{see}")
    assert 'href="site/claims.html#equal_over_itti"' in text and 'href="site/know.html#tables/table_4_1"' in text
    assert re.findall('data-label="([^"]+)"', text) == list(COLUMNS[1:])
    assert "draws 1 main conclusions. Measured again on other objects, 0 are supported and 1 contradicted" in text

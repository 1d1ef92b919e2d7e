"""What a topic found: its figures come from tables and claims, and no other number is typed."""

import re
from pathlib import Path
from types import ModuleType

import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from stages.report import topics
from stages.report.cells import CLAIMS, COLUMN, ENDS, PAIR, PLACE, ROWS, filled, parts_of
from stages.report.claims_page import findings
from stages.report.items import Table
from stages.report.site import topic_main

REPORTS = Path(__file__).parents[2] / "reports"
SETTINGS = (  # the numbers that a finding may have of its own
    r"\b\d+ x \d+\b", r"\b(?:19|20)\d\d\b", r"\bT\d+(?:\.\d+)*", r"\bSection \d+(?:\.\d+)*", r"\b\d+ degrees\b",
    r"\b[Ll]ayers \d+ to \d+\b", r"\bnoise of [\d.]+ % of the diagonal", r"\b(?:VGG|ResNet|MobileNetV)\d+\b",
)  # fmt: skip
PARAGRAPHS = [
    (f"{topic.__name__.rpartition('.')[2]} {number}", " ".join(text.split()))
    for topic in topics.TOPICS
    for number, text in enumerate(Path(str(topic.__file__)).with_name("findings.md").read_text().strip().split("\n\n"))
]
PLACES = sorted({place for _, text in PARAGRAPHS for place in PLACE.findall(text)})
MADE = {f"{kind}/{name}" for topic in topics.TOPICS for kind in ("tables", "tradeoff")
        for name in getattr(topic, topics.KINDS[kind])}  # fmt: skip
KEYS = {claim.key for claim in topics.CLAIMS}
paragraphs = pytest.mark.parametrize("text", [text for _, text in PARAGRAPHS], ids=[name for name, _ in PARAGRAPHS])


def typed(text):
    """The numbers of a text that are neither places nor settings."""
    return re.findall(r"\d+", re.sub("|".join(SETTINGS), "", PLACE.sub("", text)))


def columns_of(where, what):
    """The columns that a place reads."""
    plain = [COLUMN.fullmatch(wanted)[3] for wanted in parts_of(what)[0]]
    rows = [value if column in ENDS else column for column, _, value in PAIR.findall(where)]
    return {*plain, *rows} - {ROWS}


@paragraphs
def test_a_finding_has_no_number_of_its_own(text):
    assert not typed(text)
    assert "{" not in PLACE.sub("", text)


@pytest.mark.parametrize("text", ["It has 0.5.", "On 19 meshes.", "It is 3 times faster.", "71 % of them."])
def test_a_typed_number_is_found(text):
    assert typed(text)


@paragraphs
def test_a_sentence_has_one_figure(text):
    for sentence in re.split(r"(?<=[.:])\s(?=[A-Z])", PLACE.sub(lambda found: f"<{found[1]} {found[2]}>", text)):
        assert len(set(re.findall("<.*?>", sentence))) <= 1, sentence


@pytest.mark.parametrize("place", PLACES, ids=lambda place: " ".join(place)[:90])
def test_a_figure_has_its_table(place):
    name, where, what = place
    if name == CLAIMS:
        assert where.removeprefix("key=") in KEYS
    else:
        assert name in MADE or name.startswith("bench/")
    path = REPORTS / f"{name}.csv"
    if not path.exists():
        pytest.skip(f"{name} is still to be written")
    assert columns_of(where, what) <= {*pd.read_csv(path, nrows=0).columns}


@paragraphs
def test_a_finding_has_all_its_figures(text):
    """A row that is gone would leave the paragraph out without a word."""
    for name, where, _ in PLACE.findall(text):
        if not (REPORTS / f"{name}.csv").exists():
            pytest.skip(f"{name} is still to be written")
        if name == CLAIMS and where.removeprefix("key=") not in {*pd.read_csv(REPORTS / "claims.csv")["key"]}:
            pytest.skip(f"the verdict of {where} is still to be written")
    said, _ = filled(text, REPORTS)
    assert not re.search(r"\{|\}|\bnan\b|_", said)


@pytest.fixture
def topic(tmp_path, monkeypatch):
    """A topic that found three things, one of them in a table of one row."""
    package = tmp_path / "a_topic_with_findings"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "findings.md").write_text(
        "Without a figure,\nit stays.\n\nIt has {tables/t method=one: mean}.\n\nIt has {tables/t method=two:\nmean}.\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    module = ModuleType(package.name)
    module.__dict__["CLAIMS"] = []
    write_table(tmp_path / "tables/t.csv", pd.DataFrame({"method": ["one"], "mean": [2.5]}))
    return module


def test_a_paragraph_that_lacks_its_row_is_left_out(topic, tmp_path):
    assert findings(topic, tmp_path) == ["Without a figure, it stays.", "It has 2.50."]


@pytest.mark.parametrize("own", [False, True])
def test_what_was_found_on_other_meshes_is_not_said_of_ones_own(topic, tmp_path, own):
    parts = {"claims": pd.DataFrame({"key": []}), "sets": ["household"], "own": own}
    text = topic_main(topic, parts, [Table(pd.DataFrame(), title="T", paths=[Path("tables/t.csv")])], tmp_path)
    assert ("<p>It has 2.50.</p>" in text) == ("What was found" in text) == (not own)

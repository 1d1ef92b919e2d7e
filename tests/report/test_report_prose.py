"""The words of the report: titles, notes, captions and findings, and the figures in them, which come from tables."""

import importlib
import re
import sys
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import read_json, write_table
from stages.charts import items
from stages.charts.cells import CLAIMS, PLACE, filled
from stages.charts.items import Figure, Table, add_words, findings
from stages.report import parts
from stages.report.headlines import write_headlines
from stages.report.parts import Built
from stages.report.site import page_main

REPORTS = Path(__file__).parents[2] / "reports"
LONGEST = 200  # letters of a table's sentence
SETTINGS = (  # the numbers that a finding may have of its own
    r"\b\d+ x \d+\b", r"\b(?:19|20)\d\d\b", r"\bT\d+(?:\.\d+)*", r"\bSection \d+(?:\.\d+)*", r"\b\d+ degrees\b",
    r"\b[Ll]ayers \d+ to \d+\b", r"\bnoise of [\d.]+ % of the diagonal", r"\b(?:VGG|ResNet|MobileNetV)\d+\b",
)  # fmt: skip
MADE = {f"{kind}/{name}" for part in parts.PARTS.values() for kind in ("tables", "tradeoff")
        for name in getattr(part, parts.KINDS[kind])}  # fmt: skip
PROSE = """# tables/one: One of {count}

- The first note
  goes on. {count:,} in all.
- {more}
- {nothing}

# figures/one: A picture

Alt: What it
shows.

The caption of {count}.
"""
FINDINGS = (
    "Without a figure,\nit stays.\n\nIt has {tables/t method=one: mean}.\n\nIt has {tables/t method=two:\nmean}.\n"
)


class Anything(dict):
    """Words for any prose."""

    def __missing__(self, key):
        return 0


def typed(text):
    """The numbers of a text that are neither places nor settings."""
    return re.findall(r"\d+", re.sub("|".join(SETTINGS), "", PLACE.sub("", text)))


@pytest.fixture
def topic(tmp_path, monkeypatch):
    """A part with two items, which found three things, one of them in a table of one row."""
    package = tmp_path / "a_stage"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "report.py").write_text('PAGE = "attention"\n')
    (package / "report.md").write_text(PROSE)
    (package / "findings.md").write_text(FINDINGS)
    monkeypatch.syspath_prepend(tmp_path)
    write_table(tmp_path / "tables/t.csv", pd.DataFrame({"method": ["one"], "mean": [2.5]}))
    items._sections.cache_clear()
    yield importlib.import_module("a_stage.report")
    for name in ("a_stage.report", "a_stage"):
        del sys.modules[name]


def table(**words):
    return Table(pd.DataFrame(), words={"count": 1200, "more": "second\nthird", "nothing": ""} | words)


def test_prose_is_joined_filled_split_and_left_out_when_empty(topic):
    item, figure = table(), Figure(Drawing(), {"count": 3})
    add_words(item, topic, "tables", "one")
    assert (item.name, item.title) == ("one", "One of 1200")
    assert item.notes == ["The first note goes on. 1,200 in all.", "second", "third"]
    add_words(figure, topic, "figures", "one")
    assert (figure.title, figure.alt, figure.caption) == ("A picture", "What it shows.", "The caption of 3.")


def test_a_word_or_section_that_is_missing_is_an_error(topic):
    with pytest.raises(KeyError, match="count"):
        add_words(Figure(Drawing()), topic, "figures", "one")
    with pytest.raises(KeyError, match="tables/two"):
        add_words(table(), topic, "tables", "two")


@pytest.mark.parametrize("part", parts.PARTS.values(), ids=parts.PARTS)
def test_each_item_has_its_section_and_each_section_its_item(part):
    text = (Path(part.__file__).parent / "report.md").read_text()
    wanted = {f"{kind}/{name}" for kind, attribute in parts.KINDS.items() for name in getattr(part, attribute)}
    sections = [name for name in re.findall(r"^# (\S+):", text, re.MULTILINE) if not name.startswith("shared/")]
    assert sorted(sections) == sorted(wanted)


def test_every_part_is_in_the_reading_order_and_an_output_belongs_to_one():
    stages = {path.parent.name for path in Path(parts.__file__).parents[1].glob("*/report.py")}
    assert set(parts.PARTS) == stages | {"report"}
    for kind in parts.KINDS.values():
        names = [name for part in parts.PARTS.values() for name in getattr(part, kind)]
        assert len(names) == len(set(names)) > 0


@pytest.mark.parametrize("part", parts.PARTS.values(), ids=parts.PARTS)
def test_each_table_has_a_sentence_with_a_figure_of_its_own(part):
    for name in part.TABLES:
        item = Table(pd.DataFrame(), words=Anything())
        add_words(item, part, "tables", name)
        if not (REPORTS / f"tables/{name}.csv").exists():
            continue  # it is still to be written
        text, sources = filled(item.summary, REPORTS)
        assert f"tables/{name}" in [source for source, _ in sources]
        assert len(text) <= LONGEST and text[0].isupper() and text.endswith(".") and re.search(r"\d", text)
        assert not re.search(r"\d \.|\{|\}|\bnan\b|_", text), text


@pytest.mark.parametrize(("method", "expected_summary"), [("one", "It is 1."), ("two", "")])
def test_a_sentence_without_its_row_is_left_out_and_the_notes_stay(tmp_path, method, expected_summary):
    frame, summary = pd.DataFrame({"method": ["one"], "mean": [1.0]}), f"It is {{tables/t method={method}: mean}}."
    item = Table(frame, name="t", title="T", notes=["a note"], summary=summary)
    item.write(tmp_path / "tables")
    text = (tmp_path / "tables/t.md").read_text()
    assert item.summary == expected_summary and ("# T\n\nIt is 1.\n\n| method" in text) == bool(expected_summary)
    assert "<details><summary>How to read it</summary>\n\n- a note\n\n</details>" in text


@pytest.mark.parametrize("part", parts.PARTS.values(), ids=parts.PARTS)
def test_a_finding_has_all_its_figures_and_no_number_of_its_own(part):
    """A row that is gone would leave the paragraph out without a word."""
    file = Path(part.__file__).parent / "findings.md"
    for text in file.read_text().strip().split("\n\n") if file.exists() else ():
        text = " ".join(text.split())
        if not all((REPORTS / f"{name}.csv").exists() for name, _, _ in PLACE.findall(text)):
            continue  # a table is still to be written
        prose, sources = filled(text, REPORTS)
        assert not typed(text) and not re.search(r"\{|\}|\bnan\b|_", prose), prose
        assert all(name in MADE or name == CLAIMS or name.startswith("bench/") for name, _ in sources)


@pytest.mark.parametrize("of_folder", [False, True])
def test_a_paragraph_that_lacks_its_row_is_left_out_and_so_are_all_of_ones_own_meshes(
    topic, tmp_path, of_folder, small, bare, monkeypatch
):
    assert findings(topic, tmp_path) == ["Without a figure, it stays.", "It has 2.50."]
    monkeypatch.setattr("stages.report.site.PARTS", {"one": topic})
    monkeypatch.setattr("stages.charts.results.Results.own_meshes", of_folder)
    item = Table(pd.DataFrame(), title="T", kind="tables", page="attention", paths=[Path("tables/t.csv")])
    text = page_main("attention", small.read_results(bare), Built([item]), tmp_path)
    assert ("<p>It has 2.50.</p>" in text) == ("What was found" in text) == (not of_folder)


def test_headlines_on_a_folder_of_meshes_count_no_claims(tmp_path):
    for verdicts, names in (
        ({"supported": 2}, {"claims_supported", "claims_contradicted", "claims_open"}),
        (None, set()),
    ):
        write_headlines(tmp_path, verdicts)
        assert read_json(tmp_path / "headlines.json").keys() == names

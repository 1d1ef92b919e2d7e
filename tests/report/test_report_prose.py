"""The words of the report: titles, notes, captions and findings, and the figures in them, which come from tables."""

import importlib
import re
import sys
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import read_json
from stages.charts import items
from stages.charts.cells import CLAIMS, PLACE, filled
from stages.charts.items import Figure, Table, add_words
from stages.report import parts
from stages.report.headlines import write_headlines
from stages.report.parts import Built
from stages.report.site import findings, topic_main
from stages.report.topics import TOPICS

REPORTS = Path(__file__).parents[2] / "reports"
MOST_FINDINGS, MOST_WORDS, LONGEST_NOTE = 3, 25, 60  # of a page; of a sentence; of a note, in words
FINDINGS = re.split(r"^# (\w+)\n", (Path(parts.__file__).parent / "findings.md").read_text(), flags=re.MULTILINE)[1:]
BY_PAGE = {page: text.strip().split("\n\n") for page, text in zip(FINDINGS[::2], FINDINGS[1::2], strict=True)}
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


class Anything(dict):
    """Words for any prose."""

    def __missing__(self, key):
        return 0


def words_of(text):
    """How many words a text has; a number with its interval is one, a place in it too."""
    return len(re.sub(r" ?\[[^]]*\]", "", PLACE.sub("x", text)).split())


def typed(text):
    """The numbers of a text that are neither places nor settings."""
    return re.findall(r"\d+", re.sub("|".join(SETTINGS), "", PLACE.sub("", text)))


@pytest.fixture
def topic(tmp_path, monkeypatch):
    """A part with two items."""
    package = tmp_path / "a_stage"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "report.py").write_text('PAGE = "look"\n')
    (package / "report.md").write_text(PROSE)
    monkeypatch.syspath_prepend(tmp_path)
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
        assert words_of(text) <= MOST_WORDS and text[0].isupper() and text.endswith(".") and re.search(r"\d", text)
        assert "[" not in text, text
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
def test_notes_are_short(part):
    text = (Path(part.__file__).parent / "report.md").read_text()
    for section in re.split(r"^# .*$", text, flags=re.MULTILINE):
        for note in re.split(r"^- ", section, flags=re.MULTILINE)[1:]:
            assert words_of(note) <= LONGEST_NOTE, note
            sentences = re.split(r"[.;:]\s+", re.sub(r"\beq\. ", "eq ", note))
            assert all(words_of(sentence) <= MOST_WORDS for sentence in sentences), note


@pytest.mark.parametrize("page", BY_PAGE)
def test_a_page_has_at_most_three_short_findings_with_all_their_figures_and_no_number_of_their_own(page):
    """A row that is gone would leave the sentence out without a word."""
    assert page in TOPICS and 1 <= len(BY_PAGE[page]) <= MOST_FINDINGS
    for text in (" ".join(text.split()) for text in BY_PAGE[page]):
        prose, sources = filled(text, REPORTS)
        assert words_of(prose) <= MOST_WORDS and prose.count("[") <= 1 and len(sources) == 1, prose
        assert not typed(text) and not re.search(r"\{|\}|\bnan\b|_", prose), prose
        assert sources[0][0] in MADE or sources[0][0] == CLAIMS


@pytest.mark.parametrize("of_folder", [False, True])
def test_a_finding_that_lacks_its_row_is_left_out_and_so_are_all_of_ones_own_meshes(
    tmp_path, of_folder, small, bare, monkeypatch
):
    assert findings("look", REPORTS) and findings("look", tmp_path) == [] and findings("gone", REPORTS) == []
    monkeypatch.setattr("stages.charts.results.Results.own_meshes", of_folder)
    item = Table(pd.DataFrame(), title="T", name="t", kind="tables", page="look", paths=[Path("tables/t.csv")])
    text = topic_main("look", small.read_results(bare), Built([item]), REPORTS)
    assert ("What was found" in text) == (not of_folder) and 'id="tables-t"' in text


def test_headlines_on_a_folder_of_meshes_count_no_claims(tmp_path):
    for verdicts, names in (
        ({"supported": 2}, {"claims_supported", "claims_contradicted", "claims_open"}),
        (None, set()),
    ):
        write_headlines(tmp_path, verdicts)
        assert read_json(tmp_path / "headlines.json").keys() == names

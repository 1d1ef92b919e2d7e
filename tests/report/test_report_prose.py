"""Titles, notes and captions: each item has its section of prose.md, and each section its item."""

import re
from pathlib import Path
from types import ModuleType

import pandas as pd
import pytest
from matplotlib.figure import Figure as Drawing

from stages.report import topics
from stages.report.claims_page import add_words
from stages.report.items import Figure, Table

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


@pytest.fixture
def topic(tmp_path, monkeypatch):
    """A topic with two items."""
    package = tmp_path / "a_topic_with_prose"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "prose.md").write_text(PROSE)
    monkeypatch.syspath_prepend(tmp_path)
    return ModuleType(package.name)


def table(**words):
    return Table(pd.DataFrame(), words={"count": 1200, "more": "second\nthird", "nothing": ""} | words)


def test_notes_are_joined_filled_split_and_left_out_when_empty(topic):
    item = table()
    add_words(item, topic, "tables", "one")
    assert (item.name, item.title) == ("one", "One of 1200")
    assert item.notes == ["The first note goes on. 1,200 in all.", "second", "third"]


def test_a_figure_has_alt_and_caption(topic):
    item = Figure(Drawing(), {"count": 3})
    add_words(item, topic, "figures", "one")
    assert (item.title, item.alt, item.caption) == ("A picture", "What it shows.", "The caption of 3.")


def test_a_word_or_section_that_is_missing_is_an_error(topic):
    with pytest.raises(KeyError, match="count"):
        add_words(Figure(Drawing()), topic, "figures", "one")
    with pytest.raises(KeyError, match="tables/two"):
        add_words(table(), topic, "tables", "two")


@pytest.mark.parametrize("topic", topics.TOPICS, ids=lambda topic: topic.__name__.rpartition(".")[2])
def test_each_item_has_its_section_and_each_section_its_item(topic):
    text = (Path(topic.__file__).parent / "prose.md").read_text()
    items = {f"{kind}/{name}" for kind, attribute in topics.KINDS.items() for name in getattr(topic, attribute)}
    sections = [name for name in re.findall(r"^# (\S+):", text, re.MULTILINE) if not name.startswith("shared/")]
    assert sorted(sections) == sorted(items)
    assert len((Path(topic.__file__).parent / "findings.md").read_text()) > 100

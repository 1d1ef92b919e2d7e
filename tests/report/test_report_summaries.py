"""Each table has one sentence that says what it found, and its figures are the table's own."""

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest

from haptic_glance.base.files import read_json, write_table
from stages.report import topics
from stages.report.cells import PAIR, PLACE, filled
from stages.report.claims_page import add_words
from stages.report.items import Table
from stages.report.records import write_headlines

REPORTS = Path(__file__).parents[2] / "reports"
LONGEST = 200


class Anything(dict):
    """Words for any prose."""

    def __missing__(self, key):
        return 0


def template(topic, name):
    """The sentence of a table, its figures not yet filled in."""
    table = Table(pd.DataFrame(), words=Anything())
    add_words(table, topic, "tables", name)
    return table.summary


SAID = {name: template(topic, name) for topic in topics.TOPICS for name in topic.TABLES}


@pytest.mark.parametrize("name", SAID)
def test_each_table_has_a_sentence_with_a_figure_of_its_own(name):
    assert SAID[name]
    if not (REPORTS / f"tables/{name}.csv").exists():
        pytest.skip("its table is still to be written")
    text, sources = filled(SAID[name], REPORTS)
    assert (f"tables/{name}") in [source for source, _ in sources]
    assert len(text) <= LONGEST and text[0].isupper() and text.endswith(".") and re.search(r"\d", text)
    assert not re.search(r"\d \.|\{|\}|\bnan\b|_", text), text


@pytest.mark.parametrize("name", SAID)
def test_a_table_with_other_numbers_has_another_sentence(tmp_path, name):
    """Half of the rows that a sentence counts, or other numbers."""
    if not (REPORTS / f"tables/{name}.csv").exists():
        pytest.skip("its table is still to be written")
    frame = pd.read_csv(REPORTS / f"tables/{name}.csv", keep_default_na=False, na_values=[""])
    floats = (
        frame.select_dtypes("float").columns if frame.select_dtypes("float").size else frame.select_dtypes("number")
    )
    picked = {column for _, where, _ in PLACE.findall(SAID[name]) for column, _, _ in PAIR.findall(where)}
    other = (
        frame.iloc[: len(frame) // 2]
        if ": rows}" in SAID[name]
        else frame.assign(**{column: 0.7 * frame[column] for column in set(floats) - picked})
    )
    write_table(tmp_path / f"tables/{name}.csv", other)
    assert filled(SAID[name], tmp_path)[0] != filled(SAID[name], REPORTS)[0]


def test_a_sentence_without_its_row_is_left_out_and_the_notes_stay(tmp_path):
    frame = pd.DataFrame({"method": ["one"], "mean": [1.0]})
    for where, said in (("one", "It is 1."), ("two", "")):
        summary = f"It is {{tables/t method={where}: mean}}."
        table = Table(frame, name="t", title="T", notes=["a note"], summary=summary)
        table.write(tmp_path / "tables")
        text = (tmp_path / "tables/t.md").read_text()
        assert table.summary == said and ("# T\n\nIt is 1.\n\n| method" in text) == bool(said)
        assert "<details><summary>How to read it</summary>\n\n- a note\n\n</details>" in text
    shutil.rmtree(tmp_path / "tables")


def test_headlines_on_a_folder_of_meshes_count_no_claims(tmp_path):
    for verdicts, names in (
        ({"supported": 2}, {"claims_supported", "claims_contradicted", "claims_open"}),
        (None, set()),
    ):
        write_headlines(tmp_path, verdicts)
        assert read_json(tmp_path / "headlines.json").keys() == names

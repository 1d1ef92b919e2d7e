"""The table of the thesis, line by line: complete, and right about code, sets and twins."""

import ast
import re
from pathlib import Path

import pandas as pd
import pytest

from stages.report.fidelity.table import PRINTED, RUNS
from stages.report.topics import KINDS, TOPICS

ROOT = Path(__file__).parents[2]
FRAME = pd.read_csv(ROOT / "data/reference/thesis/fidelity.csv").fillna("")
ROWS = list(FRAME.itertuples())
NUMBERED = {  # what the thesis numbers: chapter -> the last number of each
    "eq.": {3: 25}, "table": {3: 2, 4: 9, 5: 6}, "figure": {3: 36, 4: 19, 5: 6},
}  # fmt: skip
TWINS = {name for topic in TOPICS for kind in KINDS.values() for name in getattr(topic, kind)}


def numbers(kind):
    """The numbers of one kind that column `thesis` names: `T figures 3.23 to 3.26` names four."""
    found = set()
    for text in FRAME["thesis"]:
        for part in re.findall(rf"{kind}s? ((?:\d\.\d+(?:, | and | to )?)+)", text):
            for first, last in re.findall(r"(\d\.\d+)(?: to (\d\.\d+))?", part):
                chapter, start = first.split(".")
                found |= {f"{chapter}.{k}" for k in range(int(start), int((last or first).split(".")[1]) + 1)}
    return found


@pytest.mark.parametrize("kind", NUMBERED)
def test_every_formula_table_and_figure_of_the_thesis_has_a_row(kind):
    wanted = {f"{chapter}.{k}" for chapter, last in NUMBERED[kind].items() for k in range(1, last + 1)}
    assert wanted - numbers(kind) == set()


@pytest.mark.parametrize("row", ROWS, ids=FRAME["thesis"])
def test_each_row_names_code_sets_and_twins_that_exist(row):
    path, _, name = row.code.partition(":")
    source = ROOT / "stages" / path
    assert source.is_file()
    defined = [node.name for node in ast.parse(source.read_text()).body if hasattr(node, "name")]
    assert not name or name in defined
    assert not row.sets or (ROOT / "conf/data" / f"{row.sets}.yaml").is_file()
    assert row.twin in ("", "claims", *TWINS)
    assert row.run in RUNS and (row.run == PRINTED) <= (not row.differs)


def test_what_was_run_has_a_twin_and_measured_rows():
    for row in ROWS:
        assert (row.run == "illustration") or row.twin
        assert row.run != PRINTED or (ROOT / "reports/measurements" / row.sets).is_dir()
        assert (row.run in (PRINTED, "illustration")) or row.differs

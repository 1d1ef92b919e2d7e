"""The table of the thesis, line by line: complete, and right about code, sets and twins."""

import ast
import re
from functools import cache
from pathlib import Path

import pandas as pd
import pytest

from stages.report.fidelity_table import PRINTED, RUNS
from stages.report.parts import KINDS, PARTS
from tests.fidelity.agreements import is_printed, matches

ROOT = Path(__file__).parents[2]
FRAME = pd.read_csv(ROOT / "data/reference/thesis/fidelity.csv").fillna("")
ROWS = list(FRAME.itertuples())
FIDELITY = ROOT / "tests/fidelity"
NUMBERED = {  # what the thesis numbers: chapter -> the last number of each
    "eq.": {3: 25}, "table": {3: 2, 4: 9, 5: 6}, "figure": {3: 36, 4: 19, 5: 6},
}  # fmt: skip
TWINS = {name for topic in PARTS.values() for kind in KINDS.values() for name in getattr(topic, kind)}


def numbers(kind):
    """The numbers of one kind that column `thesis` names: `T figures 3.23 to 3.26` names four."""
    labels = set()
    for text in FRAME["thesis"]:
        for part in re.findall(rf"{kind}s? ((?:\d\.\d+(?:, | and | to )?)+)", text):
            for first, last in re.findall(r"(\d\.\d+)(?: to (\d\.\d+))?", part):
                chapter, start = first.split(".")
                labels |= {f"{chapter}.{k}" for k in range(int(start), int((last or first).split(".")[1]) + 1)}
    return labels


def test_every_formula_table_and_figure_of_the_thesis_has_a_row():
    for kind, chapters in NUMBERED.items():
        wanted = {f"{chapter}.{k}" for chapter, last in chapters.items() for k in range(1, last + 1)}
        assert wanted - numbers(kind) == set(), kind


def defined(path):
    """{name: node} of what a module defines."""
    return {node.name: node for node in ast.parse(path.read_text()).body if hasattr(node, "name")}


@pytest.mark.slow
def test_each_row_names_code_sets_and_twins_that_exist():
    known = cache(defined)
    for row in ROWS:
        path, _, name = row.code.partition(":")
        assert not path or (ROOT / path).is_file(), row.code
        assert not name or name in known(ROOT / path), row.code
        assert not row.sets or (ROOT / "conf/data" / f"{row.sets}.yaml").is_file(), row.sets
        assert row.twin in ("", "claims", *TWINS) and (row.twin or row.run == "illustration"), row.thesis
        assert row.run in RUNS and (row.run == PRINTED) <= (not row.differs), row.thesis
        assert row.run in (PRINTED, "illustration") or row.differs, row.thesis
        assert row.run != PRINTED or (ROOT / "reports/measurements" / row.sets).is_dir(), row.thesis


def test_what_is_as_printed_agrees_by_a_test_that_is_never_skipped():
    known = cache(lambda file: ast.parse((FIDELITY / file).read_text()).body)
    for row in ROWS:
        assert bool(row.test) == bool(row.agreement), f"{row.thesis}: a test without its agreement, or the reverse"
        printed = bool(row.agreement) and is_printed(row.agreement)
        assert row.run != PRINTED or printed, f"{row.thesis}: {row.agreement!r} is not as printed"
        if row.test:
            file, _, name = row.test.partition("::")
            body = known(file)
            (test,) = (node for node in body if isinstance(node, ast.FunctionDef) and node.name == name)
            marks = [ast.unparse(mark) for mark in test.decorator_list]
            marks += [ast.unparse(node) for node in body if isinstance(node, ast.Assign)]
            # `make test` runs slow tests too, such as those that need torch.
            assert not any(re.search("skip|xfail", text) for text in marks), row.test
            assert "agreement" in [argument.arg for argument in test.args.args], f"{row.test} measures no agreement"


@pytest.mark.parametrize(("text", "kind", "measured", "same", "printed"), [
    ("r = 0.997", "r", 0.9974, True, True), ("r = 0.997", "r", 0.9981, False, True),
    ("r = 0.89", "r", 0.8949, True, False), ("r = 1.000", "difference", 1.0, False, True),
    ("difference < 1e-6", "difference", 9e-7, True, True), ("difference < 1e-6", "difference", 2e-6, False, True),
    ("difference < 0.1", "difference", 0.05, True, False), ("0.0 % apart", "share", 0.2, False, True),
    ("5 of 5 settings", "settings", (5, 5), True, True), ("4 of 5 settings", "settings", (5, 5), False, False),
    ("429.0 pixels", "pixels", 429.04, True, False),
])  # fmt: skip
def test_an_agreement_is_compared_to_its_last_digit(text, kind, measured, same, printed):
    assert matches(text, kind, measured) is same and is_printed(text) is printed

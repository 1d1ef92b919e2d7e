"""The best row of a table: bold on the page and in Markdown, by what a reader sees, without what does not compete."""

import numpy as np
import pandas as pd
import pytest

from stages.report.items import Table
from stages.report.tables import Ranking, leading

SHOWN = pd.DataFrame({
    "set": ["a", "a", "a", "b", "b", "b"],
    "method": ["truth", "x", "y", "x", "y", "z"],
    "NSS": ["9.00", "1.10 [1.00, 1.20]", "+1.20 [1.00, 1.40]", "not run", "0.50", "0.50 [0.40, 0.60]"],
    "seconds": ["–", "1,000", "900", "3", "2", "4"],
})  # fmt: skip


def rows(**ranking):
    """Numbers of the rows that stand out."""
    return np.flatnonzero(Ranking(**ranking).best(SHOWN)).tolist()


def test_the_highest_is_best_and_a_truth_takes_no_part():
    assert rows(by="NSS") == [0]
    assert rows(by="NSS", exempt=["truth"]) == [2]


def test_the_lowest_is_best_where_less_is_better():
    assert rows(by="seconds", lowest=True) == [4]


def test_each_block_has_a_best_of_its_own_and_ties_share_it_but_not_where_all_are_equal():
    assert rows(by="NSS", among=["set"], exempt=["truth"]) == [2]  # y and z of b are shown as equal, and x was not run
    shown = pd.concat([SHOWN, SHOWN.tail(1).assign(NSS="0.40")], ignore_index=True)
    assert np.flatnonzero(Ranking("NSS", among=["set"], exempt=["truth"]).best(shown)).tolist() == [2, 4, 5]


def test_the_best_of_one_is_none_and_so_is_that_of_a_column_that_was_not_run():
    assert not Ranking("NSS").best(SHOWN.head(1)).any()
    assert not Ranking("gone").best(SHOWN).any()


@pytest.mark.parametrize(
    ("cell", "number"), [("−0.13 [−0.28, 0.01]", -0.13), ("1.2e-05", 1.2e-5), ("< 0.1", 0.1), ("12,345", 12345)]
)
def test_the_number_of_a_cell_is_read(cell, number):
    assert leading(cell) == number
    assert np.isnan(leading("not run")) and np.isnan(leading("–"))


def test_the_bold_moves_with_the_numbers(tmp_path):
    frame = pd.DataFrame({"method": ["x", "y"], "NSS": [1.0, 2.0], "note": ["", "n"]})

    def bold(frame):
        table = Table(frame, name="t", title="T", best=Ranking("NSS"))
        table.write(tmp_path)
        return [line for line in (tmp_path / "t.md").read_text().splitlines() if "**" in line]

    assert bold(frame) == ["| **y** | **2** | **n** |"]
    assert bold(frame.assign(NSS=[3.0, 2.0])) == ["| **x** | **3** |  |"]

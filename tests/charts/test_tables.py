"""Tables: how they are written, their views, their cells and the best of them."""

import numpy as np
import pandas as pd
import pytest

from stages.charts.items import MOST_COLUMNS, Table
from stages.charts.tables import (
    THESIS,
    WHOSE,
    Ranking,
    as_text,
    beside_thesis,
    grid,
    is_numeric,
    leading,
    means,
    number,
    percent,
    signed,
    with_interval,
)


def test_table_is_written_as_numbers_and_as_text(tmp_path):
    table = Table(pd.DataFrame({"a|b": [0.123456, np.nan], "c": "x|y"}), name="t", title="Title", notes=["a note"])
    table.write(tmp_path)
    text = (tmp_path / "t.md").read_text()
    assert "0.123" in text and "–" in text and "- a note" in text and r"x\|y" in text
    assert pd.read_csv(tmp_path / "t.csv")["a|b"][0] == 0.123456


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.00123456, "0.00123"), (1234.5, "1234"), (12000, "12,000"), (2.0, "2"), (0, "0"), (np.nan, "–"),
     (0.0000123, "1.23e-05"), (True, "True"), ("word", "word"), (None, "–"), (-0.5, "-0.500")],
)  # fmt: skip
def test_numbers_read_well(value, text):
    assert number(value) == text


def test_interval_reads_well():
    assert with_interval(0.512, 0.41, 0.61, 100, 0) == "51 [41, 61]"
    assert with_interval(0.5, np.nan, np.nan, 100, 0) == "50"
    assert with_interval(np.nan, np.nan, np.nan) == "not run"
    assert with_interval(-0.001, -0.004, 0.002, 100, 0) == "0 [0, 0]" and percent(-0.001) == "0"  # zero has no minus
    assert signed(-0.001, -0.004, 0.002) == "+0.00 [0.00, 0.00]"
    assert signed(0.126, np.nan, np.nan) == "+0.13"
    assert is_numeric(as_text(pd.DataFrame({"a": [1.5, np.nan]}))["a"])
    assert not is_numeric(pd.Series(["1.5 % of it"]))


def cells():
    """Two samplings and two classifiers, one cell of which is absent and one without an interval."""
    rows = [
        ("b", "knn", 0.5, 0.4, 0.6, 0.55),
        ("b", "svm", 0.7, np.nan, np.nan, np.nan),
        ("a", "knn", 0.1, 0, 0.2, 0.3),
    ]
    return pd.DataFrame(rows, columns=["sampling", "classifier", "accuracy", "low", "high", "thesis"])


def test_grid_keeps_the_order_of_the_cells_and_says_what_is_absent():
    shown = grid(cells(), "sampling", "classifier", names={"sampling": str.upper}, head=lambda name: f"{name}, %")
    assert shown.to_dict("list") == {
        "sampling": ["B", "A"], "knn, %": ["50 [40, 60]", "10 [0, 20]"], "svm, %": ["70", "not run"],
    }  # fmt: skip
    shown = grid(cells().assign(of="x"), ["of", "sampling"], "classifier", places=1)
    assert shown.columns.tolist() == ["of", "sampling", "knn", "svm"]
    assert shown["svm"].tolist() == ["70.0", "not run"] and shown["knn"][1] == "10.0 [0.0, 20.0]"


def test_the_thesis_stands_behind_each_row_that_it_prints():
    frame = pd.concat([cells().assign(of="one"), cells().assign(of="two", thesis=np.nan)])
    down = ["of", "sampling", WHOSE]
    shown = grid(beside_thesis(frame, down[:-1]), down, "classifier")
    assert shown[WHOSE].tolist() == ["ours", THESIS, "ours", THESIS, "ours", "ours"]
    assert shown["of"].tolist() == ["one"] * 4 + ["two"] * 2
    assert shown["knn"].tolist()[:4] == ["50 [40, 60]", "55", "10 [0, 20]", "30"]
    assert shown["svm"].tolist() == ["70", "–", "not run", "–", "70", "not run"]


def test_means_cut_the_interval_at_what_is_possible():
    values = [1.0, 1.0, 0.7, 0.98, 0.2, 0.0]
    frame = pd.DataFrame({"method": ["x"] * 3 + ["y"] * 3, "value": values, "seconds": [9.0, 1.0, 1.0] * 2})
    first, second = means(frame, ["method"], top=1.0)
    assert first["method"] == "x" and first["high"] == 1.0 and first["seconds"] == 1.0 and first["values"] == 3
    assert second["low"] == 0.0


SHOWN = pd.DataFrame({
    "set": ["a", "a", "a", "b", "b", "b"],
    "method": ["truth", "x", "y", "x", "y", "z"],
    "NSS": ["9.00", "1.10 [1.00, 1.20]", "+1.20 [1.00, 1.40]", "not run", "0.50", "0.50 [0.40, 0.60]"],
    "seconds": ["–", "1,000", "900", "3", "2", "4"],
})  # fmt: skip


@pytest.mark.parametrize(("best", "rows"), [
    (Ranking("NSS"), [0]), (Ranking("NSS", exempt=["truth"]), [2]), (Ranking("seconds", lowest=True), [4]),
    (Ranking("NSS", among=["set"], exempt=["truth"]), [2, 4, 5]), (Ranking("gone"), []),
    (Ranking("NSS", exempt=["truth", "x", "z"], among=["set"]), []),  # the best of one is none
])  # fmt: skip
def test_the_best_cells_are_by_what_is_shown_and_a_truth_takes_no_part(best, rows):
    shown = pd.concat([SHOWN, SHOWN.tail(1).assign(NSS="0.40")], ignore_index=True)
    marks = best.best(shown)
    assert marks.any(axis=1).tolist() == [number in rows for number in range(len(shown))]
    assert set(marks.columns[marks.any()]) <= {best.by}


def test_each_column_of_a_ranking_has_its_best_and_a_line_says_what_bold_means():
    marks = Ranking(["NSS", "seconds"]).best(SHOWN)
    assert marks["NSS"].tolist().index(True) == 0 and marks["seconds"].tolist().index(True) == 1
    assert Ranking("NSS").legend(SHOWN) == "Bold: the highest in the column “NSS”."
    several = Ranking(["a", "b"], lowest=True, among=["set"], aside="QEM aside")
    assert several.legend([WHOSE]) == "Bold: the lowest of ours of its column among rows of the same set, QEM aside."


def test_views_split_by_value_and_put_what_answers_first():
    table = Table(SHOWN, best=Ranking("NSS"), split="set", answer=["method", "NSS"])
    views = table.views
    assert [view.title for view in views] == ["a", "a, further columns", "b", "b, further columns"]
    assert [list(view.text) for view in views[:2]] == [["method", "NSS"], ["method", "seconds"]]
    assert [view.bold["NSS"].tolist() for view in views[::2]] == [[True, False, False], [False, False, False]]


def test_no_view_is_wider_than_a_page():
    frame = pd.DataFrame({f"c{number}": ["1", "2"] for number in range(20)})
    views = Table(frame, answer=["c0", "c1", "c2"], keys=["c0", "c1"]).views
    assert [len(view.text.columns) for view in views] == [3, 8, 8, 7] and MOST_COLUMNS == 8
    assert all(list(view.text)[:2] == ["c0", "c1"] for view in views)
    shown = [name for view in views for name in list(view.text)[2:]]
    assert sorted(shown) == sorted(frame.columns[2:])


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

    assert bold(frame) == ["| y | **2** | n |"]
    assert bold(frame.assign(NSS=[3.0, 2.0])) == ["| x | **3** |  |"]

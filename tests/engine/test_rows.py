"""Rows: their schema, their order, and rows of many items on the disk."""

import tracemalloc

import pytest

from stages.engine.objects import ItemRows, KeptRows
from stages.engine.rows import read_rows, some_rows, write_rows


def write(tmp_path, row, columns=()):
    write_rows(tmp_path / "x.csv.gz", [{"metric": "m", "value": 1} | row], dict.fromkeys(columns, ""), "toys", 0)
    return read_rows(tmp_path / "x.csv.gz").iloc[0]


def test_rows_know_their_data_set_and_names_stay_texts(tmp_path):
    row = write(tmp_path, {"item": "61", "split": "random", "views": 3}, ["views"])
    assert (row["dataset"], row["item"], row["views"]) == ("toys", "61", 3)


@pytest.mark.parametrize(
    ("row", "fault"),
    [
        ({"veiws": 3}, "columns veiws are not declared"),
        ({"split": "anywhere"}, "split anywhere is not one of"),
        ({"metric": None}, "row 0 has no metric"),
        ({"value": "many"}, "many"),
    ],
)
def test_a_row_outside_the_schema_is_refused(tmp_path, row, fault):
    with pytest.raises(ValueError, match=fault):
        write(tmp_path, row)


def rows_of(name, count=1):
    return [{"item": name, "method": "m", "metric": "length" if k else "width", "value": k} for k in range(count)]


def test_rows_come_in_the_order_of_the_names_and_an_item_that_was_put_again_has_its_last_rows(tmp_path):
    kept = ItemRows(tmp_path, "abcd")
    kept.put("a", rows_of("a", 3))
    for name in "cab":
        kept.put(name, rows_of(name, 2))
    assert list(kept) == list(kept) == [row for name in "abc" for row in rows_of(name, 2)]
    assert (len(kept), kept[0], kept[-1:]) == (6, rows_of("a")[0], rows_of("c", 2)[1:])


def test_parts_are_read_one_after_the_other_and_an_iterator_more_than_once(tmp_path):
    kept, items = KeptRows(), ItemRows(tmp_path, "a")
    items.put("a", rows_of("a"))
    kept += items
    kept += (row for row in rows_of("b"))
    kept.append(rows_of("c")[0])
    assert [row["item"] for row in kept] == [row["item"] for row in kept] == ["a", "b", "c"] and len(kept) == 3


@pytest.mark.slow
def test_rows_are_written_and_summarised_without_a_list_of_all_of_them(tmp_path):
    names = [f"object {number}" for number in range(100)]
    kept = ItemRows(tmp_path, names)
    tracemalloc.start()
    for name in names:
        kept.put(name, rows_of(name, 50))
    write_rows(tmp_path / "rows.csv.gz", kept, {}, "toys", 0)
    table = some_rows(kept, ("item", "value"), ["width"])
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert list(table["item"]) == names and len(read_rows(tmp_path / "rows.csv.gz")) == len(kept) == 5_000
    assert most < 1e6  # bytes; a list of all rows takes 1.5e6

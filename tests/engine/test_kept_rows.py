"""Rows of many items on the disk: their order, how often they can be read, and what of them is in memory."""

import tracemalloc

from stages.engine.objects import ItemRows, KeptRows
from stages.engine.rows import read_rows, some_rows, write_rows


def rows_of(name, count=1):
    return [{"item": name, "method": "m", "metric": "length" if k else "width", "value": k} for k in range(count)]


def test_rows_come_in_the_order_of_the_names_however_they_were_put(tmp_path):
    kept = ItemRows(tmp_path, "abc")
    for name in "cab":
        kept.put(name, rows_of(name, 2))
    assert list(kept) == list(kept) == [row for name in "abc" for row in rows_of(name, 2)]
    assert (len(kept), kept[0], kept[-1:]) == (6, rows_of("a")[0], rows_of("c", 2)[1:])


def test_an_item_that_was_put_again_has_its_last_rows_and_one_that_is_missing_has_none(tmp_path):
    kept = ItemRows(tmp_path, "ab")
    kept.put("b", rows_of("b", 3))
    kept.put("b", rows_of("b"))
    assert list(kept) == rows_of("b") and len(kept) == 1


def test_parts_are_read_one_after_the_other_and_an_iterator_more_than_once(tmp_path):
    kept, items = KeptRows(), ItemRows(tmp_path, "a")
    items.put("a", rows_of("a"))
    kept += items
    kept += (row for row in rows_of("b"))
    kept.append(rows_of("c")[0])
    assert [row["item"] for row in kept] == [row["item"] for row in kept] == ["a", "b", "c"] and len(kept) == 3


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

"""Rows: their schema, and tables of some of them."""

import pytest

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


def test_the_rows_of_some_metrics_are_a_table():
    rows = [{"item": name, "metric": metric, "value": 1} for name in "ab" for metric in ("width", "length")]
    assert some_rows(rows, ("item", "note"), ["width"]).to_dict("list") == {"item": ["a", "b"], "note": [None, None]}

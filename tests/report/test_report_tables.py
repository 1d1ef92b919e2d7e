"""Tables: beside the thesis's, and how they are written."""

import numpy as np
import pandas as pd
import pytest

from stages.report import touch
from stages.report.items import Table
from stages.report.meshes.tables import paired_cells
from stages.report.results import NotRun
from stages.report.tables import as_text, blocks, grid, is_numeric, markdown_table, means, number, with_interval
from stages.report.topics import build_all, build_one
from stages.report.touch.imprints import METHODS, SSIM


def table_4_1(results):
    return build_one(touch, "tables", "table_4_1", results)


def test_table_holds_every_cell_of_the_thesis(results):
    frame = table_4_1(results).frame
    methods = METHODS | {"enhanced_visual_attention": SSIM}  # in our protocol
    thesis = results.thesis("table_4_1_six_virtual_objects").set_index("sampling").rename(index=methods)
    theirs = frame[frame["sampling"].isin(thesis.index)]
    means = theirs[theirs["classifier"].str.startswith("mean")]
    theirs = theirs.drop(means.index)
    assert len(theirs) == thesis.size and means["accuracy"].isna().all()  # two of five classifiers were run
    assert means["thesis"].iloc[1] == pytest.approx(thesis.iloc[0].drop("svm").mean())
    assert frame.loc[~frame["sampling"].isin(thesis.index), "sampling"].unique().tolist() == ["glance"]  # ours, below
    for row in theirs.itertuples():
        assert row.thesis == thesis.loc[row.sampling, row.classifier]


def test_table_maps_the_methods_and_says_what_was_not_run(results):
    table = table_4_1(results)
    cell = table.frame.set_index(["sampling", "classifier"])
    assert cell.loc[("thesis_ssim", "knn"), "accuracy"] == pytest.approx(0.8, abs=0.02)
    assert cell.loc[("itti", "knn"), "accuracy"] == pytest.approx(0.5, abs=0.02)
    assert np.isnan(cell.loc[("glance", "knn"), "thesis"])
    assert np.isnan(cell.loc[("heat_kernel", "knn"), "accuracy"])
    shown = table.shown.set_index("sampling")
    ours, printed = (cells for _, cells in shown.loc["heat kernel signature"].iterrows())
    assert (
        (ours.drop("protocol") == "not run").all() and printed["protocol"] == "the thesis" and printed["kNN, %"] == "59"
    )


def test_title_tells_the_objects_that_the_group_held(root, results, small):
    assert table_4_1(results).title.startswith("Table 4.1: recognising six objects by")
    small.write_set(root, "six", 4)
    assert table_4_1(results).title.startswith("Table 4.1: recognising 4 objects (group six) by")


def test_left_out_sampling_is_a_note_of_its_table(root, small):
    frame = small.left_out(small.classification(), "too few touches", group="six", method="itti")
    small.write(root, "classification", small.left_out(frame, "no cup", group="four"))
    built = build_all("tables", small.results(root), [touch])
    table = next(table for table in built.items if table.name == "table_4_1")
    assert "Not run: too few touches." in table.notes
    assert np.isnan(table.frame.set_index(["sampling", "classifier"]).loc[("itti", "knn"), "accuracy"])
    assert built.not_run["table_4_2"] == "no cup"


def test_paired_cells_are_those_that_every_method_reaches(results):
    found = paired_cells(results, ["metro_mean"], ["qem", "glance"])
    assert set(found.loc[found["target"] == "25%", "item"]) == {"ball"}
    assert set(found.loc[found["target"] == "50%", "item"]) == {"ball", "cube"}


def test_lod_seconds_are_those_of_the_simplification(root, results, small):
    frame = results.rows("lod").copy()
    frame.loc[frame["metric"] != "faces", "seconds"] = 99.0
    small.write(root, "lod", frame)
    assert (paired_cells(small.results(root), ["metro_mean"], ["qem", "glance"])["seconds"] == 0.1).all()


def test_without_measurements_every_table_is_not_run_or_made(bare, small):
    built = build_all("tables", small.results(bare))
    assert "table_4_1" in built.not_run
    assert "dvc repro classification" in built.not_run["table_4_1"]


def test_missing_column_is_not_run(results):
    with pytest.raises(NotRun, match="no column speed"):
        results.rows("lod", speed=1)


def test_table_is_written_as_numbers_and_as_text(tmp_path):
    table = Table(pd.DataFrame({"a|b": [0.123456, np.nan]}), name="t", title="Title", notes=["a note"])
    table.write(tmp_path)
    text = (tmp_path / "t.md").read_text()
    assert "0.123" in text and "–" in text and "- a note" in text
    assert pd.read_csv(tmp_path / "t.csv")["a|b"][0] == 0.123456


def test_markdown_keeps_a_bar_in_a_cell():
    assert r"x\|y" in markdown_table(pd.DataFrame({"a": ["x|y"]}))


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


def test_column_of_words_is_not_numeric():
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


def test_grid_may_go_down_by_several_columns():
    shown = grid(cells().assign(of="x"), ["of", "sampling"], "classifier", places=1)
    assert shown.columns.tolist() == ["of", "sampling", "knn", "svm"]
    assert shown["svm"].tolist() == ["70.0", "not run"] and shown["knn"][1] == "10.0 [0.0, 20.0]"


def test_blocks_hold_one_number_a_cell_and_each_printed_figure_once():
    both = pd.concat([cells().assign(of="one"), cells().assign(of="two")])
    down = ["of", "sampling"]
    shown = grid(
        blocks(both, down, "classifier", {"thesis": lambda of: "printed"}), down, "classifier", printed="printed"
    )
    assert shown["of"].tolist() == ["one", "one", "two", "two", "printed", "printed"]
    assert shown["knn"].tolist()[-2:] == ["55", "30"] and shown["svm"].tolist()[-2:] == ["–", "–"]
    assert shown["svm"].tolist()[:2] == ["70", "not run"]


def test_means_cut_the_interval_at_what_is_possible():
    values = [1.0, 1.0, 0.7, 0.98, 0.2, 0.0]
    frame = pd.DataFrame({"method": ["x"] * 3 + ["y"] * 3, "value": values, "seconds": [9.0, 1.0, 1.0] * 2})
    one, other = means(frame, ["method"], top=1.0)
    assert one["method"] == "x" and one["high"] == 1.0 and one["seconds"] == 1.0 and one["values"] == 3
    assert other["low"] == 0.0

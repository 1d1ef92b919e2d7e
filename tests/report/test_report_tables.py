"""Tables: beside the thesis's, how they are written, their best row, and figures in sentences that come from them."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from stages.charts.cells import filled
from stages.charts.items import Table
from stages.charts.results import NotRun
from stages.charts.tables import (
    Ranking,
    as_text,
    blocks,
    grid,
    is_numeric,
    leading,
    means,
    number,
    percent,
    signed,
    with_interval,
)
from stages.classification import report as touch
from stages.classification.recognition_tables import METHODS, SSIM
from stages.lod.error_tables import paired_cells
from stages.report.parts import build_item, build_part

table_4_1 = partial(build_item, touch, "tables", "table_4_1")


def test_table_holds_every_cell_of_the_thesis(results):
    table = table_4_1(results)
    assert table.record["sets"] == table.sets and table.record["rows"] == len(table.frame)
    frame = table.frame
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


def test_table_maps_the_methods_and_says_what_was_not_run(root, results, small):
    table = table_4_1(results)
    cell = table.frame.set_index(["sampling", "classifier"])
    assert cell.loc[("thesis_ssim", "knn"), "accuracy"] == pytest.approx(0.8, abs=0.02)
    assert cell.loc[("itti", "knn"), "accuracy"] == pytest.approx(0.5, abs=0.02)
    assert np.isnan(cell.loc[("glance", "knn"), "thesis"])
    assert np.isnan(cell.loc[("heat_kernel", "knn"), "accuracy"])
    shown = table.shown.set_index("sampling")
    ours, printed = (cells for _, cells in shown.loc["heat kernel signature"].iterrows())
    assert (ours.drop("protocol") == "not run").all()
    assert printed["protocol"] == "the thesis" and printed["kNN, %"] == "59"
    assert table.title.startswith("Table 4.1: recognising six objects by")
    small.write_set(root, "six", 4)
    assert table_4_1(results).title.startswith("Table 4.1: recognising 4 objects (group six) by")


def test_left_out_sampling_is_a_note_of_its_table(root, small):
    frame = small.left_out(small.classification(), "too few touches", group="six", method="itti")
    small.write(root, "classification", small.left_out(frame, "no cup", group="four"))
    built = build_part(touch, small.results(root), ["tables"])
    table = next(table for table in built.items if table.name == "table_4_1")
    assert "Not run: too few touches." in table.notes
    assert np.isnan(table.frame.set_index(["sampling", "classifier"]).loc[("itti", "knn"), "accuracy"])
    assert built.not_run["table_4_2"] == "no cup"


def test_lod_seconds_are_those_of_the_simplification(measure, small):
    frame = small.lod()
    frame.loc[frame["metric"] != "faces", "seconds"] = 99.0
    results = measure("lod", frame)
    assert (paired_cells(results, ["metro_mean"], ["qem", "glance"])["seconds"] == 0.1).all()
    with pytest.raises(NotRun, match="no column speed"):
        results.rows("lod", speed=1)


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


def test_blocks_hold_one_number_a_cell_and_each_printed_figure_once():
    frame = pd.concat([cells().assign(of="one"), cells().assign(of="two")])
    down = ["of", "sampling"]
    shown = grid(
        blocks(frame, down, "classifier", {"thesis": lambda of: "printed"}), down, "classifier", printed="printed"
    )
    assert shown["of"].tolist() == ["one", "one", "two", "two", "printed", "printed"]
    assert shown["knn"].tolist()[-2:] == ["55", "30"] and shown["svm"].tolist()[-2:] == ["–", "–"]
    assert shown["svm"].tolist()[:2] == ["70", "not run"]


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
def test_the_best_rows_are_by_what_is_shown_and_a_truth_takes_no_part(best, rows):
    shown = pd.concat([SHOWN, SHOWN.tail(1).assign(NSS="0.40")], ignore_index=True)
    assert best.best(shown).tolist() == [number in rows for number in range(len(shown))]


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


@pytest.fixture
def reports(tmp_path):
    """A folder with one table and the claims."""
    frame = pd.DataFrame({"method": ["one", "two", "two"], "note": ["", "", "x"], "mean": [1234.5, 0.5, None]})
    write_table(tmp_path / "tables/rates.csv", frame.assign(low=[1000.0, 0.25, 0], high=[2000.0, 0.75, 1]))
    claims = {"key": ["kept", "read", "untested"], "effect": -100.0, "low": -120.0, "high": 0.0}
    claims["verdict"] = ["contradicted", "depends on the reading", "not testable"]
    write_table(tmp_path / "claims.csv", pd.DataFrame(claims))
    signs = {
        "kind": ["none of both", "open", "tiny"],
        "mean": [1, 1, -0.2],
        "low": [-2, None, -0.4],
        "high": [4, 2, 0.3],
    }
    write_table(tmp_path / "tables/signs.csv", pd.DataFrame(signs))
    return tmp_path


@pytest.mark.parametrize(("place", "words"), [
    ("tables/rates method=one: mean", "1,234"),
    ("tables/rates method=one: mean low high", "1,234 [1,000, 2,000]"),
    ("tables/rates method=two note=: 100*mean 100*low 100*high .0f", "50 [25, 75]"),
    ("tables/rates method=two note=: 1/mean 1/low 1/high", "2 [1.33, 4]"),
    ("tables/rates method=two note=: 1-mean", "0.500"),
    ("claims key=kept: times:effect times:low times:high .2f", "3.00 [1.00, 4.00]"),
    ("claims key=kept: -effect", "100"),
    ("claims key=read: effect low high", "-100 [-120, 0] (depends on the reading)"),
    ("claims key=untested: effect low high more|less .0f",
     "neither more nor less beyond chance (-100 [-120, 0]) (not testable)"),
    ("tables/rates method=o*: mean", "1,234"),
    ("tables/rates note=x method!=one: rows", "1"),
    ("tables/rates : rows", "3"),
    ("tables/signs kind=open: mean low high", "1"),
    ("tables/signs kind=tiny: mean low high .0f", "0 [0, 0]"),
    ("tables/rates highest=low: method", "one"),
    ("tables/rates method=two lowest=mean: mean low high NSS higher|NSS lower .2f", "0.50 [0.25, 0.75] NSS higher"),
    ("tables/rates method=two note=: -mean -low -high higher|lower .1f", "0.5 [0.2, 0.8] lower"),
    ("tables/signs kind=none of both: mean low high points higher|points lower .0f",
     "neither points higher nor points lower beyond chance (1 [-2, 4])"),
])  # fmt: skip
def test_a_place_becomes_what_its_cell_holds(reports, place, words):
    assert filled(f"It is {{{place}}}.", reports) == (f"It is {words}.", [tuple(place.split(":")[0].split(" ", 1))])


@pytest.mark.parametrize("place", [
    "tables/none method=one: mean", "tables/rates method=three: mean", "tables/rates method=two: mean",
    "tables/rates method=two note=x: mean", "tables/rates gone=1: mean", "tables/rates method=one: gone",
    "tables/signs kind=open: mean low high more|less",
    "tables/rates highest=gone: mean", "tables/rates method=two note=x highest=mean: mean", "tables/none : rows",
])  # fmt: skip
def test_what_was_not_measured_or_is_not_one_row_is_an_error(reports, place):
    with pytest.raises(LookupError):
        filled(f"{{{place}}}", reports)

"""The pieces on simplified meshes: paired cells, table 3.2, all detectors, claims, figures, and the backends."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_arrays, write_mesh
from stages.charts.results import NotRun
from stages.lod import level_pictures as pictures
from stages.lod import report as meshes
from stages.lod.error_tables import face_counts, paired_cells, rows_by_set
from stages.report.parts import build_item
from tests.frames import has_ink

OBJECTS = ["a", "b", "c", "d"]
POINTS = {"heat_kernel": 3, "SymRad": 4, "itti": 15, "guided_ssim": 16, "guided_ed": 17, "svm": 18, "harris": 50,
          "corners": 60, "VisAttAll": 20, "VisAttCurvSymCon": 14, "VisAttCon": 13, "glance": 12}  # fmt: skip
WAYS = ["guided_ssim-adaptive", "guided_ed-adaptive", "svm-adaptive"]
TARGETS = {"25%": 2000, "3000": 3000, "1500": 1500}


def measured(dataset="test", seed=0, objects=OBJECTS):
    """Rows whose error is (1 + points / 100) / faces a method, times the object's own level and a little noise.

    Adaptive ways have 5 % less; errors beyond plain QEM's grow fourfold where faces halve.
    """
    random, rows = np.random.default_rng(seed), []
    for name, level in zip(objects, np.geomspace(0.5, 2, len(objects)), strict=True):
        for method in ("qem", *POINTS, *WAYS):
            base, _, way = method.partition("-")
            points = POINTS.get(base, 0)
            for target, faces in TARGETS.items():
                error = level * (3 / faces) * (1 + points / 100 * 3000 / faces) * (0.95 if way else 1)
                error *= 1 + 0.001 * random.normal()
                cell = {"dataset": dataset, "item": name, "method": method, "target": target, "asked": faces}
                cell |= {"faces": faces, "points": points, "kept": points, "rings": 3.0 if points else np.nan}
                cell |= {"shrunk": points == 60 and target == "1500", "infeasible": False}
                values = {"faces": faces, "metro_mean": error, "metro_rms": 2 * error, "metro_max": 9 * error}
                values |= {"ssim_error": 10 * error, "dlap": 100 * error, "dnor": 30 * error, "salient_error": error}
                rows += [cell | {"metric": key, "value": value, "seconds": 0.1} for key, value in values.items()]
    return pd.DataFrame(rows)


table = partial(build_item, meshes, "tables")
figure = partial(build_item, meshes, "figures")


@pytest.fixture
def run(measure):
    """A function of rows, and of those of further sets, which have no seconds, to the results."""
    return lambda rows, *further: measure(
        "lod", pd.concat([rows, *(frame.assign(seconds=np.nan) for frame in further)])
    )


@pytest.fixture(scope="module")
def plain(measure):
    """The results of a run with the rows of `measured` on one set."""
    return measure("lod", measured())


def without(rows, value=np.nan, **where):
    """The rows with another value in the cells of `where`."""
    chosen = np.logical_and.reduce([rows[column] == wanted for column, wanted in where.items()])
    return rows.assign(value=rows["value"].mask(chosen, value))


def test_only_cells_where_nothing_shrank_when_asked_for_the_whole():
    plain = measured()
    cells = paired_cells(plain, ["metro_mean"], ["itti", "corners"])
    whole = paired_cells(plain, ["metro_mean"], ["itti", "corners"], whole=True)
    assert set(cells["target"]) == set(TARGETS)
    assert set(whole["target"]) == {"25%", "3000"}
    assert set(paired_cells(plain, ["metro_mean"], ["itti"], whole=True)["target"]) == set(TARGETS)


def test_sets_that_are_not_switched_on_stand_behind_those_that_are(run):
    assert list(rows_by_set(run(measured("gaze")))) == ["gaze"]
    sets = rows_by_set(run(measured(), measured("princeton", 1), measured("gaze")))
    assert list(sets) == ["test", "gaze", "princeton"]
    rows = paired_cells(sets["princeton"], ["metro_mean"], ["qem", "itti"])
    assert rows["seconds"].isna().all() and len(rows) == 2 * len(OBJECTS) * len(TARGETS)


def test_face_counts_come_before_shares_and_need_objects():
    rows = measured()
    assert face_counts(rows) == ["3000", "1500"]
    assert face_counts(rows[rows["target"] == "25%"]) == ["25%"]
    assert face_counts(rows[rows["item"].isin(["a", "b"])]) == []


def test_table_3_2_compares_all_methods_on_the_same_objects(run):
    rows = without(measured(), item="d", target="1500", method="guided_ed", metric="ssim_error")
    frame = table("table_3_2", run(rows)).frame
    frame = frame[~frame["nothing_shrunk"]]
    counts = frame.groupby(["target", "metric"])["objects"].unique().map(list).to_dict()
    assert counts["1500", "ssim_error"] == [3] and counts["1500", "metro_mean"] == [4]
    same = frame[(frame["target"] == "3000") & (frame["metric"] == "metro_mean")].set_index("method")
    assert same.loc["svm", "over_plain_low"] > 0
    assert same.loc["svm-adaptive", "mean"] == pytest.approx(0.95 * same.loc["svm", "mean"], rel=0.01)


@pytest.mark.slow
def test_tables_of_ones_own_meshes_leave_out_the_thesis_and_what_is_of_other_data_sets(plain, root, small):
    small.write_measurements(root, "lod", measured())
    of_folder = small.own_results(root)
    with pytest.raises(NotRun, match=r"T3\.1\.5"):
        table("table_3_1_5_combinations", of_folder)
    for name, words in WORDS.items():
        built, published = table(name, of_folder), table(name, plain)
        parts = ([item.title, *item.shown, *item.shown["objects"], *item.notes] for item in (built, published))
        text, whole = map(" ".join, parts)
        assert all(word in whole and word not in text for word in words)


WORDS = {
    "table_3_2": ("beside the thesis", ", thesis, %", "As in T3.2", "with gaze"),
    "lod_detectors": ("Where people look", "recorded gaze"),
}


def test_combinations_tell_how_many_objects_reach_each_face_count(run):
    rows = without(measured("household_3_1"), item="d", target="1500", method="itti")
    words = table("table_3_1_5_combinations", run(rows)).words
    assert words["reached"] == ": 4 at 25%, 4 at 3,000 faces, 3 at 1,500 faces"


@pytest.fixture(scope="module")
def simplified(measure, small):
    """A run with simplified meshes of two objects: of b corners finds far more points, and missed a target."""
    results = measure("lod", measured())
    root, mesh = results.data / "test", small.ball()
    counts = {"a": {}, "b": {"corners": 60, "VisAttCurvSymCon": 14}}
    for name, strong in counts.items():
        write_mesh(root / f"meshes/{name}.npz", mesh)
        arrays = {f"{method}.points": np.arange(60) for method in POINTS}
        arrays |= {f"{method}.strong": np.int64(strong.get(method, 3)) for method in POINTS}
        write_arrays(root / f"salient_points/{name}.npz", **arrays)
        for method in ["qem", *POINTS, *WAYS]:
            write_mesh(root / f"lod/{name}/{method}_3000.npz", small.ball(9))
            write_mesh(root / f"lod/{name}/{method}_1500.npz", small.ball(6))
    (root / "lod/b/corners_1500.npz").unlink()
    return results


@pytest.mark.slow
@pytest.mark.parametrize("name", ["figure_3_7", "figure_3_8", "figure_3_21", "figure_3_22"])
def test_pictures_of_meshes_are_drawn(simplified, name, monkeypatch):
    monkeypatch.setattr(pictures, "ROWS", dict.fromkeys(pictures.ROWS, 60))
    made = figure(name, simplified)
    assert has_ink(made)
    if name == "figure_3_7":  # many and few points where they differ, at a target that all methods reached
        assert made.caption.startswith("b (test) at 3,000 faces")
    if name == "figure_3_22":  # at 3,000 faces, 16 to 18 points make 1.17 times the error, and half of them 5 % less
        assert made.words == {"names": "a, b", "set": "test", "objects": 4, "times": "1.1"}


def test_lod_seconds_are_those_of_the_simplification(measure, small):
    frame = small.lod()
    frame.loc[frame["metric"] != "faces", "seconds"] = 99.0
    results = measure("lod", frame)
    assert (paired_cells(results.rows("lod"), ["metro_mean"], ["qem", "glance"])["seconds"] == 0.1).all()
    with pytest.raises(NotRun, match="no column speed"):
        results.rows("lod", speed=1)

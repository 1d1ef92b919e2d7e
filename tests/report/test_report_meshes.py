"""The pieces on simplified meshes: paired cells, table 3.2, all detectors, claims, figures, and the backends."""

from functools import partial

import numpy as np
import pandas as pd
import pytest
from stages.report.meshes import pictures
from stages.report.meshes.claims import BOTH, CLAIMS, FEW_MINUS_MANY, claim, lower

from haptic_glance.base.files import write_arrays, write_mesh
from stages.charts.results import NotRun
from stages.engine.statistics import interval
from stages.lod.error_tables import data_sets, face_counts, paired_cells
from stages.report import meshes
from stages.report.claims import highest_of, lowest_of
from stages.report.effects import differences
from stages.report.parts import build_item
from stages.report.verdict import judge
from tests.report.frames import has_ink

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


def test_only_cells_where_nothing_shrank_when_asked_for_the_whole(plain):
    cells = paired_cells(plain, ["metro_mean"], ["itti", "corners"])
    whole = paired_cells(plain, ["metro_mean"], ["itti", "corners"], whole=True)
    assert set(cells["target"]) == set(TARGETS)
    assert set(whole["target"]) == {"25%", "3000"}
    assert set(paired_cells(plain, ["metro_mean"], ["itti"], whole=True)["target"]) == set(TARGETS)


def test_sets_that_are_not_switched_on_stand_behind_those_that_are(run):
    results = run(measured("gaze"))
    assert data_sets(results) == ["gaze"]
    with pytest.raises(NotRun, match="princeton"):
        paired_cells(results, ["metro_mean"], ["itti"], "princeton")
    results = run(measured(), measured("princeton", 1), measured("gaze"))
    assert data_sets(results) == ["test", "gaze", "princeton"]
    rows = paired_cells(results, ["metro_mean"], ["qem", "itti"], "princeton")
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
    small.write(root, "lod", measured())
    of_folder = small.own(root)
    with pytest.raises(NotRun, match=r"T3\.1\.5"):
        table("table_3_1_5_combinations", of_folder)
    for name, words in WORDS.items():
        built, published = table(name, of_folder), table(name, plain)
        text, whole = (" ".join([item.title, *item.shown, *item.notes]) for item in (built, published))
        assert all(word in whole and word not in text for word in words)


WORDS = {
    "table_3_2": ("beside the thesis", "%, thesis", "As printed", "human gaze"),
    "lod_detectors": ("human gaze", "household as in T3.1", "in colour"),
}


def higher(results, worse, better, target=""):
    """How much higher the Metro mean error of `worse` is than that of `better`, in % of the mean of the two."""
    return differences(results, lower("s", "metro_mean", "k", "Sentence.", worse, better, target))


def stated(results, statistic, **fields):
    """The differences of a claim of one of the further statistics."""
    return differences(results, claim(key="k", section="s", sentence="Sentence.", statistic=statistic, **fields))


def test_combinations_tell_how_many_objects_reach_each_face_count(run):
    rows = without(measured("household_3_1"), item="d", target="1500", method="itti")
    words = table("table_3_1_5_combinations", run(rows)).words
    assert words["reached"] == ": 4 at 25%, 4 at 3,000 faces, 3 at 1,500 faces"


def test_a_set_without_any_of_the_methods_is_said_to_lack_them(plain):
    with pytest.raises(NotRun, match="no mesh was simplified by nobody or nothing"):
        data_sets(plain, ("nobody", "nothing"))


ERROR = {"metric": "metro_mean"}


def test_difference_is_relative_and_a_group_is_the_mean_of_those_that_were_run_or_the_worst_or_the_best(plain):
    assert higher(plain, "corners", "itti", "3000").mean() == pytest.approx(100 * (1.6 - 1.15) / 1.375, rel=0.02)
    group = higher(plain, ("corners", "sift"), "itti")
    assert group.to_numpy() == pytest.approx(higher(plain, "corners", "itti").to_numpy())
    with pytest.raises(NotRun, match="sift"):
        higher(plain, ("sift",), "itti")
    worst = higher(plain, "corners", highest_of("itti", "harris"))
    best = higher(plain, "corners", lowest_of("itti", "harris"))
    assert worst.to_numpy() == pytest.approx(higher(plain, "corners", "harris").to_numpy())
    assert best.to_numpy() == pytest.approx(higher(plain, "corners", "itti").to_numpy())


@pytest.mark.slow
def test_a_sentence_of_t3_1_5_must_hold_from_four_viewpoints_too(run):
    as_printed = [measured(name, seed) for seed, name in enumerate(("household_3_1", "princeton_3_1"))]
    four = [frame.assign(dataset=frame["dataset"] + "_four") for frame in as_printed]
    turned = [without(frame, 1e-6, method="VisAttAll", metric="metro_mean") for frame in four]
    (entry,) = (entry for entry in CLAIMS if entry.key == "all_channels")  # these have a higher error than VisAtt
    for frames, word in ((four, "supported"), (turned, "depends")):
        row = judge([entry], run(*as_printed, *frames)).iloc[0]
        assert row["verdict"].startswith(word) and "four principal viewpoints: " in row["readings"]


def test_gap_and_spread_grow_at_few_faces(plain, run):
    results, at = plain, {"where": ERROR, "contrast": FEW_MINUS_MANY}
    corners, itti = {"method": "corners"}, {"method": "itti"}
    assert (stated(results, "difference", first=corners, second=itti, **at) > 0).all()
    assert (stated(results, "difference", first=itti, second=corners, **at) < 0).all()
    assert (stated(results, "spread", first={"method": tuple(POINTS)}, **at) > 0).all()
    rows = measured()
    with pytest.raises(NotRun, match="target 3000 is not among"):
        stated(run(rows[rows["target"] != "3000"]), "difference", first=corners, second=itti, **at)


def test_error_falls_with_faces(plain, run):
    rows, fields = measured(), {"where": ERROR, "first": {"method": "itti"}}
    assert (stated(plain, "falls_with_faces", **fields) > 0).all()
    single = (rows["item"] == "a") & (rows["target"] != "1500")
    falls = stated(run(rows[~single]), "falls_with_faces", **fields)
    assert list(falls.index) == ["b", "c", "d"]  # with one count nothing can fall
    with pytest.raises(NotRun, match="two face counts"):
        stated(run(rows[rows["target"] == "1500"]), "falls_with_faces", **fields)


def test_error_falls_from_the_fewest_to_the_most_of_the_faces_in_print(run):
    rows = measured("household_3_1")
    other = rows["target"] == "25%"  # a count that print does not have
    rows = rows.assign(faces=rows["faces"].mask(other, 500), value=rows["value"].mask(other, 1e6 * rows["value"]))
    (entry,) = (entry for entry in CLAIMS if entry.key == "more_faces")
    assert differences(run(rows), entry.on("household_3_1")).max() < 10


def room(results, margin, methods, base, statistic="room"):
    """What the differences of methods from a base leave of a margin."""
    sides = {"first": {"method": methods}, "second": {"method": base}}
    return stated(results, statistic, where=ERROR | BOTH, margin=margin, **sides)


def test_a_fall_has_one_side_and_the_farthest_decides(plain):
    assert interval(room(plain, 0.2, ("corners",), "itti", "fall"))[1] > 0  # the error rises
    assert interval(room(plain, 0.2, ("corners",), "itti"))[2] < 0
    assert interval(room(plain, 0.2, ("corners", "itti"), "harris", "fall"))[2] < 0


def test_equivalence_holds_within_the_margin_and_fails_beyond_it(plain):
    assert higher(plain, "guided_ed", "guided_ssim", "1500").mean() > 0  # they differ, beyond doubt, but little
    _, low, _ = interval(room(plain, 0.2, ("guided_ed",), "guided_ssim"))
    assert low > 0
    _, _, high = interval(room(plain, 1e-3, ("guided_ed",), "guided_ssim"))
    assert high < 0
    _, _, high = interval(room(plain, 0.2, ("guided_ed", "corners"), "guided_ssim"))
    assert high < 0  # the farthest of them decides
    forward, back = (room(plain, 1e-4, (a,), b) for a, b in (("itti", "svm"), ("svm", "itti")))
    assert forward.to_numpy() == pytest.approx(back.to_numpy())


def test_ranks_agree_where_the_error_grows_with_the_points(plain, run):
    assert stated(plain, "ranks_agree", first=ERROR).min() > 0.98
    reversed_ = measured()
    reversed_["points"] = 100 - reversed_["points"]
    results = run(reversed_)
    assert stated(results, "ranks_agree", first=ERROR).max() < -0.98
    assert stated(results, "ranks_agree", first=ERROR, second={"metric": "dlap"}).min() > 0.98


def with_people():
    """Rows of the meshes with gaze, on which people judge ours, unlike our model, better than plain QEM."""
    rows = measured("gaze", 2)
    people = rows[rows["metric"] == "salient_error"].assign(metric="gaze_error")
    ours = people["method"] == "glance"
    people.loc[ours, "value"] *= np.linspace(0.1, 0.2, ours.sum())
    return pd.concat([rows, people])


@pytest.mark.slow
def test_where_people_look_is_judged_on_the_meshes_with_gaze(run):
    results = run(measured(), with_people())
    claims = [entry for entry in CLAIMS if entry.key in ("glance_keep_gaze", "glance_keep_salient")]
    judged = judge(claims, results).set_index("key")
    assert judged.loc["glance_keep_gaze", "verdict"] == "supported"
    assert judged.loc["glance_keep_gaze", "tested_on"].startswith(
        "meshes with human gaze, error weighted by human gaze"
    )
    assert judged.loc["glance_keep_salient", "verdict"] == "contradicted"  # the model and people differ


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

"""Trainings on recorded touches: splits, what is trained, what is kept of it, what the rows say, and the neighbours."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import torch

from stages.classification.touch_readers import ELECTRODES, PALMS, Grasps
from stages.engine.rows import read_rows
from stages.engine.settings import check_section
from stages.recorded.biotac_grasps import Model
from stages.recorded.biotac_grasps import process as grasp_rows
from stages.recorded.pressure_images import class_sets, describe
from stages.recorded.pressure_images import process as image_rows
from stages.recorded_networks import Params, data, recorded_training
from stages.recorded_networks import __main__ as stage
from stages.recorded_networks.data import SOURCES, Recording, neighbour_rows, object_split, parts
from stages.recorded_networks.recorded_training import Run, Trial, passes, process, trials
from stages.transfer.recorded_images import Recorded

pytestmark = pytest.mark.slow

LABELS = np.repeat([0, 1], 24)
GROUPS = np.array([f"{label}/{k % 6}" for label, k in zip(LABELS, range(48), strict=True)])
SMALL = {
    "networks": {"alexnet": ["frozen"]}, "weights": ["random"], "source": "package", "device": "cpu", "momentum": 0.9,
    "steps": 600, "copies": 1, "size": 32, "repetitions": {"frozen": 1, "finetuned": 1},
    "rates": {"frozen": [0.001, 0.003, 0.01, 0.03], "finetuned": [0.001]}, "epochs": {"frozen": 20, "finetuned": 1},
    "search_epochs": {"frozen": 8, "finetuned": 1}, "batch": {"frozen": 32, "finetuned": 16},
    "passes": ["printed"], "patience": 3, "most_epochs": 9,
}  # fmt: skip


def small(**changes):
    return check_section(Params, SMALL | changes)


def recording(groups=GROUPS, color=False, splits=("random",), kept=()):
    """Two classes: bright to the left, bright to the right."""
    images = np.random.default_rng(0).integers(0, 60, (48, 8, 10, 3 if color else 1)).astype(np.uint8)
    images[:24, :, :4] += 180
    images[24:, :, 6:] += 180
    touches = Recorded(images if color else images[..., 0], LABELS, ["left", "right"], groups)
    return Recording(touches, splits, True, kept)


@pytest.mark.parametrize("split", ["random", "blocks", "objects"])
def test_parts_are_disjoint_and_hold_all(split):
    fit, validation, test = sides = parts(recording(), split, 3)
    assert sorted([*fit, *validation, *test]) == list(range(48))
    for part in (validation, test):
        assert len(part) and set(LABELS[part]) == {0, 1}
    if split == "blocks":  # of neighbours
        assert all((np.diff(np.sort(test[LABELS[test] == label])) == 1).all() for label in (0, 1))
    if split == "objects":  # no object lies on two sides
        groups = [set(GROUPS[part]) for part in sides]
        assert sum(map(len, groups)) == 12 and len(groups[2]) == 4  # a quarter of six, in each class


def test_an_object_with_touches_of_both_classes_stays_on_one_side():
    groups = np.array([f"object{k % 6}" for k in range(48)])
    fit, validation, test = parts(recording(groups, kept=("object4",)), "test_objects", 1)
    assert set(groups[test]) == {"object4"} and not set(groups[fit]) & set(groups[validation])


def test_what_cannot_be_split_or_trained_is_named():
    with pytest.raises(ValueError, match="class 0 has too few groups to hold one out"):
        object_split(LABELS, np.where(LABELS == 0, "a", GROUPS), 0)
    with pytest.raises(ValueError, match="do not say which object a touch is of"):
        parts(recording(groups=None), "objects", 0)
    with pytest.raises(ValueError, match="'thawed' is not one of frozen, finetuned"):
        trials({"a": recording()}, small(networks={"alexnet": ["thawed"]}))


def train(mode, split="random", network="mobilenet_v2", kept=(), **changes):
    """{(item, metric): value} of one training."""
    training = Trial(network, "random", mode, (Run("tiny", split, 0),))
    rows = process(training, None, {"tiny": recording(kept=kept)}, small(**changes), seed=0)
    return {(row.get("item", ""), row["metric"]): row["value"] for row in rows}


def test_a_frozen_network_learns_its_head_alone_and_the_same_again():
    values = train("frozen", network="alexnet", size=64)  # an untrained one that keeps much of an image
    assert values["", "accuracy"] >= 0.7 and values["", "chance"] == values["", "majority"] == 0.5
    assert values["", "trained_parameters"] == 2 * 256 + 2
    assert values == train("frozen", network="alexnet", size=64)


def test_fine_tuning_trains_every_parameter():
    values = train("finetuned", "test_objects", kept=("0/1", "1/1"))
    assert values["", "trained_parameters"] == values["", "parameters"] > 2e6
    assert {name for name, _ in values} == {"", "0/1", "1/1"}


def test_passes_over_many_touches_are_fewer():
    settings = small(steps=600, batch={"frozen": 32, "finetuned": 16}, epochs={"frozen": 20, "finetuned": 10})
    assert passes("finetuned", 825, settings) == 10 and passes("finetuned", 4373, settings) == 2
    assert passes("frozen", 4373, settings) == 20


def test_frozen_trainings_share_their_features_and_fine_tuned_ones_stand_alone():
    networks = {"mobilenet_v2": ["frozen", "finetuned"]}
    settings = small(networks=networks, weights=["imagenet", "random"], repetitions={"frozen": 2, "finetuned": 2})
    planned = trials({"a": recording(splits=("random", "blocks")), "b": recording()}, settings)
    shared = [
        [{run.repetition for run in training.runs} for training in planned if len(training.runs) == size]
        for size in (6, 3)
    ]
    assert shared == [[{0, 1}], [{0}, {1}]]  # an untrained network is drawn for each repetition
    assert len(planned) == 3 + 12 and len({training.name for training in planned}) == len(planned)


def test_what_has_other_images_has_features_of_its_own(monkeypatch):
    computed, frozen_features = [], recorded_training.frozen_features
    monkeypatch.setattr(
        recorded_training, "frozen_features", lambda *args: computed.append(1) or frozen_features(*args)
    )
    turned = replace(recording().touches, images=recording().touches.images[:, ::-1, ::-1])
    recordings = {"tiny": recording(), "same": recording(), "other": Recording(turned, ("random",), True)}
    training = Trial("mobilenet_v2", "random", "frozen", tuple(Run(name, "random", 0) for name in recordings))
    tiny, same, other = recorded_training.frozen_features_by_run(training, recordings, small(), seed=0).values()
    assert len(computed) == 2 and tiny[0] is same[0] and not torch.equal(other[0], tiny[0])
    alone = recorded_training.frozen_features_by_run(
        replace(training, runs=training.runs[2:]), recordings, small(), seed=0
    )
    assert torch.equal(other[0], alone[training.runs[2]][0])
    second = training.runs[2]._replace(repetition=1)
    drawn = recorded_training.frozen_features_by_run(replace(training, runs=(second,)), recordings, small(), seed=0)[
        second
    ][0]
    assert not torch.equal(other[0], drawn)


@pytest.mark.parametrize(("weights", "share"), [("random", False), ("random_initial", True), ("imagenet", True)])
def test_features_do_not_depend_on_the_images_that_test(weights, share):
    runs = Run("tiny", "random", 0), Run("tiny", "blocks", 0)
    training, plain = Trial("mobilenet_v2", weights, "frozen", runs), recording(splits=("random", "blocks"))
    before = recorded_training.frozen_features_by_run(training, {"tiny": plain}, small(), seed=0)
    assert (before[runs[0]][0] is before[runs[1]][0]) == share
    test = parts(plain, "random", recorded_training.split_number(0, 0))[2]
    images = plain.touches.images.copy()
    images[test] = 255 - images[test]
    other = replace(plain, touches=replace(plain.touches, images=images))
    after = recorded_training.frozen_features_by_run(training, {"tiny": other}, small(), seed=0)
    rest = np.setdiff1d(np.arange(48), test)
    assert torch.equal(before[runs[0]][0][0, rest], after[runs[0]][0][0, rest])
    assert not torch.equal(before[runs[0]][0][0, test], after[runs[0]][0][0, test])


@pytest.fixture
def workspace(make_workspace, monkeypatch):
    """A small run on a recording that needs no archive."""
    monkeypatch.setitem(SOURCES, "vitac", lambda path: {"tiny": recording(splits=("random", "blocks"))})
    recorded = {"kind": "vitac", "folder": "nowhere", "repetitions": 1}
    return lambda **changes: make_workspace({"recorded_networks": SMALL | changes, "recorded": recorded})


def measure(workspace):
    stage.run(workspace)
    return read_rows(workspace.measurements / "recorded_networks.csv.gz")


def test_a_finished_training_is_kept_and_other_settings_train_anew(workspace, monkeypatch):
    first = measure(workspace())
    assert set(first["split"]) == {"random", "blocks"} and set(first["pretrained"]) == {"none"}
    monkeypatch.setattr(recorded_training, "_train", lambda *_: pytest.fail("trained again"))
    pd.testing.assert_frame_equal(measure(workspace()), first)
    monkeypatch.setattr(recorded_training, "_train", lambda *_: [{"metric": "accuracy", "value": 0.25, "seconds": 0}])
    assert set(measure(workspace(momentum=0.5))["value"]) == {0.25}
    more = measure(workspace(repetitions={"frozen": 2, "finetuned": 1}))
    assert set(more.loc[more["repetition"] == 1, "value"]) == {0.25}
    pd.testing.assert_frame_equal(more[more["repetition"] == 0].reset_index(drop=True), first)


def test_weights_that_are_not_at_hand_are_named_and_the_control_runs(workspace, monkeypatch, capsys):
    monkeypatch.setattr(recorded_training, "_train", lambda *_: [{"metric": "accuracy", "value": 0.25, "seconds": 0}])
    networks = {"googlenet": ["frozen", "finetuned"]}  # no package registry has its weights
    rows = measure(workspace(networks=networks, weights=["imagenet", "random"]))
    absent = rows[rows["note"] == "not run: weights not at hand"]
    assert absent["value"].isna().all() and set(absent["weights"]) == {"imagenet"}
    assert absent["mode"].tolist() == ["frozen", "finetuned"] and set(absent["data"]) == {"tiny"}
    assert set(rows.loc[rows["value"].notna(), "weights"]) == {"random"}
    assert "googlenet: no package registry has" in capsys.readouterr().err


def test_a_training_to_convergence_learns_from_fewer_touches_and_stops_by_itself():
    settings = small(passes=["printed", "converged"], patience=3, most_epochs=60)
    planned = {training.name: training for training in trials({"toy": recording()}, settings)}
    name = "alexnet-random-frozen-toy-random-0"
    assert list(planned) == [name, f"{name}-converged"]
    rows = pd.DataFrame(process(planned[f"{name}-converged"], None, {"toy": recording()}, settings, 0))
    values = rows.set_index("metric")["value"]
    assert values["epochs"] < 60 and values["train_accuracy"] == 1.0
    assert rows["passes"].unique().tolist() == ["converged"]


def test_a_training_that_diverges_is_a_row_with_a_note_and_the_others_run():
    settings = small(rates={"frozen": [1e38], "finetuned": [0.001]}, passes=["printed", "converged"])
    for training in trials({"toy": recording()}, settings):
        rows = process(training, None, {"toy": recording()}, settings, 0)
        assert [row["value"] for row in rows] == [None] and "diverged" in rows[0]["note"]
    assert stage.summary(rows) == {}


def test_neighbours_of_pressure_images_are_those_of_the_stage_recorded(monkeypatch, tmp_path):
    random = np.random.default_rng(0)
    images = {name: random.random((16, 16)) + 0.5 * random.random((12, 16, 16)) for name in "abcdef"}
    monkeypatch.setattr(data, "read_pressure_images", lambda path: images)
    ours = pd.DataFrame(neighbour_rows("pressure_images", tmp_path, 2, seed=0))
    assert set(ours["method"]) == {"features_knn"}
    touches = describe(images)
    same = pd.DataFrame(image_rows(class_sets(touches, 2, 0)["all"], tmp_path, touches, 0))
    same = same.query("classifier == 'knn' and method == 'all' and metric == 'accuracy' and scaling == 'training'")
    for split in ("random", "blocks"):
        values = [rows.loc[rows["split"] == split, "value"].tolist() for rows in (ours, same)]
        assert values[0] == values[1] and len(values[0]) == 2
    assert neighbour_rows("vitac", tmp_path, 2, seed=0) == []  # pictures of cameras have no such features


def test_neighbours_of_grasps_are_those_of_the_stage_recorded(monkeypatch, tmp_path):
    random, names = np.random.default_rng(0), np.repeat([f"o{k:02}" for k in range(12)], 30)
    electrodes = random.normal(size=(len(names), len(ELECTRODES)))
    slipped = random.random(len(names)) + 0.2 * electrodes[:, 0] < 0.5
    grasps = Grasps(electrodes, names, np.tile(PALMS, len(names) // 3), slipped, names >= "o08")
    monkeypatch.setattr(data, "read_grasps", lambda path: grasps)
    ours = pd.DataFrame(neighbour_rows("biotac_grasps", tmp_path, 1, seed=0))
    same = pd.DataFrame(grasp_rows(Model("knn", None), tmp_path, grasps, 1, 0)).query("scaled == 'training'")
    slips, our_slips = same.query("split == 'test_objects' and palm == 'all'"), ours[ours["data"] == "grasps_slip"]
    assert our_slips[["value", "item"]].values[:-1].tolist() == slips[["value", "item"]].values.tolist()
    assert our_slips["value"].iloc[-1] == pytest.approx(np.average(slips["value"], weights=slips["count"]))
    recognised = same.loc[same["task"] == "recognition", "value"].tolist()
    assert ours.loc[ours["data"] == "grasps_object", "value"].tolist() == recognised

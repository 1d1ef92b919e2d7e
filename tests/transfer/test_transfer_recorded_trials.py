"""Trainings on recorded touches: splits, what is kept of them, and what the summary says."""

import numpy as np
import pandas as pd
import pytest
import torch

from benchmarks import _transfer_data, _transfer_neighbours, transfer
from benchmarks import _transfer_tasks as tasks
from benchmarks import _transfer_trials as trials
from stages.transfer.recorded import Recorded

LABELS = np.repeat([0, 1], 24)
GROUPS = np.array([f"{label}/{k % 6}" for label, k in zip(LABELS, range(48), strict=True)])


def recorded(groups=GROUPS, color=False):
    """Two classes: bright to the left, bright to the right."""
    images = np.random.default_rng(0).integers(0, 60, (48, 8, 10, 3 if color else 1)).astype(np.uint8)
    images[:24, :, :4] += 180
    images[24:, :, 6:] += 180
    return Recorded(images if color else images[..., 0], LABELS, ["left", "right"], groups)


@pytest.mark.parametrize("split", ["random", "runs", "groups"])
def test_parts_are_disjoint_and_hold_all(split):
    learnt, validation, test = trials.parts(recorded(), split, 3, [])
    assert sorted([*learnt, *validation, *test]) == list(range(48))
    for part in (validation, test):
        assert len(part) and set(LABELS[part]) == {0, 1}


def test_no_object_lies_on_two_sides_of_a_split_by_groups():
    sides = [set(GROUPS[part]) for part in trials.parts(recorded(), "groups", 3, [])]
    assert not sides[0] & sides[1] and not sides[0] & sides[2] and not sides[1] & sides[2]
    assert len(sides[2]) == 4  # a quarter of six, in each class


def test_an_object_with_touches_of_both_classes_stays_on_one_side():
    groups = np.array([f"object{k % 6}" for k in range(48)])
    learnt, validation, test = trials.parts(recorded(groups), "test_objects", 1, ["object4"])
    assert set(groups[test]) == {"object4"} and not set(groups[learnt]) & set(groups[validation])


def test_runs_are_neighbours():
    _, _, test = trials.parts(recorded(), "runs", 3, [])
    for label in (0, 1):
        assert (np.diff(np.sort(test[LABELS[test] == label])) == 1).all()


def test_a_class_with_one_recording_cannot_hold_one_out():
    with pytest.raises(ValueError, match="class 0 has too few groups to hold one out"):
        _transfer_data.by_groups(LABELS, np.where(LABELS == 0, "a", GROUPS), 0)


def test_grey_is_red_and_colours_stay():
    color = tasks.as_images(recorded(color=True).images, 16)
    grey = tasks.as_images(recorded().images, 16)
    assert color.shape == grey.shape == (48, 3, 16, 16)
    assert (grey[:, 1:] == 0).all() and (color.mean(dim=(0, 2, 3)) > 0.1).all()
    assert torch.allclose(color[0, 2], tasks.as_images(recorded(color=True).images[..., 2], 16)[0, 0])


@pytest.fixture
def small(monkeypatch, tmp_path):
    """Sources of 48 images, trainings of a few passes, everything kept in a folder of its own."""
    source = _transfer_data.Source("tiny", "images", lambda path: (recorded(), ["0/1", "1/1"]), ("random",), True)
    for module in (trials, tasks):
        monkeypatch.setattr(module, "SOURCES", {"tiny": source})
    monkeypatch.setattr(tasks, "BUILD", tmp_path)
    monkeypatch.setattr(tasks, "COPIES", 1)
    trials.read.cache_clear()
    return tmp_path


def trial(mode, split="random", weights="random", network="mobilenet_v2", size=32):
    return trials.Trial("tiny", network, weights, mode, size, split, 0)


def work(one):
    rows = trials.process(one, {"images": "nowhere"}, "package", "cpu")
    return {(row["object"], row["metric"]): row["value"] for row in rows}


def test_a_frozen_network_learns_its_head_alone(small):
    found = work(trial("frozen", network="alexnet", size=64))  # an untrained one that keeps much of an image
    assert found["all", "accuracy"] >= 0.7 and found["all", "chance"] == found["all", "majority"] == 0.5
    assert found["all", "trained_parameters"] == 2 * 256 + 2


def test_a_finished_training_is_read_and_other_settings_train_anew(small, monkeypatch):
    found = work(trial("frozen"))
    monkeypatch.setattr(trials, "_train", lambda *_: pytest.fail("trained again"))
    assert work(trial("frozen")) == found
    monkeypatch.setattr(trials, "_train", lambda *_: [{"object": "all", "metric": "accuracy", "value": 0.25}])
    monkeypatch.setattr(trials, "MOMENTUM", 0.5)
    assert not list(trials.done("package"))
    assert work(trial("frozen")) == {("all", "accuracy"): 0.25}
    assert [row["value"] for row in trials.done("package")] == [0.25]


def test_the_same_training_gives_the_same_result(small):
    found = work(trial("frozen"))
    for file in (small / "trials").iterdir():
        file.unlink()
    assert work(trial("frozen")) == found


def test_fine_tuning_trains_every_parameter(small, monkeypatch):
    monkeypatch.setitem(trials.EPOCHS, "finetuned", 1)
    monkeypatch.setitem(trials.SEARCH_EPOCHS, "finetuned", 1)
    monkeypatch.setitem(trials.RATES, "finetuned", (0.001,))
    found = work(trial("finetuned", "test_objects"))
    assert found["all", "trained_parameters"] == found["all", "parameters"] > 2e6
    assert {name for name, _ in found} == {"all", "0/1", "1/1"}


def test_passes_over_many_touches_are_fewer():
    assert trials._epochs("finetuned", 825) == 10 and trials._epochs("finetuned", 4373) == 2
    assert trials._epochs("frozen", 4373) == trials.EPOCHS["frozen"]


def test_the_nearest_neighbours_of_reports_touch_are_there():
    found = pd.DataFrame(_transfer_neighbours.nearest_neighbours())
    assert found.groupby("data")["split"].agg(set).to_dict() == {
        "pressure": {"random", "runs"}, "grasps_object": {"random", "runs"}, "grasps_slip": {"test_objects"},
    }  # fmt: skip
    assert found["value"].between(0.05, 1).all() and len(found[found["data"] == "grasps_slip"]) == 11


def test_data_sets_that_are_not_at_hand_are_named():
    found = pd.DataFrame(transfer.not_at_hand({"images": "a", "grasps": "b", "vitac": None, "vt60": None, "bigs": "c"}))
    assert set(found["data"]) == {"vitac", "vt60"} and len(found) == 20
    assert (found["note"] == "not run: data set not at hand").all()

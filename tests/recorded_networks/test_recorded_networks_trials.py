"""Trainings on recorded touches: splits, what is trained, what is kept of it, and what the rows say."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import torch

from stages.compose import compose
from stages.engine.rows import read_rows
from stages.engine.settings import check_section
from stages.recorded_networks import Params, data, trial
from stages.recorded_networks import __main__ as stage
from stages.recorded_networks.data import SOURCES, Recording, object_split, parts
from stages.recorded_networks.trial import Run, Trial, passes, process, trials
from stages.transfer.recorded import Recorded

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
    fit, validation, test = parts(recording(), split, 3)
    assert sorted([*fit, *validation, *test]) == list(range(48))
    for part in (validation, test):
        assert len(part) and set(LABELS[part]) == {0, 1}


def test_no_object_lies_on_two_sides_of_a_split_by_objects():
    sides = [set(GROUPS[part]) for part in parts(recording(), "objects", 3)]
    assert not sides[0] & sides[1] and not sides[0] & sides[2] and not sides[1] & sides[2]
    assert len(sides[2]) == 4  # a quarter of six, in each class


def test_an_object_with_touches_of_both_classes_stays_on_one_side():
    groups = np.array([f"object{k % 6}" for k in range(48)])
    fit, validation, test = parts(recording(groups, kept=("object4",)), "test_objects", 1)
    assert set(groups[test]) == {"object4"} and not set(groups[fit]) & set(groups[validation])


def test_blocks_are_neighbours():
    _, _, test = parts(recording(), "blocks", 3)
    for label in (0, 1):
        assert (np.diff(np.sort(test[LABELS[test] == label])) == 1).all()


def test_a_class_with_one_recording_cannot_hold_one_out():
    with pytest.raises(ValueError, match="class 0 has too few groups to hold one out"):
        object_split(LABELS, np.where(LABELS == 0, "a", GROUPS), 0)


def test_objects_that_nobody_knows_cannot_be_held_out():
    with pytest.raises(ValueError, match="do not say which object a touch is of"):
        parts(recording(groups=None), "objects", 0)


def test_grey_is_red_and_colours_stay():
    color = data.as_images(recording(color=True).touches.images, 16)
    grey = data.as_images(recording().touches.images, 16)
    assert color.shape == grey.shape == (48, 3, 16, 16)
    assert (grey[:, 1:] == 0).all() and (color.mean(dim=(0, 2, 3)) > 0.1).all()
    assert torch.allclose(color[0, 2], data.as_images(recording(color=True).touches.images[..., 2], 16)[0, 0])


def train(tmp_path, mode, split="random", network="mobilenet_v2", kept=(), **changes):
    """{(item, metric): value} of one training."""
    one = Trial(network, "random", mode, (Run("tiny", split, 0),))
    rows = process(one, tmp_path, {"tiny": recording(kept=kept)}, small(**changes), seed=0)
    return {(row.get("item", ""), row["metric"]): row["value"] for row in rows}


@pytest.mark.slow
def test_a_frozen_network_learns_its_head_alone(tmp_path):
    found = train(tmp_path, "frozen", network="alexnet", size=64)  # an untrained one that keeps much of an image
    assert found["", "accuracy"] >= 0.7 and found["", "chance"] == found["", "majority"] == 0.5
    assert found["", "trained_parameters"] == 2 * 256 + 2


@pytest.mark.slow
def test_the_same_training_gives_the_same_result(tmp_path):
    assert train(tmp_path, "frozen") == train(tmp_path, "frozen")


@pytest.mark.slow
def test_fine_tuning_trains_every_parameter(tmp_path):
    found = train(tmp_path, "finetuned", "test_objects", kept=("0/1", "1/1"))
    assert found["", "trained_parameters"] == found["", "parameters"] > 2e6
    assert {name for name, _ in found} == {"", "0/1", "1/1"}


@pytest.mark.slow
def test_passes_over_many_touches_are_fewer():
    settings = check_section(Params, default("pressure_images"))
    assert passes("finetuned", 825, settings) == 10 and passes("finetuned", 4373, settings) == 2
    assert passes("frozen", 4373, settings) == settings.epochs["frozen"]


def default(dataset):
    return compose([f"sets=[{dataset}]"])[dataset]["recorded_networks"]


def test_frozen_trainings_share_their_features_and_fine_tuned_ones_stand_alone():
    networks = {"mobilenet_v2": ["frozen", "finetuned"]}
    settings = small(networks=networks, weights=["imagenet", "random"], repetitions={"frozen": 2, "finetuned": 2})
    found = trials({"a": recording(splits=("random", "blocks")), "b": recording()}, settings)
    shared = [[{run.repetition for run in one.runs} for one in found if len(one.runs) == size] for size in (6, 3)]
    assert shared == [[{0, 1}], [{0}, {1}]]  # an untrained network is drawn for each repetition
    assert len(found) == 3 + 12 and len({one.name for one in found}) == len(found)


@pytest.mark.slow
def test_what_has_other_images_has_features_of_its_own(monkeypatch):
    computed, frozen_features = [], trial.frozen_features
    monkeypatch.setattr(trial, "frozen_features", lambda *given: computed.append(1) or frozen_features(*given))
    turned = replace(recording().touches, images=recording().touches.images[:, ::-1, ::-1])
    both = {"tiny": recording(), "same": recording(), "other": Recording(turned, ("random",), True)}
    one = Trial("mobilenet_v2", "random", "frozen", tuple(Run(name, "random", 0) for name in both))
    found = trial.frozen_features_by_data(one, both, small(), seed=0)
    assert len(computed) == 2 and found["tiny"][0] is found["same"][0]
    alone = trial.frozen_features_by_data(replace(one, runs=one.runs[2:]), both, small(), seed=0)
    assert torch.equal(found["other"][0], alone["other"][0]) and not torch.equal(found["other"][0], found["tiny"][0])
    second = replace(one, runs=(one.runs[2]._replace(repetition=1),))
    drawn = trial.frozen_features_by_data(second, both, small(), seed=0)["other"][0]
    assert not torch.equal(alone["other"][0], drawn)


def test_a_strange_mode_is_named():
    with pytest.raises(ValueError, match="'thawed' is not one of frozen, finetuned"):
        trials({"a": recording()}, small(networks={"alexnet": ["thawed"]}))


@pytest.fixture
def workspace(make_workspace, monkeypatch):
    """A small run on a recording that needs no archive."""
    monkeypatch.setitem(SOURCES, "vitac", lambda path: {"tiny": recording(splits=("random", "blocks"))})
    recorded = {"kind": "vitac", "folder": "nowhere", "repetitions": 1}
    return lambda **changes: make_workspace({"recorded_networks": SMALL | changes, "recorded": recorded})


def measure(workspace):
    stage.run(workspace)
    return read_rows(workspace.measurements / "recorded_networks.csv.gz")


@pytest.mark.slow
def test_a_finished_training_is_kept_and_other_settings_train_anew(workspace, monkeypatch):
    found = measure(workspace())
    assert set(found["split"]) == {"random", "blocks"} and set(found["pretrained"]) == {"none"}
    monkeypatch.setattr(trial, "_train", lambda *_: pytest.fail("trained again"))
    pd.testing.assert_frame_equal(measure(workspace()), found)
    monkeypatch.setattr(trial, "_train", lambda *_: [{"metric": "accuracy", "value": 0.25, "seconds": 0}])
    assert set(measure(workspace(momentum=0.5))["value"]) == {0.25}
    more = measure(workspace(repetitions={"frozen": 2, "finetuned": 1}))
    assert set(more.loc[more["repetition"] == 1, "value"]) == {0.25}
    pd.testing.assert_frame_equal(more[more["repetition"] == 0].reset_index(drop=True), found)


@pytest.mark.slow
def test_weights_that_are_not_at_hand_are_named_and_the_control_runs(workspace, monkeypatch, capsys):
    monkeypatch.setattr(trial, "_train", lambda *_: [{"metric": "accuracy", "value": 0.25, "seconds": 0}])
    networks = {"googlenet": ["frozen", "finetuned"]}  # no package registry has its weights
    found = measure(workspace(networks=networks, weights=["imagenet", "random"]))
    absent = found[found["note"] == "not run: weights not at hand"]
    assert absent["value"].isna().all() and set(absent["weights"]) == {"imagenet"}
    assert absent["mode"].tolist() == ["frozen", "finetuned"] and set(absent["data"]) == {"tiny"}
    assert set(found.loc[found["value"].notna(), "weights"]) == {"random"}
    assert "googlenet: no package registry has" in capsys.readouterr().err


def test_a_training_to_convergence_learns_from_fewer_touches_and_stops_by_itself():
    settings = small(passes=["printed", "converged"], patience=3, most_epochs=60)
    found = {one.name: one for one in trials({"toy": recording()}, settings)}
    assert list(found) == ["alexnet-random-frozen-toy-random-0", "alexnet-random-frozen-toy-random-0-converged"]
    rows = pd.DataFrame(
        process(found["alexnet-random-frozen-toy-random-0-converged"], None, {"toy": recording()}, settings, 0)
    )
    values = rows[rows["group"].isna()].set_index("metric")["value"]
    assert values["epochs"] < 60 and values["train_accuracy"] == 1.0
    assert rows["passes"].unique().tolist() == ["converged"]
    classes = rows[rows["metric"] == "class_accuracy"].set_index("group")["value"]
    assert classes.index.tolist() == ["left", "right"] and classes.mean() == pytest.approx(values["accuracy"])


def test_a_training_that_diverges_is_a_row_with_a_note_and_the_others_run():
    settings = small(rates={"frozen": [1e38], "finetuned": [0.001]}, passes=["printed", "converged"])
    for one in trials({"toy": recording()}, settings):
        rows = process(one, None, {"toy": recording()}, settings, 0)
        assert [row["value"] for row in rows] == [None] and "diverged" in rows[0]["note"]
    assert stage.summary(rows) == {}

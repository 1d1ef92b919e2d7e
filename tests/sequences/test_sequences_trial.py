"""Splits, smaller sequences, the plan, and whole trials on small films."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import read_arrays
from stages.contours.contours import Sequences, write_sequences
from stages.sequences import sequence_trials as trials
from stages.sequences.__main__ import confusion_rows, layer_rows, summary
from stages.sequences.classifiers import CONVENTIONAL
from stages.sequences.sequence_trials import (
    Trial,
    count_sequences,
    downsample,
    plan,
    process,
    read_sequence_data,
    split_by_objects,
    split_by_sequences,
)

pytestmark = pytest.mark.slow

CLASSES = {"flat": ["plate", "tray"], "round": ["ball", "egg"]}
SETTINGS = SimpleNamespace(
    repetitions=1, trainings=1, image_epochs=3, normal_epochs=3, smaller_strategy="guided", smaller=["5x4"],
    smaller_networks=["9x8"],
)  # fmt: skip


def changed(**settings):
    return SimpleNamespace(**vars(SETTINGS) | settings)


def sequences(level, count=10, frames=10, cells=8, seed=0):
    """Sequences whose imprints brighten from left to right by `level`."""
    random = np.random.default_rng(seed)
    slope = np.linspace(0, level, cells)
    images = (slope + random.integers(0, 30, (count, frames, cells, cells))).astype(np.uint8)
    normals = random.normal(size=(count, frames, 3)).astype(np.float32)
    rest = np.zeros((count, frames, 3), np.float32), np.ones((count, frames), np.float32), np.zeros((count, 2), int)
    return Sequences(images, normals, *rest)


@pytest.fixture
def contours(tmp_path, monkeypatch):
    """The folder data/toys/contours in which two classes of two objects have sequences by two strategies."""
    for level, objects in zip((20, 220), CLASSES.values(), strict=True):
        for k, name in enumerate(objects):
            strategies = {strategy: sequences(level, seed=k) for strategy in ("guided", "random")}
            write_sequences(tmp_path / "data/toys/contours" / f"{name}.npz", strategies)
    monkeypatch.setattr("stages.sequences.classifiers.NEURONS", 30)  # quicker; few samples need no more
    return tmp_path / "data/toys/contours"


def test_random_split_takes_a_fifth_of_every_class():
    labels = np.repeat([0, 1, 2], [50, 30, 20])
    split = split_by_sequences(labels, np.random.default_rng(0))
    assert np.bincount(labels[split.test]).tolist() == [10, 6, 4]
    assert sorted([*split.train, *split.test]) == list(range(100))
    assert set(split.validation) < set(split.train)
    assert sorted([*split.fit, *split.validation]) == split.train.tolist()


def test_left_out_objects_are_on_one_side_alone():
    labels, ranks = np.repeat([0, 1], 30), np.tile(np.repeat([0, 1, 2], 10), 2)
    for fold in range(3):
        split = split_by_objects(labels, ranks, fold, 3, np.random.default_rng(0))
        assert set(ranks[split.test]) == {fold}
        assert set(ranks[split.train]) == {0, 1, 2} - {fold}
        assert set(ranks[split.validation]) == {(fold + 1) % 3}
        assert set(ranks[split.fit]) == {(fold + 2) % 3}
        assert set(labels[split.test]) == set(labels[split.fit]) == {0, 1}


def test_of_two_objects_the_check_is_drawn_from_the_one_that_trains():
    labels, ranks = np.repeat([0, 1], 20), np.tile(np.repeat([0, 1], 10), 2)
    split = split_by_objects(labels, ranks, 0, 2, np.random.default_rng(0))
    assert set(ranks[split.validation]) == set(ranks[split.fit]) == {1}
    assert len(split.validation) == 4 and len(split.fit) == 16


def test_data_know_class_and_object_and_smaller_ones_are_evenly_spread_frames_of_means_of_blocks(contours):
    assert count_sequences(contours / "ball.npz") == {"guided": 10, "random": 10}
    data = read_sequence_data(contours, CLASSES, "random")
    assert data.labels.tolist() == [0] * 20 + [1] * 20
    assert data.ranks.tolist() == ([0] * 10 + [1] * 10) * 2
    assert data.folds == 2 and data.classes == ["flat", "round"]
    less = downsample(data, 5, 4)
    assert less.images.shape == (40, 5, 4, 4) and less.images.dtype == np.uint8
    np.testing.assert_array_equal(less.normals, data.normals[:, [0, 2, 4, 6, 8]])
    assert less.images[3, 1, 2, 1] == np.round(data.images[3, 2, 4:6, 2:4].mean())
    assert downsample(data, 10, 8) is data
    oblong = replace(data, images=data.images[:, :, :4])
    assert downsample(oblong, 10, 2).images.shape == (40, 10, 2, 4)
    for frames, cells, word in ((11, 8, "frames requested"), (0, 8, "frames"), (10, 3, "averaged")):
        with pytest.raises(ValueError, match=word):
            downsample(data, frames, cells)


def test_plan_holds_both_splits_and_the_smaller_sequences(contours):
    planned = plan(CLASSES, contours, SETTINGS)
    names = [trial.name for trial in planned.trials]
    assert not planned.notes and len(names) == len(set(names)) == 2 * 3 * 2 + 2 + 2
    assert {"guided.random.0.networks.10x8", "random.objects.1.conventional.10x8"} <= set(names)
    assert {"guided.objects.0.conventional.5x4", "guided.objects.1.networks.9x8"} <= set(names)
    assert all(Trial.parse(name) == trial for name, trial in zip(names, planned.trials, strict=True))


def test_each_fold_of_objects_is_trained_for_as_often_as_asked(contours, tmp_path):
    settings = changed(trainings=2, smaller=[], smaller_networks=[])
    names = [trial.name for trial in plan(CLASSES, contours, settings).trials if trial.split == "objects"]
    assert len(names) == 2 * 2 * 2 * 2 and "guided.objects.3.networks.10x8" in names
    first, again = (
        pd.DataFrame(process(f"guided.objects.{k}.networks.10x8", tmp_path, contours.parent, CLASSES, settings, seed=0))
        for k in (1, 3)
    )
    assert set(first["repetition"]) == set(again["repetition"]) == {1}
    assert set(first["training"]) == {0} and set(again["training"]) == {1}
    tested = [read_arrays(tmp_path / f"predictions/guided.objects.{k}.networks.10x8.npz")["test"] for k in (1, 3)]
    assert np.array_equal(*tested)


@pytest.mark.parametrize("split", ["random", "objects"])
def test_trials_tell_clear_classes_apart_and_the_same_way_again(contours, tmp_path, split):
    def train(kind):
        return process(f"guided.{split}.0.{kind}.10x8", tmp_path, contours.parent, CLASSES, SETTINGS, seed=0)

    kinds = ("conventional", "networks") if split == "random" else ("networks", "conventional")
    once, again = train(kinds[0]), train(kinds[0])
    assert [row["value"] for row in once] == [row["value"] for row in again]
    rows = once + train(kinds[1])
    frame = pd.DataFrame(rows)
    rates = frame[frame["metric"] == "accuracy"].set_index("classifier")["value"]
    assert set(rates.index) == {"cnn", "cnn_images", "cnn_normals", *CONVENTIONAL}
    assert (rates[["cnn", "cnn_images", "svm_no_som"]] > 0.8).all()
    assert set(frame.loc[frame["metric"] == "map_dimensions", "classifier"]) == {"knn", "svm"}
    assert (frame.loc[frame["metric"] == "accuracy", "seconds"] > 0).all()
    assert {row.get("group") for row in rows} - {None} == (set(CLASSES) if split == "objects" else set())


def test_rows_hold_every_answer_and_layer(contours, tmp_path, monkeypatch):
    monkeypatch.setattr(trials, "CONVENTIONAL", ("knn_no_som", "svm_no_som"))
    planned = plan(CLASSES, contours, SETTINGS)
    selected = [trial for trial in planned.trials if trial.strategy == "guided" and trial.kind == "conventional"]
    rows = [
        row for trial in selected for row in process(trial.name, tmp_path, contours.parent, CLASSES, SETTINGS, seed=0)
    ]
    counts = pd.DataFrame(confusion_rows(tmp_path, selected, ["flat", "round"]))
    totals = counts.groupby(["split", "classifier"])["value"].sum()
    assert len(totals) == 2 * 2 and (totals["objects"] == 40).all() and (totals["random"] == 8).all()
    tree = summary(rows, seed=0)
    assert tree["chance"] == 0.5 and tree["guided"]["objects"]["svm_no_som"]["mean"] > 0.6
    table = pd.DataFrame(layer_rows(planned.trials, 2))
    assert set(table["classifier"]) == {"cnn_images", "cnn_normals"} and table["value"].sum() > 1000

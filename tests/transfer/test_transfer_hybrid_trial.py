"""One hybrid network from files to rows, on toy objects and an untrained network, and new objects from few touches."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from sklearn.neighbors import KNeighborsClassifier

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.deep.hybrid import load
from haptic_glance.deep.network import build
from stages.transfer import hybrid
from stages.transfer.new_object import LEARNERS, METRIC, scores

pytestmark = pytest.mark.slow

CLASSES = {"cup": ["mug", "glass"], "dog": ["poodle", "pug"]}
MEMBERS = dict.fromkeys(("random", "objects"), CLASSES)
NAME = "hybrid.18-139.objects.0"
SETTINGS = {
    "size": 32, "cells": 32, "coarse_cells": [], "splits": {"random": 2, "objects": 1}, "train_share": 0.75,
    "validation_share": 0.25, "epochs": 1, "batch": 4, "momentum": 0.9, "device": "cpu", "source": "package",
    "patience": 1, "most_epochs": 1, "hybrid_rate": 0.003, "hybrid_passes": "printed",
    "hybrid_middles": ["18:139", "18:147"], "hybrid_onnx": False,
    "hybrid_severities": {"picture_noise": [0.1], "imprint_dead_cells": [0.1]}, "new_object_touches": [1, 2],
}  # fmt: skip


def process(folder, **changed):
    """Rows of the first repetition with whole objects left out, from untrained networks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hybrid, "build", lambda name, classes, *_: build(name, classes, "random", 0))
        return hybrid.process(NAME, folder, folder, MEMBERS, SimpleNamespace(**SETTINGS | changed), 0)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """(folder, rows) of toy objects."""
    folder, random = tmp_path_factory.mktemp("transfer"), np.random.default_rng(0)
    for name in sum(CLASSES.values(), []):
        pictures = random.integers(0, 256, (8, 32, 32, 3)).astype(np.uint8)
        imprints = random.integers(0, 256, (8, 32, 32)).astype(np.uint8)
        write_arrays(folder / "hybrid" / "pictures" / f"{name}.npz", images=pictures, viewpoints=np.zeros((8, 2)))
        write_arrays(folder / "imprints" / f"{name}.npz", vertices=np.arange(8), imprints32=imprints)
    return folder, process(folder)


def values(rows, **about):
    return [row["value"] for row in rows if about.items() <= row.items()]


def test_the_hybrid_answers_as_the_two_networks_it_was_made_of_in_less_room(run):
    _, rows = run
    assert max(values(rows, metric="max_difference", method="hybrid")) < 1e-5
    for sense in ("vision", "touch"):
        known = {"metric": "accuracy", "sense": sense}
        assert values(rows, method="hybrid", **known) == values(rows, method=sense, **known)
    names = ("hybrid", "hybrid_float16", "hybrid_int8")
    whole, half, eighth = (values(rows, method=name, metric="size_ratio")[0] for name in names)
    assert 1.4 < whole < half / 1.8 < eighth / 2.5


def test_a_run_says_how_many_passes_its_trainings_made_and_how_much_they_learned(run):
    assert {row["passes"] for row in run[1]} == {"printed"} and values(run[1], metric="epochs") == [1, 1]
    learned = values(run[1], metric="train_accuracy")
    assert len(learned) == 2 and all(0 <= share <= 1 for share in learned)


def test_validation_items_end_a_training_until_nothing_improves(run, tmp_path, monkeypatch):
    """A rate that learns nothing: the first pass is the best one, and two more are waited for."""
    monkeypatch.setattr(hybrid, "build", lambda name, classes, *_: build(name, classes, "random", 0))
    changed = {"hybrid_passes": "converged", "hybrid_rate": 1e-9, "patience": 2, "most_epochs": 9}
    settings, trial = SimpleNamespace(**SETTINGS | changed), hybrid.HybridTrial.parse(NAME)
    random = np.random.default_rng(0)
    sense = hybrid.split_sense(hybrid.read_senses(run[0], CLASSES, settings)[1], trial, settings, random)
    assert hybrid.train_sense(sense, "touch", trial, 2, settings, random, tmp_path / "touch.pt").epochs == 3


def test_every_condition_has_every_answer(run):
    _, rows = run
    answered = {(row["perturbation"], row["method"]) for row in rows if row.get("sense") == "both"}
    conditions = {"none", "picture_noise", "imprint_dead_cells", "picture_missing", "imprint_missing"}
    assert answered == {(condition, method) for condition in conditions for _, method in answered}
    assert values(rows, perturbation="picture_missing", method="vision") == [0.0]
    alone = values(rows, perturbation="none", method="touch")
    for method in ("fusion_entropy", "fusion_product", "sum_touch"):
        assert values(rows, perturbation="picture_missing", method=method) == alone


def test_rows_and_files_hold_the_network_and_its_answers(run):
    folder, rows = run
    about = {"data": "hybrid", "weights": "imagenet", "mode": "18:139", "split": "objects", "repetition": 0}
    assert all(about.items() <= row.items() and np.isfinite(row["value"]) for row in rows)
    assert [path.name for path in (folder / "hybrid/networks").iterdir()] == [f"{NAME}.npz"]
    network, classes = load(folder / f"hybrid/networks/{NAME}.npz")
    assert classes == list(CLASSES) and (network.temperature > 0).all()
    stored = read_arrays(folder / f"hybrid/predictions/{NAME}.npz")
    assert stored["vision_scores"].shape == (16, 2) and stored["touch_true"].tolist() == [0] * 8 + [1] * 8
    summary = hybrid.summary(rows, SimpleNamespace(**SETTINGS), 0)["objects"]
    assert set(summary) == {"accuracy_vision", "accuracy_touch", "max_difference", "size_ratio"}
    assert summary["size_ratio"]["mean"] == pytest.approx(1.43, abs=0.01)


def test_confusion_counts_every_test_item_that_felt_something_once(run, tmp_path):
    frame = pd.DataFrame([row for row in run[1] if row["metric"] == "confusion"])
    assert frame.groupby(["sense", "group"])["value"].sum().tolist() == [8] * 4
    sense = {"scores": np.array([[0.0, 1.0], [np.nan, np.nan], [1.0, 0.0]]), "true": np.array([0, 0, 1])}
    stored = {f"{name}_{part}": value for name in ("vision", "touch") for part, value in sense.items()}
    write_arrays(tmp_path / "predictions.npz", **stored)
    rows = hybrid.confusion_rows(tmp_path / "predictions.npz", ["a", "b"])
    touch = [(row["group"], row["predicted"], row["value"]) for row in rows if row["sense"] == "touch"]
    assert touch == [("a", "b", 1), ("b", "a", 1)]


def test_an_answer_where_the_other_has_none_is_no_equality(monkeypatch, tmp_path):
    images, labels = np.zeros((2, 3, 4, 4)), np.array([0, 1])
    sense = SimpleNamespace(images=images, labels=labels, test=np.arange(2))
    answers, path = np.array([[np.nan, np.nan], [0.5, 0.25]]), tmp_path / "net.onnx"
    path.write_bytes(b"")
    monkeypatch.setattr(hybrid, "export_onnx", lambda *_: None)
    monkeypatch.setattr(hybrid, "sense_scores", lambda *_: answers)
    monkeypatch.setattr(hybrid, "single_sense", lambda images, kind: images)
    for exported, expected in ((answers + 0.125, 0.125), (np.nan_to_num(answers), np.inf)):
        monkeypatch.setattr(hybrid, "onnx_scores", lambda *_, answer=exported: [answer] * 2)
        rows = list(hybrid.onnx_rows(None, [sense] * 2, SimpleNamespace(size=4), path))
        assert values(rows, metric="max_difference") == [expected]


def test_every_middle_has_a_network_for_each_split_and_repetition():
    settings = SimpleNamespace(**SETTINGS)
    names = hybrid.trials(settings, MEMBERS)
    repetitions = ("random.0", "random.1", "objects.0")
    assert names == [f"hybrid.{middle}.{repetition}" for middle in ("18-139", "18-147") for repetition in repetitions]
    assert [hybrid.HybridTrial.parse(name).name for name in names] == names
    alone = {"random": CLASSES, "objects": {"cup": ["mug", "glass"]}}
    assert not any("objects" in name for name in hybrid.trials(settings, alone))
    settings.splits = {"random": 0, "objects": 0}
    assert hybrid.trials(settings, MEMBERS) == []


def test_new_objects_are_learned_from_every_count_by_every_head(run):
    frame = pd.DataFrame([row for row in run[1] if row["metric"] == METRIC])
    chance, learned = frame[frame["method"] == "chance"], frame[frame["method"] != "chance"]
    assert chance["value"].tolist() == [0.5] and set(learned["severity"]) == {1, 2}
    assert set(learned["item"]) == {"mug", "poodle"} and learned.groupby(["method", "severity"]).size().eq(2).all()
    assert learned["value"].between(0, 1).all() and (learned["seconds"] > 0).all()


@pytest.mark.parametrize("learner", LEARNERS)
def test_new_objects_are_told_by_the_touches_that_were_learned_and_asked_about_others(learner):
    """Features that lie apart need one touch; where every touch is like no other, only a learned one would be known."""
    objects = np.repeat([3, 7], 5)
    features = 9.0 * objects[:, None] + np.random.default_rng(0).normal(size=(10, 4))
    draws = [np.random.default_rng(k).permutation(10) for k in range(3)]
    assert scores(learner, features, objects, draws, 1, 3)[0] == {3: 1.0, 7: 1.0}
    objects, features = np.repeat([0, 1], 4), np.eye(8)
    features[:, 0] = np.tile([0, 1], 4)  # misleads: as often in either object
    draws = [np.random.default_rng(k).permutation(8) for k in range(10)]
    assert np.mean(list(scores(learner, features, objects, draws, 2, 2)[0].values())) < 0.9


def test_as_many_touches_of_each_object_are_learned_as_are_asked_for(monkeypatch):
    learned = []

    class Spy(KNeighborsClassifier):
        def fit(self, X, y):
            learned.append(np.unique(y, return_counts=True)[1].tolist())
            return super().fit(X, y)

    monkeypatch.setitem(LEARNERS, "nearest", lambda: Spy(n_neighbors=1))
    features = np.random.default_rng(0).normal(size=(18, 4))
    scores("nearest", features, np.repeat([0, 1, 2], 6), [np.arange(18)], 3, 4)
    assert learned == [[3, 3, 3]]

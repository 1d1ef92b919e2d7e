"""One hybrid network from files to rows, on toy objects and an untrained network, and the settings that it refuses."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.deep.hybrid import load
from haptic_glance.deep.network import build
from stages.transfer import hybrid
from stages.transfer.new_object import METRIC
from stages.transfer.plan import middle_of

pytestmark = pytest.mark.slow

MEMBERS = {"cup": ["mug", "glass"], "dog": ["poodle", "pug"]}
SETTINGS = {
    "size": 32, "cells": 32, "coarse_cells": [], "splits": {"random": 2, "objects": 2}, "train_share": 0.75,
    "validation_share": 0.25, "epochs": 1, "batch": 4, "momentum": 0.9, "device": "cpu", "source": "package",
    "hybrid_rate": 0.003, "hybrid_middles": ["18:139", "18:147"], "hybrid_onnx": False,
    "hybrid_severities": {"picture_noise": [0.1], "imprint_dead_cells": [0.1]}, "new_object_touches": [1, 2],
}  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """(folder, rows) of the first repetition with whole objects left out."""
    folder, random = tmp_path_factory.mktemp("transfer"), np.random.default_rng(0)
    for objects in MEMBERS.values():
        for name in objects:
            pictures = random.integers(0, 256, (8, 32, 32, 3)).astype(np.uint8)
            imprints = random.integers(0, 256, (8, 32, 32)).astype(np.uint8)
            write_arrays(folder / "hybrid" / "pictures" / f"{name}.npz", images=pictures, viewpoints=np.zeros((8, 2)))
            write_arrays(folder / "imprints" / f"{name}.npz", vertices=np.arange(8), imprints32=imprints)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hybrid, "build", lambda name, classes, *_: build(name, classes, "random", 0))
        rows = hybrid.process("hybrid.18-139.objects.0", folder, folder, members(), SimpleNamespace(**SETTINGS), 0)
    return folder, rows


def members():
    return dict.fromkeys(("random", "objects"), MEMBERS)


def values(rows, **about):
    return [row["value"] for row in rows if about.items() <= row.items()]


def test_the_hybrid_answers_as_the_two_networks_it_was_made_of(run):
    _, rows = run
    assert max(values(rows, metric="max_difference", method="hybrid")) < 1e-5
    for sense in ("vision", "touch"):
        known = {"metric": "accuracy", "sense": sense}
        assert values(rows, method="hybrid", **known) == values(rows, method=sense, **known)


def test_smaller_kinds_take_less_room(run):
    _, rows = run
    whole, half, eighth = (
        values(rows, method=name, metric="size_ratio")[0] for name in ("hybrid", "hybrid_float16", "hybrid_int8")
    )
    assert 1.4 < whole < half / 1.8 < eighth / 2.5


def test_every_condition_has_every_answer(run):
    _, rows = run
    found = {(row["perturbation"], row["method"]) for row in rows if row.get("sense") == "both"}
    conditions = {"none", "picture_noise", "imprint_dead_cells", "picture_missing", "imprint_missing"}
    assert found == {(one, method) for one in conditions for _, method in found}
    assert values(rows, perturbation="picture_missing", method="vision") == [0.0]
    alone = values(rows, perturbation="none", method="touch")
    for method in ("fusion_entropy", "fusion_product", "sum_touch"):
        assert values(rows, perturbation="picture_missing", method=method) == alone


def test_rows_say_what_they_are_of(run):
    _, rows = run
    about = {"data": "hybrid", "weights": "imagenet", "mode": "18:139", "split": "objects", "repetition": 0}
    assert all(about.items() <= row.items() and np.isfinite(row["value"]) for row in rows)


def test_files_hold_the_network_and_its_answers(run):
    folder, _ = run
    network, classes = load(folder / "hybrid" / "networks" / "hybrid.18-139.objects.0.npz")
    assert classes == list(MEMBERS) and (network.temperature > 0).all()
    assert [path.name for path in (folder / "hybrid" / "networks").iterdir()] == ["hybrid.18-139.objects.0.npz"]
    stored = read_arrays(folder / "hybrid" / "predictions" / "hybrid.18-139.objects.0.npz")
    assert stored["vision_scores"].shape == (16, 2) and stored["touch_true"].tolist() == [0] * 8 + [1] * 8


def test_confusion_counts_every_test_item_once(run):
    frame = pd.DataFrame([row for row in run[1] if row["metric"] == "confusion"])
    assert frame.groupby(["sense", "group"])["value"].sum().tolist() == [8] * 4


def test_confusion_leaves_out_a_touch_that_felt_nothing(tmp_path):
    scores, true = np.array([[0.0, 1.0], [np.nan, np.nan], [1.0, 0.0]]), np.array([0, 0, 1])
    stored = {f"{sense}_{part}": value for sense in ("vision", "touch") for part, value in
              (("scores", scores), ("true", true))}  # fmt: skip
    write_arrays(tmp_path / "predictions.npz", **stored)
    found = hybrid.confusion_rows(tmp_path / "predictions.npz", ["a", "b"])
    touch = [(row["group"], row["predicted"], row["value"]) for row in found if row["sense"] == "touch"]
    assert touch == [("a", "b", 1), ("b", "a", 1)]


def test_an_answer_where_the_other_has_none_is_no_equality(monkeypatch, tmp_path):
    images, labels = np.zeros((2, 3, 4, 4)), np.array([0, 1])
    sense = SimpleNamespace(images=images, labels=labels, test=np.arange(2))
    own, path = np.array([[np.nan, np.nan], [0.5, 0.25]]), tmp_path / "net.onnx"
    path.write_bytes(b"")
    monkeypatch.setattr(hybrid, "export_onnx", lambda *_: None)
    monkeypatch.setattr(hybrid, "sense_scores", lambda *_: own)
    monkeypatch.setattr(hybrid, "single_sense", lambda images, kind: images)
    for found, expected in ((own + 0.125, 0.125), (np.nan_to_num(own), np.inf)):
        monkeypatch.setattr(hybrid, "onnx_scores", lambda *_, answer=found: [answer] * 2)
        rows = list(hybrid.onnx_rows(None, [sense] * 2, SimpleNamespace(size=4), path))
        assert values(rows, metric="max_difference") == [expected]


def test_summary_holds_what_the_gate_watches(run):
    found = hybrid.summary(run[1], SimpleNamespace(**SETTINGS), 0)["objects"]
    assert set(found) == {"accuracy_vision", "accuracy_touch", "max_difference", "size_ratio"}
    assert found["size_ratio"]["mean"] == pytest.approx(1.43, abs=0.01)


def test_every_middle_has_a_network_for_each_split_and_repetition():
    names = hybrid.trials(SimpleNamespace(**SETTINGS), members())
    assert names == [
        "hybrid.18-139.random.0", "hybrid.18-139.random.1", "hybrid.18-139.objects.0", "hybrid.18-139.objects.1",
        "hybrid.18-147.random.0", "hybrid.18-147.random.1", "hybrid.18-147.objects.0", "hybrid.18-147.objects.1",
    ]  # fmt: skip
    assert [hybrid.HybridTrial.parse(name).name for name in names] == names


def test_no_repetitions_and_no_classes_are_no_trials():
    assert hybrid.trials(SimpleNamespace(**SETTINGS | {"splits": {"random": 0, "objects": 0}}), members()) == []
    alone = {"random": MEMBERS, "objects": {"cup": ["mug", "glass"]}}
    assert not any("objects" in name for name in hybrid.trials(SimpleNamespace(**SETTINGS), alone))


def test_ranges_are_whole_blocks():
    assert middle_of("18:139") == (3, 17) and middle_of("18:147") == (3, 18)
    for layers in ("16:138", "1:150", "18:150"):
        with pytest.raises(ValueError, match="whole blocks"):
            middle_of(layers)


def test_new_objects_are_learned_from_every_count_by_every_head(run):
    frame = pd.DataFrame([row for row in run[1] if row["metric"] == METRIC])
    chance, told = frame[frame["method"] == "chance"], frame[frame["method"] != "chance"]
    assert chance["value"].tolist() == [0.5] and set(told["severity"]) == {1, 2}
    assert set(told["item"]) == {"mug", "poodle"} and told.groupby(["method", "severity"]).size().eq(2).all()
    assert told["value"].between(0, 1).all() and (told["seconds"] > 0).all()

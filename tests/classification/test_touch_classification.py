"""The classification stage on a small folder of imprints."""

import numpy as np
import pytest

from haptic_glance.base.files import read_arrays, read_json
from haptic_glance.know import CLASSIFIERS, evaluate
from stages.classification import Params
from stages.classification.__main__ import over_repetitions, plan, process, run, summary
from stages.engine.rows import read_rows
from stages.imprints.imprints import Imprints, write_imprints

NAMES = ("cup", "duck", "hand")


@pytest.fixture
def imprints(tmp_path, bumps):
    """data/toys/imprints of three objects: sampling `random` with 16 imprints each, `itti` with 16, of the duck 12."""
    folder = tmp_path / "data/toys/imprints"
    for name, images in bumps(NAMES, 16, jitter=2.0).items():
        places = np.arange(48.0).reshape(16, 3)
        touched = {
            sampling: Imprints(images[:count], np.arange(count), places[:count], 0.01)
            for sampling, count in (("random", 16), ("itti", 12 if name == "duck" else 16))
        }
        write_imprints(folder / f"{name}.npz", touched)
    return folder


def settings(**changes):
    values = {
        "sets": {"three": list(NAMES)}, "drawn": 0, "classifiers": ["knn"], "repetitions": 1, "closer": [],
        "touches": [1, 2], "combinations": 2,
    }  # fmt: skip
    return Params(**values | changes)


def test_samplings_of_a_set_use_equally_many_imprints_and_what_is_left_out_is_named(imprints, tmp_path, bumps):
    sets = {"three": list(NAMES), "two": ["hand", "cup"], "gone": ["cow", "cup"]}
    planned = plan(sets, imprints)
    missing = planned.pop("gone.")
    assert planned == {"three.itti": 12, "three.random": 12, "two.itti": 16, "two.random": 16}
    assert "no imprints of cow" in missing and "cup, duck, hand" in missing
    few, many = (Imprints(bumps()["cup"][:n], np.arange(n), np.zeros((n, 3)), 0.01) for n in (9, 16))
    write_imprints(imprints / "cup.npz", {"itti": few, "random": many})
    planned = plan(settings().sets, imprints)
    assert planned["three.random"] == 16 and "itti: cup has 9 imprints" in planned["three.itti"]
    (row,) = process("three.itti", tmp_path, imprints.parent, planned, settings(), 0)
    assert row["value"] is None and row["note"] == planned["three.itti"]


@pytest.mark.slow
def test_stage_agrees_with_evaluate_and_writes_equal_bytes(imprints, tmp_path, bumps):
    chosen = settings(classifiers=["knn", "naive_bayes"], repetitions=2)
    planned = plan(chosen.sets, imprints)
    rows = process("three.random", tmp_path / "a", imprints.parent, planned, chosen, 7)
    process("three.random", tmp_path / "b", imprints.parent, planned, chosen, 7)
    assert (tmp_path / "a/three.random.npz").read_bytes() == (tmp_path / "b/three.random.npz").read_bytes()
    images = {name: stack[:12].astype("f4") for name, stack in bumps(NAMES, 16, jitter=2.0).items()}
    expected = [row["value"] for name in chosen.classifiers for row in evaluate(images, name, 2, seed=7)]
    wanted = ("plain", "training", "accuracy")
    plain = [row for row in rows if (row["variant"], row.get("scaling"), row["metric"]) == wanted]
    assert [row["value"] for row in plain if row.get("split") in ("random", "folds")] == expected
    stored = read_arrays(tmp_path / "a/three.random.npz")
    assert stored["objects"].tolist() == list(NAMES) and stored["knn.confusion"].sum() == 2 * 9
    shares = [row for row in rows if row["metric"] == "similar_share" and row["variant"] == "plain"]
    assert [row["item"] for row in shares] == [None, *NAMES]
    assert shares[0]["value"] == pytest.approx(np.mean([row["value"] for row in shares[1:]]))


@pytest.mark.slow
def test_a_failing_classifier_does_not_lose_the_others(imprints, tmp_path, monkeypatch):
    monkeypatch.setitem(CLASSIFIERS, "broken", lambda seed: 1 / 0)
    chosen = settings(classifiers=["broken", "knn"])
    rows = process("three.itti", tmp_path, imprints.parent, plan(chosen.sets, imprints), chosen, 0)
    assert rows[0]["value"] is None and "broken failed: division by zero" in rows[0]["note"]
    assert len([row for row in rows if row["classifier"] == "knn" and row["value"] is not None]) >= 2
    assert list(read_arrays(tmp_path / "three.itti.npz")) == ["objects", "knn.confusion"]


def test_summary_holds_mean_and_interval_of_the_repetitions():
    common = {"group": "three", "method": "itti", "classifier": "knn", "variant": "plain"}
    common |= {"split": "random", "metric": "accuracy", "scaling": "training"}
    other = [{**common, "value": 0.0, "scaling": "min_max"}, {**common, "value": 0.0, "metric": "commonest_share"}]
    assert summary(other, seed=0) == {}
    tree = summary([{**common, "value": value} for value in (0.5, 0.7, None)], seed=0)
    assert tree["three"]["itti"]["knn"]["accuracy_holdout"] == {"mean": 0.6, "low": -0.316817, "high": 1.516817}
    variants = [{**common, "value": 0.9, "variant": name} for name in ("locations", "touches_2")]
    further = summary(variants, seed=0, closest=("itti", "knn"))
    assert further == {"variants": {"three": {v["variant"]: {"accuracy_holdout": {"mean": 0.9}} for v in variants}}}
    assert summary(variants, seed=0, closest=("random", "knn")) == {}
    alone = summary([{**common, "value": 0.5}], seed=0)
    assert alone["three"]["itti"]["knn"]["accuracy_holdout"] == {"mean": 0.5}


def test_a_row_of_drawn_sets_is_the_mean_over_its_repetitions():
    common = {"group": "three", "set": 1, "item": None, "seconds": 3.0, "note": None}
    rows = [
        {**common, "classifier": name, "repetition": number, "value": value}
        for name, values in (("knn", (0.5, 0.75)), ("svm", (0.25, 0.25)))
        for number, value in enumerate(values)
    ]
    failed = {**common, "classifier": "deep_learning", "value": None, "note": "failed"}
    assert over_repetitions([*rows, failed]) == [
        {"group": "three", "set": 1, "item": None, "note": None, "classifier": "knn", "value": 0.625},
        {"group": "three", "set": 1, "item": None, "note": None, "classifier": "svm", "value": 0.25},
        {"group": "three", "set": 1, "item": None, "note": "failed", "classifier": "deep_learning", "value": None},
    ]  # fmt: skip


@pytest.mark.slow
def test_several_touches_are_of_the_first_set_and_the_closer_samplings_alone(imprints, tmp_path):
    chosen = settings(sets={"three": list(NAMES), "two": ["hand", "cup"]}, closer=["random"])
    planned = plan(chosen.sets, imprints)
    variants = {
        item: {row["variant"] for row in process(item, tmp_path, imprints.parent, planned, chosen, 0)}
        for item in ("three.random", "three.itti", "two.random")
    }
    assert {"touches_2_mixed", "selected"} <= variants["three.random"]
    assert "selected" in variants["two.random"] and "touches_2" not in variants["two.random"]
    assert variants["three.itti"] == {"plain", "first_15", "first_15_locations", "locations"}


@pytest.mark.slow
@pytest.mark.parametrize("drawn", [0, 2])
def test_the_stage_writes_rows_by_split_and_metrics_by_their_names_and_drawn_sets(imprints, make_workspace, drawn):
    workspace = make_workspace({"classification": vars(settings(closer=["random"], drawn=drawn, repetitions=2))})
    run(workspace)
    rows = read_rows(workspace.measurements / "classification.csv.gz")
    assert set(rows["repetition"].dropna()) == (set() if drawn else {0, 1})
    assert ("first_15_locations" in set(rows["variant"])) == (not drawn)
    assert set(rows["split"].dropna()) == {"random", "folds", "regions", "random_fewer"}
    assert set(rows["group"]) == {"three"} and set(rows["item"].dropna()) == set(NAMES)
    metrics = read_json(workspace.metrics / "classification.json")
    names = {f"accuracy_{split}" for split in ("holdout", "fivefold", "apart", "fewer")}
    assert set(metrics) == {"three", "variants"} and set(metrics["three"]["random"]["knn"]) == names
    assert set(metrics["variants"]["three"]["locations"]) == {"accuracy_holdout", "accuracy_side"}
    if drawn:  # they take the place of the named one, each with all its variants, not the first alone
        several = rows[rows["variant"].eq("touches_2") & rows["method"].eq("random")]
        assert set(rows["set"]) == set(several["set"]) == {1, 2}
    else:
        files = {path.name for path in (workspace.data / "classification").iterdir()}
        assert files == {"three.itti.npz", "three.random.npz"}

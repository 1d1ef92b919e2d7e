"""The smallest pressure array: where it touches, known winners, folds by object, and clear errors."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import trimesh
from sklearn.exceptions import ConvergenceWarning

from haptic_glance.base.files import write_arrays, write_mesh, write_table
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.sensor_size import __main__ as stage
from stages.sensor_size.__main__ import summary
from stages.sensor_size.protocol import (
    CLASSIFIERS,
    EXTENTS,
    choice_repeatability,
    classifier,
    disc,
    drawn_sets,
    evaluate,
    majority,
    salient_region,
    sample_vertices,
    smallest_sufficient,
)

SOLID = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
BALL = Mesh(SOLID.vertices, SOLID.faces)
HEIGHT = BALL.vertices[:, 2]
SALIENCY = np.abs(HEIGHT) / 0.5  # 1 at both poles, 0 at the equator
TOP, BOTTOM = int(HEIGHT.argmax()), int(HEIGHT.argmin())


def test_a_region_is_connected_and_above_the_share():
    region = salient_region(BALL, SALIENCY, TOP)
    assert TOP in region and (HEIGHT[region] >= 0.4 - 1e-9).all()
    assert set(region) == set(np.flatnonzero(HEIGHT >= 0.4 - 1e-9))


def test_a_disc_has_the_area_of_the_region():
    region = salient_region(BALL, SALIENCY, TOP)
    area = BALL.vertex_areas[region].sum()
    vertices = disc(BALL, BOTTOM, area)
    assert BALL.vertex_areas[vertices].sum() == pytest.approx(area, rel=0.02) and HEIGHT[vertices].max() < -0.35


def test_a_region_of_one_vertex_takes_its_neighbours():
    lonely = np.zeros(len(HEIGHT))
    lonely[TOP] = 1
    vertices = salient_region(BALL, lonely, TOP)
    assert len(vertices) == 5 and TOP in vertices and (HEIGHT[vertices] > 0.45).all()


@pytest.mark.parametrize("extent", EXTENTS)
def test_every_extent_touches_as_often_and_begins_with_the_strongest_points(extent):
    points = np.r_[TOP, BOTTOM, np.random.default_rng(0).permutation(len(HEIGHT))[:9]]
    vertices = sample_vertices(BALL, SALIENCY, points, extent, np.random.default_rng(1))
    assert vertices.shape == (10,) and len(set(vertices)) == 10
    assert vertices[[0, 5]].tolist() == [TOP, BOTTOM]


def touches(level, seed, count=12, noise=0.05):
    """Imprints whose left half has one level: a class that anybody can tell."""
    images = np.random.default_rng(seed).normal(0.5, noise, (count, 8, 8))
    images[:, :, :4] += level
    return images


def unseen(imprints, name):
    """The rows of objects that were never touched in training."""
    return [row for row in evaluate(imprints, [name]) if row["split"] == "objects"]


@pytest.fixture(scope="module")
def plain():
    return {label: [touches(level, 10 * i + seed) for seed in range(3)]
            for i, (label, level) in enumerate((("low", -1.0), ("even", 0.0), ("high", 1.0)))}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", CLASSIFIERS)
def test_every_classifier_tells_plain_classes_of_unseen_objects(plain, name):
    rows = unseen(plain, name)
    assert len(rows) == 9 and np.mean([row["value"] for row in rows]) > 0.95


def test_the_tested_object_is_trained_on_in_the_random_split_alone():
    """Each object has its own level: who learned it would name it, who did not takes the nearest other class."""
    levels = {"a": (0.0, 10.0), "b": (1.0, 11.0)}
    objects = {label: [touches(level, i, noise=0.01) for i, level in enumerate(pair)] for label, pair in levels.items()}
    rows = evaluate(objects, ["knn"])
    scores = {(row["group"], row["fold"]): row["value"] for row in rows if row["split"] == "objects"}
    assert set(scores.values()) <= {0.0, 1.0} and np.mean(list(scores.values())) == 0.5
    assert [(row["group"], row["item"], row["value"]) for row in rows if row["split"] == "random"] == [
        ("a", 0, 1.0), ("a", 1, 1.0), ("b", 0, 1.0), ("b", 1, 1.0)
    ]  # fmt: skip


def test_a_class_with_fewer_objects_sits_out_the_later_folds_and_the_order_of_classes_does_not_matter(plain):
    uneven = plain | {"low": plain["low"][:2]}
    first, second = (
        {(row["group"], row["fold"]): row["value"] for row in unseen(order, "knn")}
        for order in (uneven, dict(reversed(uneven.items())))
    )
    assert first == second and len(first) == 8
    assert sorted(key for key in first if key[0] == "low") == [("low", 0), ("low", 1)]


def test_the_smallest_array_has_the_fewest_sensels_then_the_least_width():
    accuracy = {(16, 0.01): 0.80, (16, 0.002): 0.79, (32, 0.01): 0.81, (8, 0.01): 0.6}
    assert smallest_sufficient(accuracy, 0.02) == (16, 0.002)
    assert smallest_sufficient(accuracy, 0.01) == (16, 0.01)
    assert smallest_sufficient(accuracy, 0.0) == (32, 0.01)
    with pytest.raises(ValueError, match="slack"):
        smallest_sufficient(accuracy, -0.1)
    with pytest.raises(ValueError, match="at least one"):
        smallest_sufficient({}, 0.1)


def test_the_metrics_name_the_smallest_array():
    rows = [
        {"metric": "accuracy", "split": "objects", "classifier": "knn", "cells": cells, "pitch": 0.01, "value": value,
         "item": item}
        for cells, mean in ((8, 0.5), (16, 0.9), (32, 0.91))
        for item, value in (("a", mean - 0.07), ("a", mean - 0.03), ("b", mean + 0.05))
    ]  # fmt: skip
    metrics = summary(rows, 0.02, 0)["knn"]
    assert metrics["smallest"] == {"cells": 16, "pitch": 0.01, "accuracy": 0.9, "again": 1.0}
    assert metrics["arrays"]["8-0.01"]["low"] == pytest.approx(0.5 - 0.458408, abs=1e-5)


def test_the_choice_is_trusted_where_one_array_leads_and_not_where_all_are_alike():
    noise = np.random.default_rng(0)
    clear = {(8, 0.01): noise.normal(0.2, 0.05, 24), (16, 0.01): noise.normal(0.9, 0.05, 24)}
    assert choice_repeatability(clear, 0.02) == 1
    alike = {(cells, 0.01): noise.normal(0.3, 0.15, 24) for cells in (8, 16, 32, 64)}
    assert choice_repeatability(alike, 0.02) < 0.8


def test_loading_code_is_no_part_of_a_touchs_seconds(monkeypatch, tmp_path):
    calls = []
    monkeypatch.setattr(stage, "warm_up", lambda: calls.append("loaded"))
    monkeypatch.setattr(
        stage, "touch", lambda *_: calls.append("touched") or np.random.default_rng(0).random((9, 8, 8))
    )
    settings = SimpleNamespace(method="glance", touches=9, classifiers=["knn"], drawn=0)
    stage.process("8-0.01", tmp_path, tmp_path, {"a": ["a1", "a2"], "b": ["b1", "b2"]}, settings, 0)
    assert calls[0] == "loaded" and calls.count("touched") == 4


@pytest.mark.slow
def test_the_stage_tests_each_object_of_the_classes(make_workspace):
    settings = {"classes": [], "method": "salient", "touches": 12, "cells": [4], "pitches": [0.02], "slack": 0.02}
    settings |= {"pairs": ["4-0.02+3-0.01"], "extents": ["region"], "classifiers": ["knn"], "drawn": 0}
    workspace = make_workspace({"sensor_size": settings})
    sizes = {"cube": (0.5, 0.5, 0.5), "brick": (0.5, 0.4, 0.5), "stick": (0.1, 0.1, 0.6), "pole": (0.12, 0.1, 0.6)}
    for name, size in sizes.items():
        box = trimesh.creation.box(size).subdivide().subdivide()
        write_mesh(workspace.data / f"meshes/{name}.npz", Mesh(box.vertices, box.faces))
        points = {"salient.points": np.arange(0, 90, 3), "salient.strong": np.int64(30)}
        points["salient.saliency"] = np.ones(len(box.vertices))
        write_arrays(workspace.data / f"salient_points/{name}.npz", **points)
    table = pd.DataFrame({"class": ["box", "box", "rod", "rod"], "object": list(sizes)})
    write_table(workspace.data / "meshes/classes.csv", table)
    stage.run(workspace)
    rows = read_rows(workspace.measurements / "sensor_size.csv.gz")
    tested = rows[rows["split"] == "objects"]
    assert dict(zip(tested["item"], tested["group"], strict=True)) == dict(
        zip(table["object"], table["class"], strict=True)
    )
    assert (rows["metric"] == "smallest_chosen_again").sum() == 1 and len(rows) == 3 * (4 + 4 + 4) + 1
    assert (rows["fine"] == "3-0.01").sum() == (rows["extent"] == "region").sum() == 12
    assert rows.loc[rows["metric"] == "seconds_a_touch", "item"].tolist() == 3 * list(sizes)


CLASSES = {label: [f"{label}{k}" for k in range(6)] for label in "edcba"}


def test_a_drawn_set_has_the_size_of_the_thesis_and_an_object_comes_back_once_the_others_were_in_a_set():
    sets = drawn_sets(CLASSES, 4, 0)
    assert all(len(members) == 4 and all(len(names) == 3 for names in members.values()) for members in sets)
    assert all(set(names) < set(CLASSES[label]) for members in sets for label, names in members.items())
    first, second, *_ = [sorted(name for names in members.values() for name in names) for members in sets]
    assert {*sets[0], *sets[1]} == set(CLASSES)
    assert not set(first) & set(second) and sets == drawn_sets(CLASSES, 4, 0) != drawn_sets(CLASSES, 4, 1)
    assert drawn_sets(CLASSES, 0, 0) == [] == drawn_sets({}, 0, 0)
    with pytest.raises(ValueError, match=r"sensor_size\.drawn: .* there are 3"):
        drawn_sets({label: CLASSES[label] for label in "abc"} | {"few": ["f0", "f1"]}, 1, 0)


def test_drawn_sets_know_their_own_classes_alone(monkeypatch, tmp_path):
    """Each class has one level, so every answer is right."""
    levels = {name: float(5 * "abcde".index(name[0])) for names in CLASSES.values() for name in names}
    monkeypatch.setattr(stage, "touch", lambda name, *_: touches(levels[name], 0, noise=0.01))
    settings = SimpleNamespace(method="glance", touches=12, classifiers=["knn"], drawn=3)
    rows = pd.DataFrame(stage.process("8-0.01", tmp_path, tmp_path, CLASSES, settings, 0))
    tested = rows[rows["split"] == "objects"]
    members = dict(enumerate(drawn_sets(CLASSES, 3, 0), 1))
    assert {number: part.groupby("group")["item"].agg(sorted).to_dict() for number, part in tested.groupby("set")} == {
        number: {label: sorted(names) for label, names in groups.items()} for number, groups in members.items()
    }
    assert (tested["value"] == 1).all() and len(tested) == 3 * 12
    assert rows["metric"].eq("seconds_a_touch").sum() == 30


def test_the_svm_stops_where_its_steps_run_in_a_circle(monkeypatch):
    monkeypatch.setattr("stages.sensor_size.protocol.ITERATIONS", 3)
    random = np.random.default_rng(0)
    with pytest.warns(ConvergenceWarning):
        model = classifier("svm").fit(random.normal(size=(60, 4)), random.integers(3, size=60))
    assert model.n_iter_.max() == 3


def test_most_answers_of_a_sample_count_and_of_equals_the_first():
    answers = np.array(["b", "a", "a", "c", "b", "a"])
    assert majority(answers, 3).tolist() == ["a", "c"] and majority(answers, 1).tolist() == answers.tolist()


def test_touches_of_one_sample_are_held_out_together():
    """Each sample of three touches has a mark of its own: known ones are told, so none may be on both sides."""
    random = np.random.default_rng(0)
    marks = np.repeat(20 * random.normal(size=(4, 8, 30)), 3, axis=1)
    imprints = {label: [marks[k], marks[k + 1]] for k, label in ((0, "a"), (2, "b"))}
    rows = [row for row in evaluate(imprints, ["knn"], votes=3) if row["split"] == "random"]
    assert len(rows) == 4 and all(row["value"] * 2 == int(row["value"] * 2) for row in rows)
    assert np.mean([row["value"] for row in rows]) < 1

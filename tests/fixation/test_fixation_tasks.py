"""Classes of objects: clusters, their number, and what the table of meanings says."""

from pathlib import Path

import numpy as np
import pytest

from stages.fixation.tasks import (
    SEMANTICS,
    assign_classes,
    cluster_objects,
    elbow,
    object_folds,
    random_views,
    semantic_classes,
)

TABLE = Path(__file__).parents[2] / SEMANTICS


@pytest.fixture
def groups():
    """(60, 1) values in three groups, and their order."""
    draw = np.random.default_rng(0)
    return np.concatenate([middle + 0.01 * draw.normal(size=20) for middle in (0.5, 0.9, 0.1)])[:, None]


def test_three_groups_give_three_clusters_numbered_by_value(groups):
    labels, curve = cluster_objects(groups)
    assert list(curve) == list(range(2, 11))
    assert labels.tolist() == [1] * 20 + [2] * 20 + [0] * 20
    assert (np.diff([*curve.values()]) <= 0).all()


def test_the_elbow_is_where_the_curve_bends():
    assert elbow({2: 100, 3: 10, 4: 9, 5: 8, 6: 7}) == 3
    assert elbow({2: 100, 3: 60, 4: 5, 5: 4, 6: 3}) == 4
    assert elbow({2: 1, 3: 0}) == elbow({2: 0, 3: 0, 4: 0}) == 2


@pytest.mark.parametrize("values", [[[0.5]] * 5, [[1.0]], [[0.1], [0.9]]])
def test_what_cannot_be_parted_is_one_class(values):
    labels, curve = cluster_objects(values)
    assert set(labels) == {0} and curve == {}


def test_the_tracked_table_knows_every_object_of_both_collections():
    for dataset, count in (("household", 50), ("gaze", 19)):
        table = [line.split(",") for line in TABLE.read_text().splitlines()[1:]]
        names = [row[1] for row in table if row[0] == dataset]
        assert len(names) == len(set(names)) == count
        known = semantic_classes(dataset, names, TABLE)
        assert set(known["level_1"]) == {"yes", "no"} and None not in known["level_2"]
        living = dict(zip(known["level_2"], known["level_1"], strict=True))
        assert all(living[c] == alive for c, alive in zip(known["level_2"], known["level_1"], strict=True))


def test_a_damaged_table_is_named(tmp_path):
    path = tmp_path / "semantics.csv"
    path.write_text("object,living\ncup,no\n")
    with pytest.raises(ValueError, match="must have the columns"):
        semantic_classes("household", ["cup"], path)
    path.write_text("dataset,object,living,category\nh,cup,no,dishes\nh,cup,yes,dishes\n")
    with pytest.raises(ValueError, match="cup appears twice"):
        semantic_classes("h", ["cup"], path)


def test_unknown_objects_and_tasks_of_one_class_are_left_out_with_a_word(capsys):
    measures = {
        name: {"convexity": value, "eccentricity": 0.5, "positive": value, "negative": 0.0, "zero": 1 - value}
        for name, value in (("cup", 0.1), ("mug", 0.12), ("apple", 0.9), ("thing", 0.95))
    }
    tasks, curves = assign_classes(measures, "household", 0, TABLE)
    assert "eccentricity" not in tasks and "eccentricity" not in curves
    assert set(tasks["level_1"]) == {"cup", "mug", "apple"} and set(tasks["level_3"]) == set(measures)
    message = capsys.readouterr().err
    assert "thing" in message and "task eccentricity is left out" in message


def test_views_are_split_60_20_20():
    parts = random_views(200, np.random.default_rng(0))
    assert [len(part) for part in parts] == [120, 40, 40]
    assert sorted(np.concatenate(parts)) == list(range(200))


def test_held_out_objects_leave_one_of_their_class():
    labels = np.array(["a"] * 7 + ["b"] * 2 + ["c"])
    fold = object_folds(labels, 3, np.random.default_rng(0))
    assert fold[-1] == -1 and (fold[:-1] >= 0).all()
    for number in range(3):
        assert set(labels[fold == number]) <= set(labels[fold != number])

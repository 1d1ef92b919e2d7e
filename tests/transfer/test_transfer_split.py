"""The splits of touches, and their choice."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from stages.transfer.plan import by_objects, by_touches, stratified_split
from stages.transfer.touches import choose_vertices

LABELS = np.repeat([0, 1, 2], [40, 20, 8])
CLASSES = np.repeat([0, 1], [30, 40])  # of three and four objects of ten touches
RANKS = np.r_[np.repeat([0, 1, 2], 10), np.repeat([0, 1, 2, 3], 10)]


def rng():
    return np.random.default_rng(3)


def test_parts_are_disjoint_and_hold_all():
    first, second = stratified_split(LABELS, 0.75, rng())
    assert not set(first) & set(second)
    assert sorted([*first, *second]) == list(range(len(LABELS)))


def test_every_class_is_split_by_the_share():
    first, second = stratified_split(LABELS, 0.75, rng())
    assert np.bincount(LABELS[first]).tolist() == [30, 15, 6]
    assert np.bincount(LABELS[second]).tolist() == [10, 5, 2]


def test_random_numbers_decide_which_touches():
    first, again = stratified_split(LABELS, 0.5, rng())[0], stratified_split(LABELS, 0.5, rng())[0]
    other = stratified_split(LABELS, 0.5, np.random.default_rng(4))[0]
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_small_classes_lie_on_both_sides():
    first, second = stratified_split(np.array([0, 0, 1, 1]), 0.99, rng())
    assert len(first) == len(second) == 2


@pytest.mark.parametrize(
    ("labels", "share", "reason"),
    [([0, 0, 1], 0.5, "one touch alone"), ([0, 0], 1.0, "between 0 and 1"), ([0.5, 0.5], 0.5, "integers")],
)
def test_what_cannot_be_split_is_refused(labels, share, reason):
    with pytest.raises(ValueError, match=reason):
        stratified_split(labels, share, rng())


def whole(split):
    """True when train and test are disjoint and hold all, and check lies within train."""
    touches = sorted([*split.train, *split.test]) == list(range(len(CLASSES)))
    return (
        touches
        and set(split.validation) < set(split.train)
        and sorted([*split.fit, *split.validation]) == list(split.train)
    )


def test_touches_of_every_object_lie_on_both_sides():
    split = by_touches(CLASSES * 4 + RANKS, 0.8, 0.25, rng())
    assert whole(split)
    for part, count in ((split.train, 8), (split.test, 2), (split.validation, 2)):
        assert set(np.bincount((CLASSES * 4 + RANKS)[part])) <= {0, count}


@pytest.mark.parametrize("number", range(5))
def test_an_object_left_out_is_in_no_other_part(number):
    split = by_objects(CLASSES, RANKS, number, 0.2, rng())
    assert whole(split)
    for label, count in enumerate((3, 4)):
        parts = [set(RANKS[part[CLASSES[part] == label]]) for part in (split.test, split.validation, split.fit)]
        assert parts[0] == {number % count} and parts[1] == {(number + 1) % count}
        assert not parts[2] & (parts[0] | parts[1]) and len(parts[2]) == count - 2


def test_every_object_is_left_out_in_turn():
    tests = [set(by_objects(CLASSES, RANKS, number, 0.2, rng()).test) for number in range(4)]
    assert set.union(*tests) == set(range(len(CLASSES)))


def test_of_two_objects_the_check_is_a_share_of_the_touches_that_train():
    two = RANKS < 2
    labels, ranks = CLASSES[two], RANKS[two]
    split = by_objects(labels, ranks, 1, 0.2, rng())
    assert set(ranks[split.test]) == {1} and set(ranks[split.train]) == {0}
    assert np.bincount(labels[split.validation]).tolist() == [2, 2]


def test_a_class_with_one_object_cannot_be_left_out():
    with pytest.raises(ValueError, match="class 1 has one object alone"):
        by_objects(np.array([0, 0, 1]), np.array([0, 1, 0]), 0, 0.2, rng())


def grid(n=6):
    """A flat n x n grid of vertices."""
    x, y = np.meshgrid(np.arange(n) / n, np.arange(n) / n, indexing="ij")
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.r_[np.c_[corner, corner + n, corner + n + 1], np.c_[corner, corner + n + 1, corner + 1]]
    return Mesh(np.c_[x.ravel(), y.ravel(), np.zeros(n * n)], faces)


def test_salient_points_come_first_and_blind_ones_fill_up():
    chosen = choose_vertices(grid(), np.array([7, 3]), 20, rng())
    assert chosen[:2].tolist() == [7, 3]
    assert len(set(chosen.tolist())) == 20


def test_more_touches_than_vertices_are_refused():
    with pytest.raises(ValueError, match="only 36 vertices"):
        choose_vertices(grid(), np.array([7, 3]), 37, rng())

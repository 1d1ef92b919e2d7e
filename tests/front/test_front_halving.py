"""Which choices go on: no dominated one before one that nothing dominates, and the quickest good one of all."""

import numpy as np
import pytest

from stages.front.search import DIRECTIONS, aims, best_share, crowding, losses, ranks, smallest_of


def rows(regions, objects, seconds=1.0, faces=100.0, touches=1):
    common = {"seconds": seconds, "faces": faces, "touches": touches}
    return [{"split": "regions", "value": regions, **common}, {"split": "objects", "value": objects, **common}]


def dominates(one, other):
    return bool((one <= other).all() and (one < other).any())


def test_a_dominated_choice_is_never_on_the_front():
    points = np.random.default_rng(0).integers(0, 4, size=(80, 3))  # with many ties
    front = ranks(points) == 0
    beaten = np.array([any(dominates(other, one) for other in points) for one in points])
    assert (front == ~beaten).all() and 0 < front.sum() < 80


def test_each_rank_is_dominated_by_the_one_before_alone():
    points = np.random.default_rng(1).random((40, 2))
    found = ranks(points)
    for rank in range(1, found.max() + 1):
        assert all(any(dominates(one, other) for one in points[found == rank - 1]) for other in points[found == rank])


def test_the_ends_of_an_aim_stand_apart_and_a_crowd_does_not():
    apart = crowding([[0, 4], [1, 3], [1.1, 2.9], [4, 0]])
    assert np.isinf(apart[[0, 3]]).all() and apart[1] == pytest.approx(1.1 / 4 + 1.1 / 4)
    assert (crowding(np.ones((3, 2))) == 0).all()


def test_a_third_goes_on_the_better_rank_first():
    front = [[0, 2], [2, 0]]
    assert best_share([[3, 3], *front, [4, 4], [5, 5], [2.5, 2.5]]).tolist() == [1, 2]
    assert best_share([[1, 1]]).tolist() == [0]


def test_a_crowded_choice_of_the_front_goes_before_a_lonely_one_behind_it():
    front, behind = [[0, 4], [2, 2], [4, 0]], [[1, 9], [9, 1]]
    assert best_share([*behind, *front, [10, 10], [11, 11], [12, 12], [13, 13]]).tolist() == [2, 3, 4]


def test_aims_are_means_over_the_objects_and_what_could_not_be_asked_is_no_good():
    found = [*rows(0.5, 0.25), *rows(0.7, None, seconds=None)]
    assert aims(found) == pytest.approx([0.6, 0.25, 1.0, 100.0, 1.0])
    assert aims(rows(None, 0.5))[0] == 0
    assert losses([rows(0.5, 0.25)]).tolist() == [[-0.5, -0.25, 1, 100, 1]] and len(DIRECTIONS) == 5


def test_the_smallest_is_the_quickest_within_two_points_of_the_best():
    found = {"best": rows(0.8, 0.6, seconds=9), "near": rows(0.79, 0.58, seconds=2), "slow": rows(0.8, 0.59, seconds=3)}
    found |= {"far": rows(0.7, 0.6, seconds=1)}
    assert smallest_of(found) == "near"
    assert smallest_of({"b": rows(0.5, 0.5, faces=9), "a": rows(0.5, 0.5, faces=10)}) == "b"

"""Pairs of points are distinct, drawn from all pairs alike, and the same for the same seed."""

import numpy as np
import pytest

from haptic_glance.base.rng import rng
from stages.contours.contours import draw_pairs


def as_sets(pairs):
    return {frozenset(pair) for pair in pairs.tolist()}


def test_all_pairs_come_once_where_there_are_no_more():
    points = np.array([7, 3, 11, 40, 5])
    pairs = draw_pairs(points, 100, rng(0, "a"))
    assert pairs.shape == (10, 2) and len(as_sets(pairs)) == 10
    assert {one for pair in pairs.tolist() for one in pair} == set(points.tolist())


@pytest.mark.slow
@pytest.mark.parametrize("size", [60, 30_000, 300_000])
def test_pairs_are_distinct_and_of_the_points(size):
    pairs = draw_pairs(np.arange(size), 1500, rng(0, "b"))
    assert len(as_sets(pairs)) == 1500 and (pairs[:, 0] != pairs[:, 1]).all()
    assert pairs.min() >= 0 and pairs.max() < size


def test_every_pair_and_both_orders_are_as_likely():
    counts = np.zeros((4, 4))
    for turn in range(3000):
        first, second = draw_pairs(np.arange(4), 1, rng(turn, "c"))[0]
        counts[first, second] += 1
    off = counts[~np.eye(4, dtype=bool)]
    assert off.min() > 180 and off.max() < 320  # 250 each, five standard deviations


def test_a_longer_draw_of_everything_has_the_same_pairs():
    assert as_sets(draw_pairs(np.arange(9), 36, rng(1, "d"))) == as_sets(draw_pairs(np.arange(9), 99, rng(2, "d")))


@pytest.mark.parametrize("points", [[], [3], [3, 3]])
def test_less_than_two_points_make_no_pair(points):
    assert draw_pairs(np.array(points, dtype=np.int64), 5, rng(0, "e")).shape == (0, 2)

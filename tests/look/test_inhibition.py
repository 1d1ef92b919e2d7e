"""Points in the order of visits: spaced, by value, on peaks rather than on rims."""

import numpy as np
import pytest

from haptic_glance.look.points.options import visited

GRID = np.stack([*np.meshgrid(np.arange(60.0), np.arange(40.0), indexing="ij"), np.zeros((60, 40))], axis=2)
PLACES = GRID.reshape(-1, 3)


def hills(*peaks):
    """Values at PLACES: the sum of (x, y, height, width)."""
    return sum(h * np.exp(-((PLACES - [x, y, 0]) ** 2).sum(axis=1) / (2 * w * w)) for x, y, h, w in peaks)


def test_hills_are_visited_from_the_highest_to_the_lowest():
    found = visited(PLACES, hills((10, 10, 1, 3), (40, 20, 2, 3), (20, 30, 1.5, 3)), 8, count=3)
    assert PLACES[found, :2].tolist() == [[40, 20], [20, 30], [10, 10]]


def test_points_are_farther_apart_than_the_radius():
    found = PLACES[visited(PLACES, hills((30, 20, 1, 15)), 6, count=20)]
    apart = np.linalg.norm(found[:, None] - found, axis=2)[np.triu_indices(20, 1)]
    assert len(found) == 20 and apart.min() > 6


def test_a_lower_hill_comes_before_the_slope_of_a_higher_one():
    """A disc cut out of the broad hill leaves a rim that is higher than the small hill's top."""
    broad, small = (20, 20, 1.0, 7.0), (48, 20, 0.75, 2.0)
    values = hills(broad, small)
    rim = np.linalg.norm(PLACES[:, :2] - [20, 20], axis=1) > 5
    assert values[rim & (PLACES[:, 0] < 35)].max() > 0.75
    assert PLACES[visited(PLACES, values, 5, count=2)[1], 0] == pytest.approx(48, abs=1)


def test_nothing_to_visit_gives_no_point():
    assert len(visited(PLACES, np.zeros(len(PLACES)), 5, count=3)) == 0
    assert len(visited(PLACES[:0], np.zeros(0), 5, count=3)) == 0
    assert len(visited(PLACES[:4], np.ones(4), 100, count=3)) == 1  # no room for a second

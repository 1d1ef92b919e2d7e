"""Repeatability, drift and breaking point, on sets and maps with a known answer."""

import numpy as np
import pandas as pd
import pytest

from haptic_glance.disturb.perturbed import Perturbed
from haptic_glance.look.weights.svm import select_far_points
from haptic_glance.mesh.mesh import Mesh
from stages.engine.statistics import breaking_point
from stages.stability.breaking import breaking_points, middle_severity, summarise
from stages.stability.repeatability import at_original_vertices, chance_repeatability, drift, repeatability

GRID = np.stack([*np.mgrid[:4, :5].reshape(2, -1), np.zeros(20)], axis=1).astype(float)


def test_repeatability_is_symmetric_and_counts_points_within_reach():
    half = np.r_[GRID[:10] + [0, 0, 0.09], GRID[10:] + [0, 0, 0.11]]
    assert repeatability(GRID, half, 0.1) == repeatability(half, GRID, 0.1) == 0.5
    assert repeatability(GRID, GRID[::-1], 0.1) == 1


def test_many_points_everywhere_do_not_pay():
    crowd = np.random.default_rng(0).uniform([0, 0, 0], [3, 4, 0], (20000, 3))
    assert repeatability(GRID, crowd, 0.1) < 0.1


def test_repeatability_without_points_is_zero_or_unknown():
    assert repeatability(GRID, np.zeros((0, 3)), 0.1) == repeatability([], GRID, 0.1) == 0
    assert np.isnan(repeatability([], [], 0.1))
    with pytest.raises(ValueError, match="tolerance"):
        repeatability(GRID, GRID, -0.1)


def test_chance_is_the_covered_share_of_the_area(ball):
    """On a ball of area pi a disc of radius r covers the share r^2; the discs of far points are disjoint."""
    tolerance, few, many = 0.1, 10, 40
    spots = ball.vertices[select_far_points(ball.vertices, few)]
    chance = chance_repeatability(spots, Perturbed(ball, ball.vertices), many, np.random.default_rng(1), tolerance)
    expected = (few * (1 - (1 - tolerance**2) ** many) + many * few * tolerance**2) / (few + many)
    assert chance == pytest.approx(expected, abs=0.03)


def test_drift_is_zero_for_the_same_map_at_another_scale_and_two_for_its_negative(ball):
    values, areas = ball.vertices[:, 2], ball.vertex_areas
    assert drift(values, 3 * values + 1, areas) == pytest.approx(0, abs=1e-12)
    assert drift(values, -values, areas) == pytest.approx(2)
    assert drift(values, ball.vertices[:, 0], areas) == pytest.approx(1, abs=1e-3)


def test_drift_beside_a_constant_map():
    areas, flat, slope = np.ones(20), np.full(20, 0.3), np.arange(20.0)
    assert drift(flat, np.zeros(20), areas) == 0
    assert drift(flat, slope, areas) == drift(slope, flat, areas) == 1


def test_drift_weighs_by_area():
    before, after = np.array([0.0, 1, 0, 1]), np.array([0.0, 1, 1, 0])
    assert drift(before, after, np.array([1, 1, 1e-6, 1e-6])) == pytest.approx(0, abs=1e-5)
    assert drift(before, after, np.ones(4)) == pytest.approx(1)


def test_a_map_comes_back_by_place_and_never_from_a_vertex_in_no_face(ball):
    order = np.random.default_rng(2).permutation(len(ball.vertices))
    stray = np.r_[ball.vertices[order], ball.vertices[:1]]
    shuffled = Perturbed(Mesh(stray, np.argsort(order)[ball.faces]), stray)
    values = np.r_[ball.vertices[order, 2], 99.0]
    assert np.allclose(at_original_vertices(ball, shuffled, values), ball.vertices[:, 2])


@pytest.mark.parametrize(
    ("severities", "values", "unharmed", "expected"),
    [
        ([1, 2, 4], [0.9, 0.7, 0.3], 0, 3),
        ([1, 2, 4], [0.0, 0.0, 0.0], 0, 0.5),
        ([0.5, 0.25], [0.75, 0.25], 1, 0.375),  # harsher is less
        ([1, 2, 4], [0.4, 0.9, 0.9], 0, 5 / 6),  # the first fall counts
        ([1, 2], [0.8, 0.5], 0, np.nan),
        ([1], [np.nan], 0, np.nan),
    ],
)
def test_breaking_point_is_interpolated(severities, values, unharmed, expected):
    assert breaking_point(severities, values, unharmed) == pytest.approx(expected, nan_ok=True)


def rows_of(perturbation, table):
    """Rows of two objects about the given means."""
    return [
        {"item": name, "method": method, "perturbation": perturbation, "severity": severity,
         "metric": "repeatability", "value": value + shift, "seconds": 1.0}
        for method, values in table.items()
        for severity, value in values
        for name, shift in (("a", 0.1), ("b", -0.1))
    ]  # fmt: skip


def test_summary_takes_means_over_objects_at_the_middle_and_says_what_never_broke():
    rows = rows_of("tilt", {"itti": [(15, 0.8), (45, 0.6), (90, 0.2)], "harris": [(15, 0.9), (45, 0.9), (90, 0.9)]})
    rows.append(rows[0] | {"item": "c", "value": None})  # left out of the mean
    summary = summarise(rows)
    assert summary["repeatability"] == {"tilt.itti": 0.6, "tilt.harris": 0.9}
    assert summary["breaking_point"] == {"tilt.itti": 56.25, "tilt.harris": None}
    assert breaking_points(pd.DataFrame(rows))["tilt", "itti"][0] == 56.25
    assert [middle_severity(list(range(k))) for k in (1, 2, 3, 4)] == [0, 0, 1, 1]

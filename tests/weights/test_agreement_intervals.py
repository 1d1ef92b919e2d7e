"""Bootstrap intervals over meshes: coverage, pairing, repeatability."""

import numpy as np
import pytest
from scipy import stats

from stages.weights.agreement import mean_interval, paired


def test_intervals_hold_the_truth_as_often_as_they_say():
    draw = np.random.default_rng(0)
    held = [low <= 3 <= high for _, low, high in (mean_interval(draw.normal(3, 1, 19)) for _ in range(400))]
    assert 0.92 < np.mean(held) < 0.98


def test_interval_of_many_values_is_that_of_the_normal_law():
    values = np.random.default_rng(1).normal(0, 1, 200)
    mean, low, high = mean_interval(values)
    half = stats.t.ppf(0.975, 199) * values.std(ddof=1) / np.sqrt(200)
    assert mean == pytest.approx(values.mean())
    assert (low, high) == pytest.approx((mean - half, mean + half), abs=0.03 * half + 0.01)


def test_intervals_of_few_values_are_as_wide_as_those_of_student():
    draw, ratios = np.random.default_rng(6), []
    for _ in range(40):
        values = draw.normal(size=19)
        _, low, high = mean_interval(values)
        ratios.append((high - low) / (2 * stats.t.ppf(0.975, 18) * values.std(ddof=1) / np.sqrt(19)))
    assert np.mean(ratios) == pytest.approx(1, abs=0.012)


def test_pairing_takes_out_what_the_meshes_share():
    draw = np.random.default_rng(2)
    mesh = draw.normal(0, 5, 19)
    a, b = mesh + 0.5 + draw.normal(0, 0.3, 19), mesh + draw.normal(0, 0.3, 19)
    mean, low, high = paired(a, b)
    assert 0 < low < mean < high < 1
    assert mean_interval(a)[1] < mean_interval(b)[2]  # side by side the two overlap


def test_swapping_the_two_mirrors_the_interval():
    a, b = np.random.default_rng(3).random((2, 19))
    mean, low, high = paired(a, b)
    assert paired(a, b, seed=8) == mean_interval(a - b, seed=8)
    assert paired(b, a) == pytest.approx((-mean, -high, -low))


def test_a_method_does_not_differ_from_itself():
    values = np.random.default_rng(4).random(9)
    assert paired(values, values) == (0, 0, 0)


def test_intervals_repeat_with_the_seed_and_hardly_move_with_another():
    values = np.random.default_rng(5).random(19)
    np.random.seed(1)  # noqa: NPY002, the global state must not matter
    first = mean_interval(values, seed=7)
    assert first == mean_interval(values, seed=7)
    other = mean_interval(values, seed=8)
    assert other != first
    assert other == pytest.approx(first, abs=0.05 * (first[2] - first[1]))


def test_the_interval_of_two_meshes_spans_both():
    assert mean_interval([1.0, 2.0]) == (1.5, 1.0, 2.0)


def test_one_mesh_has_no_interval():
    mean, low, high = mean_interval([0.4])
    assert mean == 0.4 and np.isnan(low) and np.isnan(high)


@pytest.mark.parametrize(("values", "named"), [([], "above 0"), ([[1.0]], "shape"), ([1.0, np.nan, 2.0], r"\[1\]")])
def test_bad_values_are_named(values, named):
    with pytest.raises(ValueError, match=named):
        mean_interval(values)


def test_lists_of_different_meshes_are_refused():
    with pytest.raises(ValueError, match="same meshes"):
        paired([1.0, 2.0], [1.0])

"""The interval of a mean, and the share that repeated splits have in common."""

import numpy as np
import pytest
from scipy import stats

from haptic_glance.know.split import Split, shared_by
from stages.engine.statistics import breaking_interval, discoveries, interval, interval_metrics, p_value


@pytest.mark.slow
def test_interval_covers_as_often_as_it_says():
    rng = np.random.default_rng(0)
    for count in (4, 15, 19):
        found = [interval(rng.normal(3, 1, size=count)) for _ in range(400)]
        assert np.mean([low < 3 < high for _, low, high in found]) > 0.91


def test_interval_narrows_with_more_values():
    values = np.random.default_rng(0).normal(5, 1, size=400)
    (mean, low, high), wide = interval(values), interval(values[:25])
    assert low < 5 < high and mean == pytest.approx(values.mean())
    assert high - low < wide[2] - wide[1]


def test_few_values_get_a_wider_interval_than_the_plain_percentiles():
    values = np.random.default_rng(1).normal(size=6)
    picks = np.random.default_rng(0).integers(6, size=(2000, 6))
    plain = np.quantile(values[picks].mean(axis=1), [0.025, 0.975])
    mean, low, high = interval(values)
    stretch = 2.5706 / 1.9600 * np.sqrt(6 / 5)  # t with five degrees of freedom over z
    assert mean - low == pytest.approx(stretch * (mean - plain[0]), rel=1e-3)
    assert high - mean == pytest.approx(stretch * (plain[1] - mean), rel=1e-3)


def test_interval_of_many_values_is_that_of_the_normal_law():
    values = np.random.default_rng(1).normal(0, 1, 200)
    mean, low, high = interval(values)
    half = stats.t.ppf(0.975, 199) * values.std(ddof=1) / np.sqrt(200)
    assert (low, high) == pytest.approx((mean - half, mean + half), abs=0.03 * half + 0.01)


def test_intervals_of_few_values_are_as_wide_as_those_of_student():
    draw, ratios = np.random.default_rng(6), []
    for _ in range(40):
        values = draw.normal(size=19)
        _, low, high = interval(values)
        ratios.append((high - low) / (2 * stats.t.ppf(0.975, 18) * values.std(ddof=1) / np.sqrt(19)))
    assert np.mean(ratios) == pytest.approx(1, abs=0.012)


def test_swapping_the_two_mirrors_the_interval():
    a, b = np.random.default_rng(3).random((2, 19))
    mean, low, high = interval(a - b)
    assert interval(b - a) == pytest.approx((-mean, -high, -low))


def test_values_of_another_shape_are_refused():
    with pytest.raises(ValueError, match="shape"):
        interval([[1.0, 2.0]])


@pytest.mark.slow
def test_splitting_the_same_data_more_often_does_not_shrink_the_interval_to_nothing():
    values = np.random.default_rng(0).normal(size=4000)
    width = {n: np.subtract(*interval(values[:n], shared_by(Split.RANDOM))[:0:-1]) for n in (100, 4000)}
    assert width[4000] > 0.8 * width[100]
    independent = np.subtract(*interval(values)[:0:-1])
    assert independent < 0.1 * width[4000]


def test_one_value_has_no_interval_and_none_has_no_mean():
    mean, low, high = interval([0.5, np.nan])
    assert mean == 0.5
    assert np.isnan([low, high]).all()
    assert np.isnan(interval([])).all()


def test_equal_values_have_no_interval():
    mean, low, high = interval([0.066667, 0.066666, 0.066667])  # equal but for the six digits of the measurements
    assert mean == pytest.approx(0.0666667, abs=1e-6)
    assert np.isnan([low, high]).all()
    assert np.isfinite(interval([0.066, 0.067, 0.068])).all()


def test_interval_is_the_same_again_and_moves_with_the_seed():
    values = np.random.default_rng(0).normal(size=10)
    assert interval(values, seed=7) == interval(values, seed=7)
    first, other = interval(values, seed=7), interval(values, seed=8)
    assert other != first and other == pytest.approx(first, abs=0.08 * (first[2] - first[1]))


def test_pairing_takes_the_level_of_an_object_off():
    rng = np.random.default_rng(0)
    level = 5 * rng.normal(size=20)
    one, other = level + 1 + 0.1 * rng.normal(size=20), level + 0.1 * rng.normal(size=20)
    assert interval(other)[2] > interval(one)[1]  # side by side the two overlap
    assert interval(one - other)[1] > 0


def test_metrics_keep_the_mean_and_leave_out_what_is_unknown():
    assert interval_metrics([0.5]) == {"mean": 0.5}
    found = interval_metrics([0.1, 0.2, 0.4], seed=3)
    assert set(found) == {"mean", "low", "high"} and found["mean"] == round(0.7 / 3, 6)


def test_shares_of_the_splits():
    assert shared_by("random") == pytest.approx(1 / 3) and shared_by("regions") == 0.43
    assert shared_by("objects") == 0 and shared_by("objects", 3) == 1 / 2 and shared_by("objects", 5) == 1 / 4
    assert shared_by("random", 5) == shared_by("random")
    with pytest.raises(ValueError):
        shared_by("apart")


@pytest.mark.parametrize("split", list(Split))
def test_every_split_has_words(split):
    assert len(split.words) > 8


@pytest.mark.parametrize("shared", [0.0, 0.5])
def test_a_p_value_is_small_just_where_the_interval_leaves_zero_out(shared):
    random = np.random.default_rng(0)
    for shift in (0.0, 0.3, 0.6, 1.0, 3.0):
        values = random.normal(shift, 1, 30)
        low, high = interval(values, shared)[1:]
        assert (p_value(values, shared) < 0.05) == (low > 0 or high < 0)
        assert p_value(-values, shared) == pytest.approx(p_value(values, shared), abs=0.01)


def test_a_p_value_is_uniform_where_there_is_no_effect():
    random = np.random.default_rng(1)
    found = np.array([p_value(random.normal(size=25)) for _ in range(200)])
    assert abs((found < 0.5).mean() - 0.5) < 0.1 and (found < 0.05).mean() < 0.1


def test_a_p_value_is_no_smaller_than_the_draws_can_tell():
    assert 0.001 <= p_value(np.random.default_rng(0).normal(9, 1, 30)) <= 0.002


def test_no_interval_has_no_p_value():
    assert np.isnan(p_value([1.0])) and np.isnan(p_value([1.0, 1.0])) and np.isnan(p_value([]))


def test_discoveries_are_those_of_benjamini_and_hochberg():
    p_values = [0.001, np.nan, 0.008, 0.039, 0.041, 0.9]  # of 5 known, 0.01 x rank: 0.01, 0.02, 0.03, 0.04, 0.05
    assert discoveries(p_values).tolist() == [True, False, True, False, False, False]
    assert discoveries([]).tolist() == [] and discoveries([np.nan]).tolist() == [False]


def first_fall(at, left):
    """Where a curve that starts at 1 first falls below one half, inf where it never does."""
    for k in range(1, len(at)):
        if left[k] < 0.5:
            return at[k - 1] + (left[k - 1] - 0.5) / (left[k - 1] - left[k]) * (at[k] - at[k - 1])
    return np.inf


@pytest.mark.parametrize("severities", [[1.0, 2.0, 4.0, 5.0], [-1.0, -2.0, -4.0, -5.0]])
def test_an_interval_of_breaking_points_is_that_of_the_curves_of_resampled_units(severities):
    left = np.clip(np.random.default_rng(0).uniform(0.2, 1, (9, 4)).cumprod(axis=1) + 0.12, 0, 1)
    left[2, 3] = np.nan
    at, sign = np.abs([0.0, *severities]), np.sign(severities[0])
    found = []
    for counts in np.random.default_rng(3).multinomial(9, np.full(9, 1 / 9), 2000):
        units = np.repeat(left, counts, axis=0)
        found.append(first_fall(at, [1.0, *np.nanmean(units, axis=0)]))
    found.sort()
    tail = stats.norm.cdf(np.sqrt(9 / 8) * stats.t.ppf(0.025, 8))
    wanted = first_fall(at, [1.0, *np.nanmean(left, axis=0)]), *(found[k] for k in _ends(tail))
    assert wanted[1] < wanted[0] < wanted[2] < np.inf
    assert breaking_interval(severities, left, 0.0, 3) == pytest.approx(tuple(sign * np.array(wanted)))
    one = breaking_interval(severities, left[:1], 0.0)
    assert one == pytest.approx(3 * [sign * first_fall(at, [1.0, *left[0]])])


def _ends(tail):
    return int(np.floor(1999 * tail)), int(np.ceil(1999 * (1 - tail)))

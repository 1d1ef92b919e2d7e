"""Intervals and p-values of a mean, pooled sets, breaking points, and the units that count once."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from haptic_glance.know.split import Split, shared_by
from stages.engine.rows import by_unit, unit
from stages.engine.statistics import (
    breaking_interval,
    breaking_point,
    discoveries,
    interval,
    interval_metrics,
    p_value,
    pool,
)


def test_few_values_get_a_wider_interval_than_the_plain_percentiles():
    values = np.random.default_rng(1).normal(size=6)
    picks = np.random.default_rng(0).integers(6, size=(2000, 6))
    plain = np.quantile(values[picks].mean(axis=1), [0.025, 0.975])
    mean, low, high = interval(values)
    stretch = 2.5706 / 1.9600 * np.sqrt(6 / 5)  # t with five degrees of freedom over z
    assert mean - low == pytest.approx(stretch * (mean - plain[0]), rel=1e-3)
    assert high - mean == pytest.approx(stretch * (plain[1] - mean), rel=1e-3)


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
    with pytest.raises(ValueError, match="shape"):
        interval([[1.0, 2.0]])


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


def test_metrics_keep_the_mean_and_leave_out_what_is_unknown():
    assert interval_metrics([0.5]) == {"mean": 0.5}
    metrics = interval_metrics([0.1, 0.2, 0.4], seed=3)
    assert set(metrics) == {"mean", "low", "high"} and metrics["mean"] == round(0.7 / 3, 6)


def test_shares_of_the_splits():
    assert shared_by("random") == pytest.approx(1 / 3) and shared_by("regions") == 0.43
    assert shared_by("objects") == 0 and shared_by("objects", 3) == 1 / 2 and shared_by("objects", 5) == 1 / 4
    assert shared_by("random", 5) == shared_by("random")
    with pytest.raises(ValueError):
        shared_by("apart")


@pytest.mark.parametrize("shared", [0.0, 0.5])
def test_a_p_value_is_small_just_where_the_interval_leaves_zero_out(shared):
    random = np.random.default_rng(0)
    for shift in (0.0, 0.3, 0.6, 1.0, 3.0):
        values = random.normal(shift, 1, 30)
        low, high = interval(values, shared)[1:]
        assert (p_value(values, shared) < 0.05) == (low > 0 or high < 0)
        assert p_value(-values, shared) == pytest.approx(p_value(values, shared), abs=0.01)


def test_a_p_value_is_uniform_where_there_is_no_effect_and_no_smaller_than_the_draws_can_tell():
    random = np.random.default_rng(1)
    p_values = np.array([p_value(random.normal(size=25)) for _ in range(200)])
    assert abs((p_values < 0.5).mean() - 0.5) < 0.1 and (p_values < 0.05).mean() < 0.1
    assert 0.001 <= p_value(np.random.default_rng(0).normal(9, 1, 30)) <= 0.002
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
    falls = []
    for counts in np.random.default_rng(3).multinomial(9, np.full(9, 1 / 9), 2000):
        units = np.repeat(left, counts, axis=0)
        falls.append(first_fall(at, [1.0, *np.nanmean(units, axis=0)]))
    falls.sort()
    tail = stats.norm.cdf(np.sqrt(9 / 8) * stats.t.ppf(0.025, 8))
    wanted = first_fall(at, [1.0, *np.nanmean(left, axis=0)]), *(falls[k] for k in _ends(tail))
    assert wanted[1] < wanted[0] < wanted[2] < np.inf
    assert breaking_interval(severities, left, 0.0, 3) == pytest.approx(tuple(sign * np.array(wanted)))
    bounds = breaking_interval(severities, left[:1], 0.0)
    assert bounds == pytest.approx(3 * [sign * first_fall(at, [1.0, *left[0]])])
    assert breaking_point(severities, left[0], 0.0) == pytest.approx(bounds[0])


def _ends(tail):
    return int(np.floor(1999 * tail)), int(np.ceil(1999 * (1 - tail)))


# Thirteen trials of the BCG vaccine (Colditz 1994): cases and others, vaccinated and not. The figures are those that
# the documentation of metafor prints for log risk ratios, restricted maximum likelihood and Knapp and Hartung's test.
TRIALS = np.array([
    (4, 119, 11, 128), (6, 300, 29, 274), (3, 228, 11, 209), (62, 13536, 248, 12619), (33, 5036, 47, 5761),
    (180, 1361, 372, 1079), (8, 2537, 10, 619), (505, 87886, 499, 87892), (29, 7470, 45, 7232), (17, 1699, 65, 1600),
    (186, 50448, 141, 27197), (5, 2493, 3, 2338), (27, 16886, 29, 17825),
], dtype=float)  # fmt: skip
MANY = 1e9  # degrees of freedom


def trials():
    a, b, c, d = TRIALS.T
    return np.log(a / (a + b) / (c / (c + d))), np.sqrt(1 / a - 1 / (a + b) + 1 / c - 1 / (c + d))


def test_the_published_example_comes_out_as_published():
    pooled = pool(*trials(), np.full(13, MANY))
    assert pooled.interval() == pytest.approx((-0.7145, -1.1084, -0.3206), abs=1e-4)
    assert (pooled.error, pooled.between, pooled.i2) == pytest.approx((0.1808, 0.3132, 0.9222), abs=1e-4)
    assert pooled.freedom == 12 and pooled.p_value == pytest.approx(0.0019, abs=1e-4)
    assert pooled.differ == pytest.approx(stats.chi2.sf(152.2330, 12), rel=1e-3, abs=0)


def test_equal_effects_are_pooled_by_their_precision_and_none_of_the_variation_is_between():
    pooled = pool([2.0, 2.0, 2.0], [1.0, 1.0, 0.5], [MANY] * 3)
    assert (pooled.mean, pooled.i2, pooled.between) == (2.0, 0.0, 0.0)
    assert pooled.error == pytest.approx((1 + 1 + 4) ** -0.5)
    assert pooled.interval()[1] == pytest.approx(2 - 1.959964 * pooled.error, abs=1e-5)


def test_few_units_widen_the_interval():
    many, few = (pool([1.0, 1.0], [0.5, 0.5], [df, df]) for df in (MANY, 2))
    assert few.freedom == pytest.approx(4)  # of Welch and Satterthwaite: as many as both have together
    assert np.ptp(few.interval()[1:]) == pytest.approx(np.ptp(many.interval()[1:]) * stats.t.ppf(0.975, 4) / 1.959964)


def test_sets_that_differ_widen_the_interval_and_weigh_more_alike():
    apart, alike = pool([0.0, 1.0, 5.0], [0.1, 0.2, 0.3], [MANY] * 3), pool([2.0] * 3, [0.1, 0.2, 0.3], [MANY] * 3)
    assert apart.mean == pytest.approx(2, abs=0.05) and apart.freedom == 2 and apart.i2 > 0.95 and apart.differ < 1e-6
    assert np.ptp(apart.interval()[1:]) > 10 * np.ptp(alike.interval()[1:])


@pytest.mark.parametrize("errors", [[0.1], [0.1, 0.0], [0.1, np.nan]])
def test_what_cannot_be_pooled_is_refused(errors):
    with pytest.raises(ValueError, match="two sets or more"):
        pool([1.0] * len(errors), errors, [5.0] * len(errors))


SIZES = ("small", "medium", "large")
PRIMITIVES = ("cube", "cylinder", "pyramid", "sphere", "torus")


def over(names, values):
    """A Series over items."""
    return pd.Series(values, index=pd.Index(names, name="item"), dtype=float)


@pytest.mark.parametrize(
    ("item", "name"),
    [("cubesmall", "cube"), ("toruslarge", "torus"), ("cube", "cube"), ("Airplane_61", "Airplane"),
     ("round_table", "round_table"), ("alien2", "alien2"), ("small", "small")],
)  # fmt: skip
def test_copies_are_of_one_shape_and_the_benchmark_s_names_tell_the_class(item, name):
    assert unit(item) == name


def test_copies_give_the_same_interval_as_the_shapes_alone():
    values = np.random.default_rng(0).normal(1, 1, 10)
    shapes = [*PRIMITIVES, *"abcde"]
    alone = over(shapes, values)
    names = [f"{shape}{size}" for shape in PRIMITIVES for size in SIZES] + list("abcde")
    copied = over(names, [*np.repeat(values[:5], 3), *values[5:]])
    assert interval(copied) == pytest.approx(interval(alone))
    assert p_value(copied) == pytest.approx(p_value(alone))
    plain = interval(copied.to_numpy())
    assert plain[2] - plain[1] < 0.9 * (interval(copied)[2] - interval(copied)[1])  # as if they were fifteen shapes


def test_one_level_without_copies_is_the_plain_bootstrap():
    values = np.random.default_rng(1).normal(size=12)
    assert interval(over([f"object_{k}x" for k in range(12)], values)) == interval(values)


def test_levels_are_averaged_from_the_innermost_and_weigh_the_same():
    index = pd.MultiIndex.from_tuples(
        [("a", "x", 0), ("a", "x", 1), ("a", "y", 0), ("b", "z", 0)], names=["group", "object", "seed"]
    )
    means = by_unit(pd.Series([1.0, 3.0, 8.0, 10.0], index=index))
    assert means.to_dict() == {"a": 5.0, "b": 10.0}  # ((1 + 3) / 2 + 8) / 2, not (1 + 3 + 8) / 3


def test_copies_within_a_class_are_one_value_and_unknown_values_are_left_out():
    index = pd.MultiIndex.from_tuples([("p", "cubesmall"), ("p", "cubelarge"), ("p", "mug"), ("q", "cup")],
                                      names=["group", "item"])  # fmt: skip
    assert by_unit(pd.Series([1.0, 3.0, 6.0, 5.0], index=index)).to_dict() == {"p": 4.0, "q": 5.0}
    assert by_unit(over(["cubesmall", "cubelarge", "mug"], [1, np.nan, np.nan])).to_dict() == {"cube": 1.0}

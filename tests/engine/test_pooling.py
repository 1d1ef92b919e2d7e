"""Random-effects pooling, against published figures and known truth; and how many units would decide."""

import numpy as np
import pytest
from scipy import stats

from stages.engine.statistics import MOST, needed, pool

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
    found = pool(*trials(), np.full(13, MANY))
    assert found.interval() == pytest.approx((-0.7145, -1.1084, -0.3206), abs=1e-4)
    assert (found.error, found.between, found.i2) == pytest.approx((0.1808, 0.3132, 0.9222), abs=1e-4)
    assert found.freedom == 12 and found.p_value == pytest.approx(0.0019, abs=1e-4)
    assert found.differ == pytest.approx(stats.chi2.sf(152.2330, 12), rel=1e-3, abs=0)


def test_equal_effects_are_pooled_by_their_precision_and_none_of_the_variation_is_between():
    found = pool([2.0, 2.0, 2.0], [1.0, 1.0, 0.5], [MANY] * 3)
    assert (found.mean, found.i2, found.between) == (2.0, 0.0, 0.0)
    assert found.error == pytest.approx((1 + 1 + 4) ** -0.5)
    assert found.interval()[1] == pytest.approx(2 - 1.959964 * found.error, abs=1e-5)


def test_few_units_widen_the_interval():
    many, few = (pool([1.0, 1.0], [0.5, 0.5], [df, df]) for df in (MANY, 2))
    assert few.freedom == pytest.approx(4)  # of Welch and Satterthwaite: as many as both have together
    assert np.ptp(few.interval()[1:]) == pytest.approx(np.ptp(many.interval()[1:]) * stats.t.ppf(0.975, 4) / 1.959964)


def test_sets_that_differ_widen_the_interval_and_weigh_more_alike():
    apart, alike = pool([0.0, 1.0, 5.0], [0.1, 0.2, 0.3], [MANY] * 3), pool([2.0] * 3, [0.1, 0.2, 0.3], [MANY] * 3)
    assert apart.mean == pytest.approx(2, abs=0.05) and apart.freedom == 2 and apart.i2 > 0.95 and apart.differ < 1e-6
    assert np.ptp(apart.interval()[1:]) > 10 * np.ptp(alike.interval()[1:])


def test_mirrored_effects_give_the_mirrored_interval():
    effects, errors = np.array([0.3, -0.1, 0.9]), [0.2, 0.3, 0.2]
    mean, low, high = pool(effects, errors, [9, 9, 9]).interval()
    assert pool(-effects, errors, [9, 9, 9]).interval() == pytest.approx((-mean, -high, -low))


@pytest.mark.parametrize("errors", [[0.1], [0.1, 0.0], [0.1, np.nan]])
def test_what_cannot_be_pooled_is_refused(errors):
    with pytest.raises(ValueError, match="two sets or more"):
        pool([1.0] * len(errors), errors, [5.0] * len(errors))


@pytest.mark.slow
@pytest.mark.parametrize(("sets", "apart"), [(2, 0.0), (3, 0.0), (3, 0.1), (3, 0.3), (4, 0.3)])
def test_pooled_intervals_cover_as_often_as_they_say(sets, apart):
    draw, hits = np.random.default_rng(2), 0
    for _ in range(600):
        values = draw.normal(0, apart, (sets, 1)) + draw.normal(size=(sets, 19))
        found = pool(values.mean(axis=1), values.std(axis=1, ddof=1) / 19**0.5, [18.0] * sets)
        hits += np.sign(found.interval()[1:]).sum() == 0
    assert 0.9 < hits / 600 <= 0.99


def test_as_many_units_are_needed_as_narrow_the_interval_to_the_distance():
    count = needed(spread=10.0, distance=3.0)
    half = [stats.t.ppf(0.975, n - 1) * 10 / n**0.5 for n in (count - 1, count)]
    assert half[0] > 3 >= half[1]


def test_repeated_splits_that_share_data_may_never_decide():
    assert needed(1.0, 1.2, shared=1 / 3) < np.inf and needed(1.0, 1.1, shared=1 / 3) == np.inf
    assert needed(1.0, 0.5) < 30 and needed(1.0, 1 / MOST) == np.inf

"""The interval of a mean, for numbers that get compared."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from .units import by_unit

Statistic = Callable[..., np.floating | np.ndarray]

RESAMPLES = 2000  # the interval's own error is then below a tenth of its width
SMALLEST = 1e-3  # p-value
ROUNDED = 1e-3  # of the largest value: differences of measurements with six digits are no more equal than this


def interval(
    values: ArrayLike, shared: float = 0.0, seed: int = 0, level: float = 0.95, statistic: Statistic = np.mean
) -> tuple[float, float, float]:
    """(mean, low, high): bootstrap percentile interval of the values (k,), NaN left out, widened twice about the mean.

    A Series whose index has a level `item` counts by unit (stages.kit.units): copies of a shape are one. First it is
    widened by t(n - 1) / z * sqrt(n / (n - 1)), since the percentile interval (Efron and Tibshirani, An Introduction to
    the Bootstrap, 1993, chapter 13) is too narrow for few values (Hesterberg, What teachers should know about the
    bootstrap, The American Statistician 2015, section 3.3). Then by sqrt(1 + n * shared) where the values are repeated
    splits of the same data: without it an interval shrinks to nothing by splitting more often (Nadeau and Bengio,
    Inference for the generalization error, 2003). shared: test over training share of a split
    (haptic_glance.know.split); 0 for values of independent items. Fewer than two values, or values without spread: no
    interval (NaN), since a resample of equal values says nothing of how others would differ. statistic: np.median,
    say, in the mean's place. Raises ValueError for values of another shape.
    """
    values = of_units(values)
    n = len(values)
    if n == 0:
        return np.nan, np.nan, np.nan
    mean = float(statistic(values, axis=0))
    if n == 1 or np.ptp(values) <= ROUNDED * np.abs(values).max():
        return mean, np.nan, np.nan
    picks = np.random.default_rng(seed).integers(n, size=(RESAMPLES, n))
    tail = (1 + level) / 2
    low, high = np.quantile(statistic(values[picks], axis=1), [1 - tail, tail])
    few = stats.t.ppf(tail, n - 1) / stats.norm.ppf(tail) * np.sqrt(n / (n - 1))
    widen = few * np.sqrt(1 + n * shared)
    return mean, float(mean - (mean - low) * widen), float(mean + (high - mean) * widen)


def of_units(values: ArrayLike) -> np.ndarray:
    """The finite values as `interval` counts them: those of a Series over items by unit, all others each by itself."""
    known: Any = values  # a Series, maybe; the core install has no pandas to ask
    if "item" in getattr(getattr(known, "index", None), "names", ()):
        known = by_unit(known)
    found = np.asarray(known, dtype=np.float64)
    if found.ndim != 1:
        raise ValueError(f"values must have shape (k,), got {found.shape}")
    return found[np.isfinite(found)]


def p_value(values: ArrayLike, shared: float = 0.0, seed: int = 0) -> float:
    """Two-sided: 1 less the level at which the `interval` of the values (k,) just touches zero; NaN without interval.

    Not below SMALLEST, which is what RESAMPLES draws can tell.
    """
    values = of_units(values)
    levels = np.array([SMALLEST, 1 - SMALLEST])  # searched by halving, since an interval widens with its level
    if not np.isfinite(interval(values, shared, seed)[1]):
        return np.nan
    while np.ptp(levels) > SMALLEST:
        low, high = interval(values, shared, seed, level=float(levels.mean()))[1:]
        levels[0 if low > 0 or high < 0 else 1] = levels.mean()
    return float(1 - levels.mean())


def discoveries(p_values: ArrayLike, rate: float = 0.05) -> np.ndarray:
    """(k,) bool: which of the p-values (k,) hold with a false discovery rate; NaN never does.

    Benjamini and Hochberg, Controlling the false discovery rate, 1995, by scipy.
    """
    p_values = np.asarray(p_values, dtype=np.float64)
    known = np.isfinite(p_values)
    found = np.zeros(len(p_values), dtype=bool)
    if known.any():
        found[known] = stats.false_discovery_control(p_values[known]) <= rate
    return found


def interval_metrics(values: ArrayLike, seed: int = 0) -> dict[str, float]:
    """{mean, low, high} of `interval`, rounded for a metric file; what is not finite is left out."""
    ends = zip(("mean", "low", "high"), interval(values, seed=seed), strict=True)
    return {key: round(value, 6) for key, value in ends if np.isfinite(value)}

"""Intervals for numbers that get compared."""

import numpy as np

RESAMPLES = 2000  # the interval's own error is then below a tenth of its width


def bootstrap_interval(values, seed=0, level=0.95):
    """(mean, low, high): percentile bootstrap over the values (objects, folds or seeds), NaN left out.

    Source: Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter 13. One value gives a NaN interval.
    """
    values = np.asarray(values, dtype=np.float64)
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return np.nan, np.nan, np.nan
    if len(values) == 1:
        return float(values[0]), np.nan, np.nan
    picks = np.random.default_rng(seed).integers(len(values), size=(RESAMPLES, len(values)))
    tail = (1 - level) / 2
    low, high = np.quantile(values[picks].mean(axis=1), [tail, 1 - tail])
    return float(values.mean()), float(low), float(high)


def interval_metrics(values, seed=0):
    """{mean, low, high} of bootstrap_interval, rounded for a metric file; what is not finite is left out."""
    interval = zip(("mean", "low", "high"), bootstrap_interval(values, seed), strict=True)
    return {key: round(value, 6) for key, value in interval if np.isfinite(value)}

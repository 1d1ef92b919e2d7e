"""Intervals that stay honest with few values, and with repetitions that share their data."""

import numpy as np
from scipy import stats

from stages.kit.stats import bootstrap_interval

HOLD_OUT = 0.25 / 0.75  # test over training share of the hold-out repetitions, T4.2.4
REGION_OUT = 0.43  # the same where a region is held out and the touches that overlap it are not trained on
ROUNDED = 1e-3  # of the largest value: differences of measurements with six digits are no more equal than this


def interval(values, shared=0.0, level=0.95):
    """(mean, low, high): bootstrap percentile interval over the values, widened twice about the mean.

    First by t(n - 1) / z * sqrt(n / (n - 1)), since the percentile interval is too narrow for few values (Hesterberg,
    What teachers should know about the bootstrap, The American Statistician 2015, section 3.3). Then by
    sqrt(1 + n * shared) where the values are repeated splits of the same data: without it an interval shrinks to
    nothing by splitting more often (Nadeau and Bengio, Inference for the generalization error, 2003). shared: test over
    training share of a split; 0 for values of independent items. Fewer than two values, or values without spread: no
    interval (NaN), since a resample of equal values says nothing of how others would differ.
    """
    values = np.asarray(values, dtype=np.float64)
    values = values[np.isfinite(values)]
    mean, low, high = bootstrap_interval(values, level=level)
    n = len(values)
    if n < 2:
        return mean, low, high
    if np.ptp(values) <= ROUNDED * np.abs(values).max():
        return mean, np.nan, np.nan
    tail = (1 + level) / 2
    few = stats.t.ppf(tail, n - 1) / stats.norm.ppf(tail) * np.sqrt(n / (n - 1))
    widen = few * np.sqrt(1 + n * shared)
    return mean, mean - (mean - low) * widen, mean + (high - mean) * widen


def shared_by(split):
    """Test over training share of a split by its name: `apart` holds out regions."""
    return REGION_OUT if split == "apart" else HOLD_OUT


def summary(frame, by, shared=0.0, top=np.inf):
    """Mean, low, high, count and seconds of column `value`, a row for each combination of the columns `by`.

    For values within 0..top, such as rates and errors: the interval is cut there. Seconds are the median, since the
    first piece of work of a process also loads its libraries.
    """
    rows = []
    for key, group in frame.dropna(subset=["value"]).groupby(by, sort=False):
        mean, low, high = interval(group["value"], shared)
        found = {"mean": mean, "low": np.maximum(low, 0.0), "high": np.minimum(high, top), "values": len(group)}
        rows.append(dict(zip(by, key, strict=True)) | found | {"seconds": group["seconds"].median()})
    return rows

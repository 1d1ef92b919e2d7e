"""Breaking point: the severity of a perturbation at which half of a score's lead is lost."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from .stats import RESAMPLES

BROKEN = 0.5  # share of the lead that is left at the breaking point


def lead_left(accuracy: ArrayLike, clean: float, chance: float) -> np.ndarray:
    """The share of the lead over chance that is left: 1 for the undisturbed accuracy `clean`, 0 at chance.

    accuracy: any shape. NaN if `clean` is at chance or below, since there is no lead to lose.
    """
    lead = np.asarray(accuracy, dtype=np.float64) - chance
    return lead / (clean - chance) if clean > chance else np.full_like(lead, np.nan)


def breaking_point(severities: Sequence[float], left: Sequence[float], unharmed: float) -> float:
    """The mildest severity at which less than half is left, linearly interpolated; NaN if there is none.

    severities (s,): from mild to harsh, rising or falling; left (s,): a share such as that of `lead_left` or the
    repeatability; unharmed: the severity that changes nothing, where the share is 1.
    """
    return float(_first_falls(severities, np.asarray(left, dtype=np.float64)[None], unharmed)[0])


def breaking_interval(
    severities: Sequence[float], left: ArrayLike, unharmed: float, seed: int = 0
) -> tuple[float, float, float]:
    """(breaking point of the mean over units, its 95 % interval from mild to harsh); NaN is beyond the harshest.

    left (n, s): of each unit at each severity, NaN where it was not measured. The units are resampled, and an end of
    the interval is censored where so many resamples do not break. The ends are quantiles at levels that are widened for
    few units (`expanded_levels`). Fewer than two units: both ends are the breaking point.
    """
    left = np.atleast_2d(np.asarray(left, dtype=np.float64))
    left = left[np.isfinite(left).any(axis=1)]
    at = float(_first_falls(severities, resampled_means(left, np.ones((1, len(left)))), unharmed)[0])
    if len(left) < 2:
        return at, at, at
    sign = 1 if severities[-1] >= unharmed else -1  # harsher is more, or less
    found = sign * _first_falls(severities, resampled_means(left, resamples(len(left), seed)), unharmed)
    found[np.isnan(found)] = np.inf
    tail = expanded_levels(len(left))
    low, high = np.quantile(found, tail[0], method="lower"), np.quantile(found, tail[1], method="higher")
    mild, harsh = (sign * float(end) if np.isfinite(end) else float("nan") for end in (low, high))
    return at, mild, harsh


def resamples(units: int, seed: int = 0) -> np.ndarray:
    """(RESAMPLES, units) f8: how often each unit is in each bootstrap resample."""
    return np.random.default_rng(seed).multinomial(units, np.full(units, 1 / units), RESAMPLES).astype(np.float64)


def resampled_means(values: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """(r, k) means of values (n, k) over the units that counts (r, n) name; NaN left out, NaN where nothing is left."""
    known = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return (counts @ np.where(known, values, 0.0)) / (counts @ known)


def expanded_levels(units: int, level: float = 0.95) -> tuple[float, float]:
    """(low, high) quantiles of a bootstrap of `units` units whose interval has this level in spite of few units.

    The plain percentile interval is too narrow by t / z * sqrt(n / (n - 1)). Quantiles farther out mend that, the
    expanded percentile interval of Hesterberg (What teachers should know about the bootstrap, The American Statistician
    2015), and an end may be censored.
    """
    tail = float(stats.norm.cdf(np.sqrt(units / (units - 1)) * stats.t.ppf((1 - level) / 2, units - 1)))
    return tail, 1 - tail


def _first_falls(severities, left, unharmed):
    """(r,) breaking points of curves (r, s); NaN where a curve never falls below BROKEN, or falls after a NaN."""
    at = np.array([unharmed, *severities], dtype=np.float64)
    left = np.hstack([np.ones((len(left), 1)), left])
    k, rows = (left < BROKEN).argmax(axis=1), np.arange(len(left))  # 0 where it never falls
    before, after = left[rows, k - 1], left[rows, k]
    with np.errstate(invalid="ignore", divide="ignore"):
        found = at[k - 1] + (before - BROKEN) / (before - after) * (at[k] - at[k - 1])
    return np.where(k > 0, found, np.nan)

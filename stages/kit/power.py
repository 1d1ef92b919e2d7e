"""How many units would decide what is open."""

from functools import cache

import numpy as np
from scipy import stats

MOST = 10_000  # units; what needs more is hardly an effect


@cache
def _quantiles() -> np.ndarray:
    return stats.t.ppf(0.975, np.arange(1, MOST))


def needed(spread: float, distance: float, shared: float = 0.0) -> float:
    """The fewest units whose 95 % interval is no wider than `distance` to either side; infinite beyond MOST.

    By Student's interval at the present spread, the standard deviation of the units: t(n - 1) * spread * sqrt(1 / n +
    shared). distance: of the present mean from what would decide it. shared: as in `stages.kit.stats.interval`: of
    repeated splits that share much even infinitely many may not decide.
    """
    counts = np.arange(2, MOST + 1)
    enough = _quantiles() * spread * np.sqrt(1 / counts + shared) <= distance
    return float(counts[enough.argmax()]) if enough.any() else np.inf

"""The smallest sensor that is sufficient, and the repeatability of that choice."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

RESAMPLES = 1000  # of the objects: shares then have an error below three points


def smallest_sufficient(accuracy: dict[tuple[int, float], float], slack: float) -> tuple[int, float]:
    """Key (cells, pitch) of the smallest array whose accuracy is at most `slack` below the best one's.

    accuracy: {(cells per side, pitch): mean accuracy}. The smallest array has the fewest sensels, since each is wired
    and read. Of equal numbers it is the narrower array, which fits into more places. Raises ValueError for no array or
    a negative slack.
    """
    if not accuracy or not slack >= 0:
        raise ValueError(f"give at least one array and a slack of 0 or more, got {len(accuracy)} and {slack}")
    floor = max(accuracy.values()) - slack
    return min(key for key, value in accuracy.items() if value >= floor)


def choice_repeatability(scores: Mapping[tuple[int, float], ArrayLike], slack: float, seed: int = 0) -> float:
    """The share of bootstrap resamples of the objects in which `smallest_sufficient` chooses the same array.

    scores: {(cells per side, pitch): accuracies of the objects, in one order}. The arrays differ by less than the width
    of their intervals, so that a choice without its repeatability could be chance.
    """
    table = np.array(list(scores.values()), dtype=np.float64)
    chosen = smallest_sufficient(dict(zip(scores, table.mean(axis=1), strict=True)), slack)
    resampled = np.random.default_rng(seed).integers(table.shape[1], size=(RESAMPLES, table.shape[1]))
    resamples = (dict(zip(scores, means, strict=True)) for means in table[:, resampled].mean(axis=2).T)
    return sum(smallest_sufficient(means, slack) == chosen for means in resamples) / RESAMPLES

"""Positions that keep a distance from all before them."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def spaced(positions: np.ndarray, radius: float, first: int, limit: int) -> np.ndarray:
    """Indices of positions (k, 3), in order, each farther than radius from all before it; the `first` ones stay.

    limit: stop at so many.
    """
    kept, count = np.empty(len(positions), np.int64), 0
    for i in range(len(positions)):
        if count >= max(limit, first):
            break
        if i < first or _apart(positions, i, kept[:count], radius):
            kept[count] = i
            count += 1
    return kept[:count]


@kernel
def _apart(positions, i, others, radius):
    for k in others:
        square = 0.0
        for axis in range(3):
            square += (positions[k, axis] - positions[i, axis]) ** 2
        if square <= radius**2:
            return False
    return True

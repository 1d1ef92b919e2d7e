"""Maxima of values over space and scale."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def scale_peaks(values: np.ndarray, floor: float) -> np.ndarray:
    """(k,) i8 flat ids, in order, of values (scales, a, b, c) above `floor` that no neighbour of 80 exceeds.

    The first and the last scale have none. At the border of the grid there are fewer neighbours.
    """
    scales, a, b, c = values.shape
    found = []
    for s in range(1, scales - 1):
        for i in range(a):
            for j in range(b):
                for k in range(c):
                    value = values[s, i, j, k]
                    if value > floor and not _exceeded(values, value, s, i, j, k):
                        found.append(((s * a + i) * b + j) * c + k)
    return np.array(found, dtype=np.int64)


@kernel
def _exceeded(values, value, s, i, j, k):
    _, a, b, c = values.shape
    for scale in range(s - 1, s + 2):
        for x in range(max(i - 1, 0), min(i + 2, a)):
            for y in range(max(j - 1, 0), min(j + 2, b)):
                for z in range(max(k - 1, 0), min(k + 2, c)):
                    if values[scale, x, y, z] > value:
                        return True
    return False

"""The local maxima of a map."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


def mean_of_other_maxima(values: np.ndarray, least: float) -> float:
    """The mean of the local maxima above `least` of values (h, w) f4, without the highest; 0 if there is no other."""
    total, highest, count = _maxima(values, least)
    return (total - highest) / (count - 1) if count > 1 else 0.0


def mean_of_maxima(values: np.ndarray) -> float:
    """The mean of all local maxima of values (h, w) f4, 0 or more; 0 of an even map, which has none above zero."""
    total, _, count = _maxima(values, 0.0)
    return total / count if count else 0.0


@kernel
def _maxima(values: np.ndarray, least: float) -> tuple[float, float, int]:
    """(sum, highest, number) of the local maxima above `least` of values (h, w) f4.

    A local maximum is at least as high as its eight neighbours; a plateau counts as one.
    """
    height, width = values.shape
    total, highest, count = 0.0, 0.0, 0
    counted = np.zeros((height, width), dtype=np.bool_)
    for i in range(height):
        for j in range(width):
            if values[i, j] <= np.float32(least) or counted[i, j] or not _is_peak(values, i, j):
                continue
            total, highest, count = total + values[i, j], max(highest, values[i, j]), count + 1
            counted[i, j], plateau = True, [(i, j)]
            while len(plateau):
                a, b = plateau.pop()
                for r in range(max(a - 1, 0), min(a + 2, height)):
                    for c in range(max(b - 1, 0), min(b + 2, width)):
                        if values[r, c] == values[i, j] and not counted[r, c] and _is_peak(values, r, c):
                            counted[r, c] = True
                            plateau.append((r, c))
    return total, highest, count


@kernel
def _is_peak(values, i, j):
    for r in range(max(i - 1, 0), min(i + 2, values.shape[0])):
        for c in range(max(j - 1, 0), min(j + 2, values.shape[1])):
            if values[r, c] > values[i, j]:
                return False
    return True

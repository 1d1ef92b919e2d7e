"""Maxima of an image, one after another, with the neighbourhood of each suppressed."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def suppress(image: np.ndarray, radius: float, limit: int, floor: float) -> np.ndarray:
    """(k,) i8 flat ids of at most `limit` maxima above `floor`, each outside the discs around those before it.

    image (h, w) f8 is set to zero within `radius` pixels of each. Of equal pixels the first one is taken.
    """
    height, width = image.shape
    extent, found = int(radius), []
    tops, firsts = np.empty(height), np.empty(height, np.int64)  # largest value of each row, and its column
    for r in range(height):
        firsts[r] = image[r].argmax()
        tops[r] = image[r, firsts[r]]
    while len(found) < limit:
        row = tops.argmax()
        if tops[row] <= floor:
            break
        column = firsts[row]
        found.append(row * width + column)
        for r in range(max(row - extent, 0), min(row + extent + 1, height)):
            for c in range(max(column - extent, 0), min(column + extent + 1, width)):
                if (r - row) ** 2 + (c - column) ** 2 <= radius**2:
                    image[r, c] = 0.0
            firsts[r] = image[r].argmax()
            tops[r] = image[r, firsts[r]]
    return np.array(found, dtype=np.int64)

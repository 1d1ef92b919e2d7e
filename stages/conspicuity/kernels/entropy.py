"""The entropy of the grey levels in the window around each pixel."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def window_entropy(padded: np.ndarray, side: int) -> np.ndarray:
    """(h, w) f4 entropy in bits of the side x side windows of an image (h + side - 1, w + side - 1) u1 (T eq. 3.7)."""
    height, width, pixels = padded.shape[0] - side + 1, padded.shape[1] - side + 1, side * side
    shares = np.arange(pixels + 1) / pixels
    terms = -shares * np.log2(np.maximum(shares, 1 / pixels))
    found = np.empty((height, width), dtype=np.float32)
    for i in range(height):
        counts, total = np.zeros(256, dtype=np.int64), 0.0
        for a in range(i, i + side):
            for b in range(side):
                counts[padded[a, b]] += 1
        for count in counts:
            total += terms[count]
        found[i, 0] = total
        for j in range(1, width):
            for a in range(i, i + side):
                total += _moved(counts, terms, padded[a, j - 1], -1) + _moved(counts, terms, padded[a, j + side - 1], 1)
            found[i, j] = total
    return found


@kernel
def _moved(counts, terms, level, step):
    """The change of the entropy by a pixel of a level that leaves the window (-1) or enters it (1)."""
    before = terms[counts[level]]
    counts[level] += step
    return terms[counts[level]] - before

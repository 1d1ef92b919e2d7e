"""Entropy: how unpredictable the grey levels round a point are."""

import cv2
import numpy as np

from .background import fill
from .operators import COMMON, normalise, reduce
from .picture import picture

SIDE = 9  # T3.1.1
MEDIAN = 3  # pixels a side; T3.1.1 names the filter, not its size
SCALE = 2  # of the pixels where it is worked out: the windows overlap, so each pixel counts
_COUNTS = np.arange(SIDE * SIDE + 1)
PLOGP = (_COUNTS * np.log2(np.maximum(_COUNTS, 1))).astype(np.float32)


def entropy(mesh, view, filled=True):
    """The entropy conspicuity map (h / 16, w / 16) f4 in 0..1: N of the entropy in 9 x 9 after a median (T eq. 3.7).

    Only pixels of the object count, so that the background's grey is no surprise.
    """
    image = picture(view, filled)
    if image.empty:
        return image.nothing()
    smooth = cv2.medianBlur(image.luminance, MEDIAN)
    values = np.zeros(image.cover[SCALE].shape, dtype=np.float32)
    rows, columns = np.nonzero(image.cover[SCALE])
    values[rows, columns] = local_entropy(smooth, image.known, rows * 2**SCALE, columns * 2**SCALE)
    values = reduce(fill(values, image.cover[SCALE]), SCALE)
    return image.whole(normalise(values, image.cover[COMMON]), COMMON)


def local_entropy(image, counted, rows, columns):
    """(k,) f4: entropy in bits of the counted pixels in the 9 x 9 windows round pixels (rows (k,), columns (k,)).

    image (h, w) u1, counted (h, w) boolean; outside the image nothing counts. Sorting each window brings equal levels
    together; with runs of c_i pixels among n, H = log2(n) - sum(c_i log2 c_i) / n.
    """
    half = SIDE // 2
    levels = np.where(counted, image.astype(np.int16), -1)  # -1, no grey level: does not count
    padded = cv2.copyMakeBorder(levels, half, half, half, half, cv2.BORDER_CONSTANT, value=-1)
    windows = np.lib.stride_tricks.sliding_window_view(padded, (SIDE, SIDE))[rows, columns].reshape(-1, SIDE * SIDE)
    windows.sort(axis=1)
    ends = np.ones(windows.shape, dtype=bool)
    np.not_equal(windows[:, 1:], windows[:, :-1], out=ends[:, :-1])
    at = np.flatnonzero(ends)
    runs = np.diff(at, prepend=-1)
    runs[windows.ravel()[at] < 0] = 0
    firsts = np.searchsorted(at, np.arange(len(windows)) * SIDE * SIDE)
    counts = np.maximum(np.add.reduceat(runs, firsts), 1) if len(firsts) else np.ones(0)
    summed = np.add.reduceat(PLOGP[runs], firsts) if len(firsts) else np.zeros(0)
    return (np.log2(counts) - summed / counts).astype(np.float32).clip(0)

"""Entropy of the grey levels around a point."""

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .background import fill
from .cropped_view import cropped_view
from .operators import OUTPUT_SCALE, normalise, reduce

SIDE = 9  # T3.1.1
MEDIAN = 3  # pixels per side; T3.1.1 names the filter, not its size
SCALE = 2  # of the pixels where it is computed; the windows overlap, so each pixel counts
_COUNTS = np.arange(SIDE * SIDE + 1)
PLOGP = (_COUNTS * np.log2(np.maximum(_COUNTS, 1))).astype(np.float32)


def entropy(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The entropy conspicuity map (h / 16, w / 16) f4 in 0..1: N of the entropy in 9 x 9 after a median (T eq. 3.7).

    Only pixels of the object count, so that the background adds no entropy.
    """
    image = cropped_view(view, filled)
    if image.empty:
        return image.zero_map()
    smooth = cv2.medianBlur(image.luminance, MEDIAN)
    values = np.zeros(image.cover[SCALE].shape, dtype=np.float32)
    rows, columns = np.nonzero(image.cover[SCALE])
    values[rows, columns] = local_entropy(smooth, image.known, rows * 2**SCALE, columns * 2**SCALE)
    values = reduce(fill(values, image.cover[SCALE]), SCALE)
    return image.place_in_view(normalise(values, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def local_entropy(image: np.ndarray, counted: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """(k,) f4: entropy in bits of the counted pixels in the 9 x 9 windows around pixels (rows (k,), columns (k,)).

    image (h, w) u1, counted (h, w) boolean; pixels outside the image do not count. Each window is sorted, so that equal
    levels form runs; with runs of c_i pixels among n, H = log2(n) - sum(c_i log2 c_i) / n.
    """
    half = SIDE // 2
    levels = np.where(counted, image.astype(np.int16), -1)  # -1 is not a grey level: does not count
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

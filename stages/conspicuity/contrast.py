"""Contrast: the variance of the luminance around a point."""

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import OUTPUT_SCALE, normalise, reduce

WINDOW = 80 / 900  # of the image's rows: 80 x 80 pixels in the thesis's 1200 x 900 (T3.1.1)
FLOOR = 0.5 / 255**2  # variance of half a grey level; below it there is only rounding


def contrast(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The contrast conspicuity map (h / 16, w / 16) f4 in 0..1, N of the luminance variance in 80 x 80 (T3.1.1).

    Only pixels of the object count in a window, so that the step to the background adds no contrast.
    """
    image = cropped_view(view, filled)
    if image.empty:
        return image.zero_map()
    side = max(round(WINDOW * image.shape[0]), 3)
    variance = reduce(local_variance(image.luminance, image.known, side), 0)
    return image.place_in_view(normalise(variance, image.cover[OUTPUT_SCALE], FLOOR), OUTPUT_SCALE)


def local_variance(image: np.ndarray, counted: np.ndarray, side: int) -> np.ndarray:
    """(h, w) f4: variance, in units of white squared, over the counted pixels of a side x side window.

    image (h, w) u1, counted (h, w) boolean. Zero where no pixel counts. Sums are of integers, so exact.
    """
    values = np.where(counted, image, 0).astype(np.float32)

    def window_sum(plane):
        return cv2.boxFilter(plane, cv2.CV_64F, (side, side), normalize=False, borderType=cv2.BORDER_CONSTANT)

    count = np.maximum(window_sum(counted.astype(np.float32)), 1)
    mean = window_sum(values) / count
    return ((window_sum(values * values) / count - mean * mean) / 255**2).astype(np.float32)

"""Contrast: how much the luminance varies round a point."""

import cv2
import numpy as np

from .operators import COMMON, normalise, reduce
from .picture import picture

WINDOW = 80 / 900  # of the image's rows: 80 x 80 pixels in the thesis's 1200 x 900 (T3.1.1)
FLOOR = 0.5 / 255**2  # variance of half a grey level: below it there is only rounding


def contrast(mesh, view, filled=True):
    """The contrast conspicuity map (h / 16, w / 16) f4 in 0..1, N of the luminance variance in 80 x 80 (T3.1.1).

    Only pixels of the object count in a window, so that the step to the background is no contrast.
    """
    image = picture(view, filled)
    if image.empty:
        return image.nothing()
    side = max(round(WINDOW * image.shape[0]), 3)
    variance = reduce(local_variance(image.luminance, image.known, side), 0)
    return image.whole(normalise(variance, image.cover[COMMON], FLOOR), COMMON)


def local_variance(image, counted, side):
    """(h, w) f4: variance, in units of white squared, over the counted pixels of a side x side window.

    image (h, w) u1, counted (h, w) boolean. Zero where no pixel counts. Sums are of whole numbers, so exact.
    """
    values = np.where(counted, image, 0).astype(np.float32)

    def window_sum(plane):
        return cv2.boxFilter(plane, cv2.CV_64F, (side, side), normalize=False, borderType=cv2.BORDER_CONSTANT)

    count = np.maximum(window_sum(counted.astype(np.float32)), 1)
    mean = window_sum(values) / count
    return ((window_sum(values * values) / count - mean * mean) / 255**2).astype(np.float32)

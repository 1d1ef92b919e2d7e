"""The structural dissimilarity of two pictures (T3.1.4, T3.2.9.2)."""

import cv2
import numpy as np

from .kernels import similarity

WINDOW = 11  # pixels; Wang et al. 2004, with a Gaussian of sigma 1.5
SIGMA = 1.5
STABILISERS = ((0.01 * 255) ** 2, (0.03 * 255) ** 2)  # keep the ratios finite; Wang et al. 2004, section III-B


def ssim_error(
    reference: np.ndarray, picture: np.ndarray, moments: tuple[np.ndarray, np.ndarray] | None = None
) -> float:
    """1 - SSIM of two pictures (rows, columns), 0 to 255, averaged over every pixel of the picture.

    moments: local_moments(reference), where the reference serves many comparisons.

    Source: Wang, Bovik, Sheikh and Simoncelli 2004 (T [63]); the same values as scikit-image's structural_similarity
    with its Gaussian window, at a quarter of its time.
    """
    top, bottom, left, right = _content_box(reference, picture)
    inside = slice(top, bottom), slice(left, right)
    known = None if moments is None else (moments[0][inside].copy(), moments[1][inside].copy())  # compiled for rows
    return float((1 - ssim_map(reference[inside], picture[inside], known)).sum() / reference.size)


def ssim_map(a: np.ndarray, b: np.ndarray, moments: tuple[np.ndarray, np.ndarray] | None = None) -> np.ndarray:
    """(rows, columns) SSIM at each pixel of two pictures (rows, columns), 0 to 255; moments of a: see `ssim_error`."""
    return similarity(*(moments or local_moments(a)), *local_moments(b), _blurred(a * b), *STABILISERS)


def local_moments(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mean (rows, columns) in the window around each pixel, and that of the squares."""
    return _blurred(picture), _blurred(picture * picture)


def _blurred(values):
    return cv2.sepFilter2D(values, -1, WEIGHTS, WEIGHTS, borderType=cv2.BORDER_REFLECT)


def _content_box(reference, picture):
    """(top, bottom, left, right) of the content of both pictures, outside of which they are equal: the same sum."""
    content = np.maximum(reference, picture) > 0
    left, top, width, height = cv2.boundingRect(content.view(np.uint8))
    return max(top - WINDOW, 0), top + height + WINDOW, max(left - WINDOW, 0), left + width + WINDOW


WEIGHTS = cv2.getGaussianKernel(WINDOW, SIGMA)

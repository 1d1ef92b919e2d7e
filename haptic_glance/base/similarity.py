"""Structural similarity of two pictures, pixel by pixel, from local moments (Wang et al. 2004, T [63], eq. 13)."""

import numpy as np

from .jit import cached_njit
from .lazy import cv2

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
    c1, c2 = ((share * white) ** 2 for share in STABILISERS)
    return similarity(*(moments or local_moments(a)), *local_moments(b), _blurred(a * b), c1, c2)


def local_moments(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mean (rows, columns) in the window around each pixel, and that of the squares."""
    return _blurred(picture), _blurred(picture * picture)


def _blurred(values):
    weights = cv2.getGaussianKernel(WINDOW, SIGMA)
    return cv2.sepFilter2D(values, -1, weights, weights, borderType=cv2.BORDER_REFLECT)


kernel = cached_njit()


@kernel
def similarity(
    mean_a: np.ndarray, square_a: np.ndarray, mean_b: np.ndarray, square_b: np.ndarray, product: np.ndarray,
    c1: float, c2: float,
) -> np.ndarray:  # fmt: skip
    """(rows, columns) SSIM from the local means of a and b, of their squares and of their product; two stabilisers."""
    ssim = np.empty_like(product)
    for i in range(len(product)):
        for j in range(product.shape[1]):
            means = mean_a[i, j] * mean_b[i, j]
            sizes = mean_a[i, j] * mean_a[i, j] + mean_b[i, j] * mean_b[i, j]
            alike = (2 * means + c1) * (2 * (product[i, j] - means) + c2)
            ssim[i, j] = alike / ((sizes + c1) * (square_a[i, j] + square_b[i, j] - sizes + c2))
    return ssim

"""Structural similarity from local moments (Wang et al. 2004, T [63], eq. 13), compiled by numba."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def similarity(
    mean_a: np.ndarray, square_a: np.ndarray, mean_b: np.ndarray, square_b: np.ndarray, product: np.ndarray,
    one: float, two: float,
) -> np.ndarray:  # fmt: skip
    """(rows, columns) SSIM from the local means of a and b, of their squares and of their product; two stabilisers."""
    found = np.empty_like(product)
    for i in range(len(product)):
        for j in range(product.shape[1]):
            both = mean_a[i, j] * mean_b[i, j]
            sizes = mean_a[i, j] * mean_a[i, j] + mean_b[i, j] * mean_b[i, j]
            alike = (2 * both + one) * (2 * (product[i, j] - both) + two)
            found[i, j] = alike / ((sizes + one) * (square_a[i, j] + square_b[i, j] - sizes + two))
    return found

"""The registry of denoisers, which clean an imprint before its features are computed (T6.3).

To add one, add an entry: function (training imprints (k, rows, cols) f4 in 0..1, seed) -> Denoiser.
"""

from collections.abc import Callable

import numpy as np
from scipy.ndimage import median_filter

from haptic_glance.base.extras import from_extra

Denoiser = Callable[[np.ndarray], np.ndarray]  # imprints (k, rows, cols) in 0..1 -> the same shape, cleaner


def median(training: np.ndarray, seed: int) -> Denoiser:
    """The median of each cell and its eight neighbours: the control, which learns nothing."""
    return lambda images: median_filter(images, size=(1, 3, 3), mode="nearest")


def autoencoder(training: np.ndarray, seed: int) -> Denoiser:
    """A network that learned to undo noise, dead cells and blur from the training imprints alone."""
    with from_extra():
        from .autoencoder import train
    return train(training, seed)


DENOISERS: dict[str, Callable[[np.ndarray, int], Denoiser]] = {"median": median, "autoencoder": autoencoder}

"""The registry of denoisers, which clean an imprint before its features are computed (T6.3).

To add one, add an entry: function (training imprints (k, rows, cols) f4 in 0..1, seed) -> Denoiser.
"""

from collections.abc import Callable

import numpy as np

from haptic_glance.base.extras import from_extra

Denoiser = Callable[[np.ndarray], np.ndarray]  # imprints (k, rows, cols) in 0..1 -> the same shape, cleaner


def autoencoder(training: np.ndarray, seed: int) -> Denoiser:
    """A network that learned to undo noise, dead cells and blur from the training imprints alone."""
    with from_extra():
        from .autoencoder import train
    return train(training, seed)


DENOISERS: dict[str, Callable[[np.ndarray, int], Denoiser]] = {"autoencoder": autoencoder}

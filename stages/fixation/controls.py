"""Control saliencies that any model must beat: the centre of the image, and random values."""

import numpy as np

SPREAD = 0.25  # of the image's side: deviation of the Gaussian; half of the object lies within it


def centre_prior(size: int) -> np.ndarray:
    """(size, size) f8 in 0..1: a Gaussian at the centre of the image."""
    across = np.exp(-(((np.arange(size) - (size - 1) / 2) / (SPREAD * size)) ** 2) / 2)
    return across[:, None] * across


def random_saliency(count: int, generator: np.random.Generator) -> np.ndarray:
    """(count,) f8 in 0..1: an independent random value per vertex."""
    return generator.random(count)

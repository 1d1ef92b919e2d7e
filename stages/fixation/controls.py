"""What any model must beat: looking at the middle of the picture, and looking anywhere."""

import numpy as np

SPREAD = 0.25  # of the picture's side: deviation of the Gaussian; half of the object is then within it


def centre_prior(size):
    """(size, size) f8 in 0..1: a Gaussian at the middle of the picture."""
    across = np.exp(-(((np.arange(size) - (size - 1) / 2) / (SPREAD * size)) ** 2) / 2)
    return across[:, None] * across


def noise(count, generator):
    """(count,) f8 in 0..1: a value a vertex that knows nothing."""
    return generator.random(count)

"""Imprints that are easy to tell apart, for the tests of this folder."""

import numpy as np
import pytest


@pytest.fixture
def bumps():
    """A function: {object: (count, 16, 16)}, a bump at the place of each object, give or take `jitter` cells."""

    def make(names=("cup", "duck", "hand"), count=16, jitter=0.3):
        random = np.random.default_rng(0)
        row, column = np.mgrid[:16, :16][..., None]
        images = {}
        for k, name in enumerate(names):
            down, along = jitter * random.normal(size=(2, count))
            bump = np.exp(-((row - 2 - 4 * k - down) ** 2 + (column - 12 + 3 * k - along) ** 2) / (6.0 + 6 * k))
            images[name] = bump.transpose(2, 0, 1)
        return images

    return make

"""Directions spread evenly over the sphere."""

import numpy as np


def directions(count: int) -> np.ndarray:
    """(count, 3) unit vectors: a Fibonacci lattice."""
    k = np.arange(count) + 0.5
    height, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    across = np.sqrt(1 - height**2)
    return np.stack([np.cos(turn) * across, np.sin(turn) * across, height], axis=1)

"""Imprints: the array's distances as images in 0..1."""

import numpy as np

from .distances import check_sensor, distances

FLAT = 1e-3  # of the pitch: relief below it is rounding in the model's coordinates, not shape


def press(mesh, vertex, cells=(16, 16), pitch=0.01, reach=None):
    """(rows, cols) f4 in 0..1: the imprint of the virtual pressure array pressed on a mesh at one vertex (T4.3.1).

    0 is contact: the cell that the object would press first. 1 is the cell farthest from the surface. So the image is
    one of distance, dark where the pressure is high; 1 - image is the pressure. A flat place gives all zeros, and so
    does an array that has missed the object with every cell. Parameters, errors and sources as in `distances`.
    """
    return press_many(mesh, np.atleast_1d(vertex), cells, pitch, reach)[0]


def press_many(mesh, vertices, cells=(16, 16), pitch=0.01, reach=None):
    """(k, rows, cols) f4 in 0..1: the imprints at vertices (k,), as `press` gives them, in batches of rays."""
    return normalise(distances(mesh, vertices, cells, pitch, reach), pitch)


def normalise(distances, pitch):
    """Distances (k, rows, cols) scaled to 0..1, each imprint by its own least and greatest (T4.3.1): f4.

    The thesis names the reason: a rigid array touches first where the distance is most negative, and the shift puts
    the zero there. An imprint whose relief is below a thousandth of the pitch is flat: all zero, not amplified noise.
    """
    distances = np.asarray(distances, dtype=np.float64)
    if distances.ndim != 3:
        raise ValueError(f"distances must have shape (k, rows, cols), got {distances.shape}")
    check_sensor(distances.shape[1:], pitch)
    low = distances.min(axis=(1, 2), keepdims=True)
    relief = distances.max(axis=(1, 2), keepdims=True) - low
    scale = np.divide(1.0, relief, out=np.zeros_like(relief), where=relief > FLAT * pitch)
    return ((distances - low) * scale).astype(np.float32)

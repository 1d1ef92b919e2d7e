"""Imprints: the array's distances as images in 0..1."""

import numpy as np

from .distances import check_sensors, distances, distances_at

FLAT = 1e-3  # of the pitch: relief below it is rounding in the model's coordinates, not shape
BLOCK = 1 << 20  # cells scaled at once: in double precision 8 MB


def press(mesh, vertex, cells=(16, 16), pitch=0.01, reach=None, contact="tangent"):
    """(rows, cols) f4 in 0..1: the imprint of the virtual pressure array pressed on a mesh at one vertex (T4.3.1).

    0 is contact: the cell that the object would press first. 1 is the cell farthest from the surface. So the image is
    one of distance, dark where the pressure is high; 1 - image is the pressure. A flat place gives all zeros, and so
    does an array that has missed the object with every cell. Parameters, errors and sources as in `distances`.
    """
    return press_many(mesh, [vertex], cells, pitch, reach, contact)[0]


def press_many(mesh, vertices, cells=(16, 16), pitch=0.01, reach=None, contact="tangent"):
    """(k, rows, cols) f4 in 0..1: the imprints at vertices (k,), as `press` gives them."""
    return normalise(distances(mesh, vertices, cells, pitch, reach, contact=contact), pitch)


def press_at(surface, centres, axes, cells=(16, 16), pitch=0.01, reach=None, contact="tangent"):
    """(k, rows, cols) f4 in 0..1: the imprints of arrays at centres (k, 3) with axes (k, 3, 3), see `distances_at`."""
    return normalise(distances_at(surface, centres, axes, cells, pitch, reach, contact), pitch)


def normalise(distances, pitch):
    """Distances (k, rows, cols) scaled to 0..1, each imprint by its own least and greatest (T4.3.1): f4.

    pitch: a number, or (k,) one an imprint.

    The thesis names the reason: a rigid array touches first where the distance is most negative, and the shift puts
    the zero there. An imprint whose relief is below a thousandth of the pitch is flat: all zero, not amplified noise.
    """
    distances = np.asarray(distances)
    if distances.ndim != 3:
        raise ValueError(f"distances must have shape (k, rows, cols), got {distances.shape}")
    cells, pitches, _ = check_sensors(distances.shape[1:], pitch, None, len(distances))
    images, step = np.empty(distances.shape, dtype=np.float32), max(1, BLOCK // (cells[0] * cells[1]))
    for i in range(0, len(distances), step):
        above = distances[i : i + step].astype(np.float64)
        if not np.isfinite(above).all():
            raise ValueError("distances must be finite numbers of units")
        above -= above.min(axis=(1, 2), keepdims=True)
        relief = above.max(axis=(1, 2), keepdims=True)
        flat = relief <= FLAT * pitches[i : i + step, None, None]
        images[i : i + step] = above * np.divide(1.0, relief, out=np.zeros_like(relief), where=~flat)
    return images

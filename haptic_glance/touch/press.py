"""Imprints: the distances of the array as images in 0..1."""

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh

from .distances import check_arrays, distances, distances_at
from .surface import Surface

FLAT = 1e-3  # of the pitch: relief below it is rounding of the mesh's coordinates
FAINT = 0.1  # of the pitch: a relief below has less contrast in pictures
BLOCK = 1 << 20  # cells scaled at once, 8 MB in double precision


def press(
    mesh: Mesh | Surface,
    vertex: int,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.01,
    max_distance: float | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """(rows, cols) f4 in 0..1: the imprint of the virtual pressure array pressed on a mesh at one vertex (T4.3.1).

    0 is the cell of first contact, 1 the cell farthest from the surface. So the image shows distance and is dark where
    the pressure is high; 1 - image is the pressure. A flat place gives all zeros, and so does an array that misses the
    object with every cell. Parameters, errors and sources as in `distances`.
    """
    return press_many(mesh, [vertex], cells, pitch, max_distance, contact)[0]


def press_many(
    mesh: Mesh | Surface,
    vertices: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.01,
    max_distance: float | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1: the imprints at vertices (k,), as `press` gives them."""
    return normalise(distances(mesh, vertices, cells, pitch, max_distance, contact=contact), pitch)


def press_at(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: ArrayLike = 0.01,
    max_distance: ArrayLike | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1: the imprints of arrays at centres (k, 3) with axes (k, 3, 3), see `distances_at`."""
    return normalise(distances_at(surface, centres, axes, cells, pitch, max_distance, contact), pitch)


def as_shown(images: np.ndarray, reliefs: ArrayLike, pitch: float) -> np.ndarray:
    """Imprints (k, rows, cols) in 0..1 for a picture: a relief (k,) below a tenth of the pitch has less contrast.

    Scaled to the whole range, as recognition needs it, a flat place would look like a deep one.
    """
    contrast = np.minimum(np.asarray(reliefs, dtype=np.float64) / (FAINT * pitch), 1)
    return images * contrast[:, None, None]


def normalise(distances: ArrayLike, pitch: ArrayLike) -> np.ndarray:
    """Distances (k, rows, cols) scaled to 0..1, each imprint by its own least and greatest (T4.3.1): f4.

    pitch: a number, or (k,), one per imprint.

    The reason in the thesis: a rigid array touches first where the distance is most negative, and the shift makes this
    cell zero. An imprint with a relief below a thousandth of the pitch is flat: all zero, not amplified noise.
    """
    distances = np.asarray(distances)
    if distances.ndim != 3:
        raise ValueError(f"distances must have shape (k, rows, cols), got {distances.shape}")
    cells, pitches, _ = check_arrays(distances.shape[1:], pitch, None, len(distances))
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

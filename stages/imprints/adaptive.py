"""The array's size adapted to saddles: the pitch shrinks until no cell is inside the object (T4.4.3)."""

import numpy as np
from numpy.typing import ArrayLike

from stages.kit import Mesh

from .distances import check_arrays, distances_at
from .surface import Surface

MIN_PITCH = 0.2  # of the pitch, as T4.3.2's fine sensor (0.002) to its coarse one (0.01)
MAX_FACTOR = 0.99  # between the pitches of two measurements, at most
TOLERANCE = 0.5  # of the pitch: how deep a cell may be inside the object, as an elastic skin yields


def adaptive_distances(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    cells: tuple[int, int] = (32, 32),
    pitch: ArrayLike = 0.01,
    min_pitch: ArrayLike | None = None,
    tolerance: ArrayLike | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """The pitches (k,), at most `pitch`, at which arrays fit on the object (T4.4.3), and their distances.

    The arrays are at centres (k, 3) with axes (k, 3, 3); the distances (k, rows, cols) are those of `distances_at`. An
    array fits when no cell is more than `tolerance` units inside the object. If it does not fit, its pitch shrinks
    to the size at which the deepest cells of two neighbouring square rings predict a fit, and it is measured again.
    This ends when the array fits or the pitch is `min_pitch`, which is returned even if it does not fit. The thesis
    shrinks the array and gives no rule. By default `min_pitch` is a fifth and `tolerance` a half of the pitch. pitch: a
    number, or (k,). Raises ValueError for invalid cells or pitches, or a `min_pitch` above the pitch.
    """
    centres, axes = np.asarray(centres, dtype=np.float64), np.asarray(axes, dtype=np.float64)
    cells, pitches, max_distances = check_arrays(cells, pitch, None, len(centres))
    min_pitches = _checked_limit("min_pitch", min_pitch, MIN_PITCH * pitches, pitches)
    tolerances = _checked_limit("tolerance", tolerance, TOLERANCE * pitches, np.inf)
    pitches, active = pitches.copy(), np.arange(len(centres))
    distances = np.empty((len(centres), *cells))
    widths, ring = _rings(cells)
    by_ring, starts = np.argsort(ring, kind="stable"), np.searchsorted(np.sort(ring), np.arange(len(widths)))
    while len(active):
        places = centres[active], axes[active], cells, pitches[active], max_distances[active]
        distances[active] = distances_at(surface, *places)
        active = active[pitches[active] > min_pitches[active]]
        by_cell = distances[active].reshape(len(active), len(ring))[:, by_ring] + tolerances[active, None]
        clearance = np.minimum.reduceat(by_cell, starts, axis=1)
        too_large = (clearance < 0).any(axis=1)
        active, clearance = active[too_large], clearance[too_large]
        pitches[active] = np.maximum(pitches[active] * _fitting_widths(widths, clearance), min_pitches[active])
    limits = check_arrays(cells, pitches, None, len(centres))[2][:, None, None]  # a smaller array senses less deep
    return pitches, np.clip(distances, -limits, limits)


def _rings(cells):
    """(half widths of the square rings of cells, the outermost 1; the ring of each cell (rows * cols,))."""
    rows, columns = (np.abs(np.arange(count) - (count - 1) / 2) / (max(count - 1, 1) / 2) for count in cells)
    widths, ring = np.unique(np.maximum(rows[:, None], columns).round(12), return_inverse=True)
    return widths, ring.ravel()


def _fitting_widths(widths, clearance):
    """(k,) half widths at which the clearance (k, rings) becomes 0, interpolated between two rings."""
    first = np.argmax(clearance < 0, axis=1)
    rows, inner = np.arange(len(clearance)), np.maximum(first - 1, 0)
    left = np.where(first > 0, clearance[rows, inner], 0.0)
    share = left / (left - clearance[rows, first])
    start = np.where(first > 0, widths[inner], 0.0)
    return np.minimum(start + share * (widths[first] - start), MAX_FACTOR)


def _checked_limit(name, value, default, upper):
    value = default if value is None else np.broadcast_to(np.asarray(value, dtype=np.float64), default.shape)
    if not ((value > 0) & (value <= upper)).all():
        limit = "" if upper is np.inf else " and at most the pitch"
        raise ValueError(f"{name} must be above 0{limit}, got {value.min()} to {value.max()}")
    return value

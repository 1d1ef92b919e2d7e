"""The array's size adapted to saddles: sensing points move closer until none is inside the object (T4.4.3)."""

import numpy as np

from .distances import check_sensors, distances_at

LEAST = 0.2  # of the pitch: palm to fingertip, as T4.3.2's coarse sensor (0.01) to its fine one (0.002)
SMALLER = 0.99  # times, at most, from one measurement to the next
TOLERANCE = 0.5  # of the pitch: so deep a cell may sink into the object, as an elastic skin gives


def adaptive_pitch(surface, centres, axes, cells=(32, 32), pitch=0.01, least=None, tolerance=None):
    """(k,) pitches, at most `pitch`, at which arrays at centres (k, 3) with axes (k, 3, 3) fit on the object (T4.4.3).

    An array fits when no cell is more than `tolerance` units inside the object. Where one does not, the same cells move
    closer, to where the deepest cells of two neighbouring square rings say that the tolerance is kept, and are measured
    again, until it fits or `least` is reached, which is returned whether it fits or not. The thesis shrinks the array
    and gives no rule. Defaults: `least` a fifth and `tolerance` a half of the pitch. pitch: a number, or (k,).
    Raises ValueError where cells and pitch make no array, or for a least size beyond the pitch.
    """
    centres, axes = np.asarray(centres, dtype=np.float64), np.asarray(axes, dtype=np.float64)
    cells, pitches, reaches = check_sensors(cells, pitch, None, len(centres))
    least = _bound("least", least, LEAST * pitches, pitches)
    tolerance = _bound("tolerance", tolerance, TOLERANCE * pitches, np.inf)
    pitches, trying = pitches.copy(), np.arange(len(centres))
    widths, ring = _rings(cells)
    while len(trying):
        found = distances_at(surface, centres[trying], axes[trying], cells, pitches[trying], reaches[trying])
        room = np.full((len(trying), len(widths)), np.inf)
        np.minimum.at(room, (slice(None), ring), found.reshape(len(trying), -1) + tolerance[trying, None])
        cuts = (room < 0).any(axis=1)
        trying, room = trying[cuts], room[cuts]
        pitches[trying] = np.maximum(pitches[trying] * _free(widths, room), least[trying])
        trying = trying[pitches[trying] > least[trying]]
    return pitches


def _rings(cells):
    """(half widths of the square rings of cells, the outermost 1; the ring of each cell (rows * cols,))."""
    rows, columns = (np.abs(np.arange(count) - (count - 1) / 2) / (max(count - 1, 1) / 2) for count in cells)
    widths, ring = np.unique(np.maximum(rows[:, None], columns).round(12), return_inverse=True)
    return widths, ring.ravel()


def _free(widths, room):
    """(k,) half widths at which the room (k, rings) to the tolerance is used up, by a line between two rings."""
    first = np.argmax(room < 0, axis=1)
    rows, inner = np.arange(len(room)), np.maximum(first - 1, 0)
    left = np.where(first > 0, room[rows, inner], 0.0)
    share = left / (left - room[rows, first])
    start = np.where(first > 0, widths[inner], 0.0)
    return np.minimum(start + share * (widths[first] - start), SMALLER)


def _bound(name, value, default, most):
    value = default if value is None else np.broadcast_to(np.asarray(value, dtype=np.float64), default.shape)
    if not ((value > 0) & (value <= most)).all():
        limit = "" if most is np.inf else " and at most the pitch"
        raise ValueError(f"{name} must be above 0{limit}, got {value.min()} to {value.max()}")
    return value

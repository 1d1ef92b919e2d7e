"""Channel weights from the distance of a map's brightest pixels to the ground truth points (T3.2.1.1).

This follows the thesis, with these consequences:

- "Average pairwise" is the mean over all pairs of the n brightest pixels and the n points, not over nearest pairs. It
  is smallest between the points, not on them: one blob in the middle of four points scores better than four peaks
  exactly on the points.
- The n brightest pixels are neighbours on one peak, so only the position of the highest peak of a map matters.
- The distances are normalised over the channels of each view, so that the farthest channel of a view gets 0 and the
  nearest 1, however little they differ.
"""

from collections.abc import Iterable, Mapping

import numpy as np


def view_distances(maps: Mapping[str, np.ndarray], rows: np.ndarray, columns: np.ndarray) -> dict[str, float]:
    """The distance of each channel's brightest pixels to the points of one view: dict channel -> mean, in pixels.

    maps: dict channel -> (h, w), all of one shape; rows, columns (n,): the ground truth points visible in this view,
    in pixels of the maps, fractions allowed. The mean is over all pairs of the n brightest pixels of the map and the n
    points (T3.2.1.1; MATLAB's `mean(pdist2(a, b), 'all')`). Pixels that tie for the last of the n places count equally,
    so that a flat map gets the mean distance of all pixels.

    A view without points gives {}. Raises ValueError for no maps, maps of unequal shapes, with NaN or not
    2D, and for points that are not finite or off the map.
    """
    maps, shape = checked_maps(maps)
    points = _checked_points(rows, columns, shape)
    if not len(points):
        return {}
    return {channel: _distance(values, points) for channel, values in maps.items()}


def _distance(image, points):
    """Mean distance of the brightest pixels to the points; as many pixels as points."""
    count = min(len(points), image.size)
    cut = np.sort(image, axis=None)[image.size - count]  # partition takes five times as long on a map of many zeros
    above, tied = image > cut, image == cut
    places = count - above.sum()
    near = _to_points(above, points).sum() + places * _to_points(tied, points).mean()
    return float(near / count)


def _to_points(chosen, points):
    """(k,) the mean distance to the points of each of the chosen pixels (h, w) boolean."""
    pixels = np.nonzero(chosen)
    total = np.zeros(len(pixels[0]))
    for row, column in points:  # one point at a time: on a flat map, a million pixels are chosen
        total += np.hypot(pixels[0] - row, pixels[1] - column)
    return total / len(points)


def euclidean_weights(views: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """One minus the distance, normalised over the channels of each view, averaged: dict channel -> weight in 0..1.

    views: the dicts of view_distances, weighted equally; empty ones (no visible point) are left out. If all channels of
    a view are equally far, all get 1. For several objects, `average` the weights of the objects, so that an object with
    more views does not count more. T3.2.1.1, T table 3.1, third column.

    Raises ValueError when no view has a point, or the views name different channels.
    """
    return average([_nearness(view) for view in views])


def _nearness(distances):
    if not distances:
        return {}
    values = np.array(list(distances.values()), dtype=np.float64)
    if not np.isfinite(values).all() or values.min() < 0:
        raise ValueError(f"distances must be finite and not negative, got {distances}")
    span = np.ptp(values)
    relative = (values - values.min()) / span if span > 0 else np.zeros_like(values)
    return dict(zip(distances, (1 - relative).tolist(), strict=True))


def average(tables: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """The mean of dicts channel -> value, in the order of the channels; empty dicts are left out.

    Raises ValueError when none is left, or when they name different channels.
    """
    tables = [table for table in tables if table]
    if not tables:
        raise ValueError("no view shows a ground truth point: weights need at least one")
    channels = list(tables[0])
    for table in tables:
        if set(table) != set(channels):
            raise ValueError(f"views name different channels: {', '.join(channels)} and {', '.join(table)}")
    return {channel: float(np.mean([table[channel] for table in tables])) for channel in channels}


def checked_maps(maps: Mapping[str, np.ndarray]) -> tuple[dict[str, np.ndarray], tuple[int, int]]:
    """(dict channel -> (h, w) f8, shape); ValueError for no maps, NaN, unequal shapes or maps that are not 2D."""
    if not maps:
        raise ValueError("no conspicuity maps: give at least one channel")
    maps = {channel: np.asarray(values, dtype=np.float64) for channel, values in maps.items()}
    shapes = {values.shape for values in maps.values()}
    shape = shapes.pop()
    if shapes or len(shape) != 2 or 0 in shape:
        raise ValueError(f"conspicuity maps must have one shape (h, w), got {[v.shape for v in maps.values()]}")
    bad = [channel for channel, values in maps.items() if not np.isfinite(values).all()]
    if bad:
        raise ValueError(f"conspicuity maps hold NaN or infinite values: {', '.join(bad)}")
    return maps, shape


def _checked_points(rows, columns, shape):
    rows, columns = np.asarray(rows, dtype=np.float64), np.asarray(columns, dtype=np.float64)
    if rows.ndim != 1 or rows.shape != columns.shape:
        raise ValueError(f"rows and columns must be two arrays (n,), got {rows.shape} and {columns.shape}")
    points = np.column_stack([rows, columns])
    off = ~((points >= -0.5) & (points <= np.array(shape) - 0.5)).all(axis=1)
    if off.any():
        raise ValueError(f"points off the map of {shape[0]} x {shape[1]} pixels: {points[off][:5].round(1).tolist()}")
    return points

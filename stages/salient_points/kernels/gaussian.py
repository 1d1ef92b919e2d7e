"""Gaussian-weighted sums over the points around each place, on a grid of cells."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)

FINEST = 128  # cells along the longest side, so that a small sigma does not ask for a grid that fills the memory


@kernel
def gaussian_sums(places: np.ndarray, points: np.ndarray, values: np.ndarray, sigma: float) -> np.ndarray:
    """(n, d) f8: at each of places (n, 3) the sum of values (s, d) times exp(-distance^2 / (2 sigma^2)) within 2 sigma.

    points (s, 3) f8, where the values are.
    """
    found, reach = np.zeros((len(places), values.shape[1])), 2 * sigma
    if len(points) == 0:
        return found
    low, high = np.empty(3), np.empty(3)
    for axis in range(3):
        low[axis], high[axis] = points[:, axis].min(), points[:, axis].max()
    cell = max(sigma, (high - low).max() / FINEST)
    shape = ((high - low) / cell).astype(np.int64) + 1
    order, starts = _sorted_by_cell(points, low, cell, shape)
    first, last = np.empty(3, np.int64), np.empty(3, np.int64)
    for i in range(len(places)):
        x, y, z = places[i]
        for axis in range(3):
            first[axis] = max(int(np.floor((places[i, axis] - reach - low[axis]) / cell)), 0)
            last[axis] = min(int(np.floor((places[i, axis] + reach - low[axis]) / cell)), shape[axis] - 1)
        if first[0] > last[0]:
            continue
        for a in range(first[2], last[2] + 1):
            for b in range(first[1], last[1] + 1):
                row = (a * shape[1] + b) * shape[0]
                for k in order[starts[row + first[0]] : starts[row + last[0] + 1]]:
                    square = (points[k, 0] - x) ** 2 + (points[k, 1] - y) ** 2 + (points[k, 2] - z) ** 2
                    if square <= reach * reach:
                        weight = np.exp(square / (-2 * sigma * sigma))
                        for column in range(values.shape[1]):
                            found[i, column] += weight * values[k, column]
    return found


@kernel
def _sorted_by_cell(points, low, cell, shape):
    """(ids of the points cell by cell, start of each cell's ids and one more at the end)."""
    at = np.empty(len(points), np.int64)
    starts = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    for k in range(len(points)):
        x, y, z = ((points[k] - low) / cell).astype(np.int64)
        at[k] = (z * shape[1] + y) * shape[0] + x
        starts[at[k] + 1] += 1
    for k in range(1, len(starts)):
        starts[k] += starts[k - 1]
    order, free = np.empty(len(points), np.int64), starts.copy()
    for k in range(len(points)):
        order[free[at[k]]] = k
        free[at[k]] += 1
    return order, starts

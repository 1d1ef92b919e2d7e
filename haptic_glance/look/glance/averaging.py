"""Averages over the points of a surface; a grid of cubes gives the neighbours, faster than a tree."""

import math

import numpy as np
from scipy import sparse

from haptic_glance.base.jit import kernel_of

kernel = kernel_of(__file__, _nrt=False)  # makes no array: numba compiles np.empty for as long as a loop
STRIDES = np.array([1 << 42, 1 << 21, 1])  # cubes that follow one another along z have keys that do
ROOM = 40  # neighbours of a point for which there is room at first


def averaging(
    points: np.ndarray, normals: np.ndarray, areas: np.ndarray, reach: float, width: float, sides: tuple[float, float]
) -> sparse.csr_array:
    """(n, n) matrix that averages values of points (n, 3) over those within reach, by areas (n,).

    A neighbour weighs less by a Gaussian of this width over the distance, and by where the cosine between the unit
    normals (n, 3) lies from sides[0] to sides[1]. Neighbours are looked for in cubes as wide as the reach.
    """
    count = len(points)
    cubes = ((points - points.min(axis=0)) / reach).astype(np.int64)
    keys, cube = np.unique(cubes @ STRIDES, return_inverse=True)
    order = np.argsort(cube, kind="stable").astype(np.int32)
    firsts = np.append(0, np.cumsum(np.bincount(cube)))
    x, y = np.mgrid[-1:2, -1:2].reshape(2, 9)
    columns = keys[:, None] + x * STRIDES[0] + y * STRIDES[1]
    begins, ends = (firsts[np.searchsorted(keys, columns + step)] for step in (-1, 2))
    ordered = points[order], normals[order], areas[order], order
    starts, row = np.zeros(count + 1, dtype=np.int32), 0
    ids, weights = np.empty(ROOM * count, dtype=np.int32), np.empty(ROOM * count)
    while (row := _average(points, normals, cube, begins, ends, *ordered, reach, width, *sides, row, starts, ids,
                           weights)) < count:  # fmt: skip
        ids, weights = np.concatenate([ids, ids]), np.concatenate([weights, weights])
    return sparse.csr_array((weights[: starts[-1]], ids[: starts[-1]], starts), shape=(count, count))


@kernel
def _average(
    points, normals, cube, begins, ends, near_points, near_normals, near_areas, near_ids, reach, width, low, high, row,
    starts, ids, weights,
):  # fmt: skip
    """Fills starts, ids and weights from a row on; returns the first row without room, or the number of points.

    begins, ends (cubes, 9): where the points of nine columns of three cubes lie among near_*, the points by cube.
    """
    for i in range(row, len(points)):
        filled, total = starts[i], 0.0
        for column in range(9):
            for k in range(begins[cube[i], column], ends[cube[i], column]):
                square, cosine = 0.0, 0.0
                for axis in range(3):
                    step = points[i, axis] - near_points[k, axis]
                    square += step * step
                    cosine += normals[i, axis] * near_normals[k, axis]
                share = 1.0 if near_ids[k] == i else min(max((cosine - low) / (high - low), 0.0), 1.0)
                if square <= reach * reach and share > 0:
                    if filled == len(ids):
                        return i
                    ids[filled] = near_ids[k]
                    weights[filled] = math.exp(-square / (width * width)) * share * near_areas[k]
                    total += weights[filled]
                    filled += 1
        for k in range(starts[i], filled):
            weights[k] /= total
        starts[i + 1] = filled
    return len(points)

"""Points spread over a surface, each with its share of the area, whatever the triangles are; averages over them."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.spatial import KDTree

from haptic_glance.base.jit import cached_njit, greater, lesser

NEAREST = 10  # points that a value on the surface is interpolated from
SHARP = 0.75  # width of the Gaussian of that interpolation, in units of the spacing
WIDTH = 1.4  # of the Gaussian of an average over the surface, in units of the spacing
REACH = 2.5  # where this Gaussian ends
OTHER_SIDE = -0.2, 0.2  # cosine between two normals: from two sides of a sheet, whose values do not mix, to one side
SIZE = 3.5  # of the diameter of the bounding sphere over the root mean square of the radius: the median of 33 objects
ROUND = 0.01  # difference of the squared lengths of two horizontal axes, relative, below which neither is the longer
ROUNDING = 1e-9  # relative difference below which two ends are equally far
TURNED = 0.3  # added to the cosine between two normals: a point on the other side of a sheet has next to no weight


@dataclass(frozen=True, eq=False)
class Samples:
    """points (s, 3) f8, their unit normals (s, 3), outwards, and areas (s,), of one surface with z up.

    axes (3, 3): those of the object, in rows, see `object_axes`. rough: noise bends the surface in most of its cells.
    """

    points: np.ndarray
    normals: np.ndarray
    areas: np.ndarray
    axes: np.ndarray
    rough: bool = False

    @cached_property
    def tree(self) -> KDTree:
        """Finds the nearest points."""
        return KDTree(self.points)

    @cached_property
    def shares(self) -> np.ndarray:
        """(s,) the share of the surface that each point stands for."""
        return self.areas / self.areas.sum()

    @cached_property
    def middle(self) -> np.ndarray:
        """(3,) the mean of the surface."""
        return self.shares @ self.points

    @cached_property
    def spacing(self) -> float:
        """The root of the mean area of the point at a place of the surface."""
        return float(np.sqrt(self.shares @ self.areas))

    @cached_property
    def local(self) -> np.ndarray:
        """(s, 3) the points in the object's own frame, in units of its size: SIZE root mean squares of their radius."""
        inside = (self.points - self.middle) @ self.axes.T
        return inside / max(SIZE * np.sqrt(self.shares @ (inside**2).sum(axis=1)), np.finfo(float).tiny)

    @cached_property
    def average(self) -> sparse.csr_array:
        """(s, s) matrix that averages values (s, ...) over the surface around each point, on its side of a sheet."""
        reach, width = REACH * self.spacing, WIDTH * self.spacing
        return averaging(self.points, self.normals, self.areas, reach, width, OTHER_SIDE)

    def smoothed(self, values: np.ndarray, length: float) -> np.ndarray:
        """Values (s, ...) averaged over the surface, about as by a Gaussian of a deviation of `length`."""
        for _ in range(round((length / self.spacing) ** 2)):
            values = self.average @ values
        return values

    def interpolation(self, positions: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(ids (n, k), weights (n, k)) of the points whose mean is the value at positions (n, 3) with normals (n, 3).

        Nearer and larger points, and those that face the same way, weigh more.
        """
        distance, neighbours = nearest(self.tree, positions, NEAREST)
        cosines = np.einsum("nkj,nj->nk", self.normals[neighbours], normals)
        farther = (distance**2 - distance[:, :1] ** 2) / (SHARP * self.spacing) ** 2
        weights = (cosines + TURNED).clip(0.01) * self.areas[neighbours] * np.exp(-farther)
        return neighbours, weights / weights.sum(axis=1, keepdims=True)


def object_axes(points: np.ndarray, areas: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(axes (3, 3) in rows, middle (3,)) of points (n, 3) by areas (n,): the longest horizontal one first, z last.

    Where no horizontal axis is longer, the first one points to the end (k, 3) that is farthest from the vertical; of
    several, which are alike on an object that is alike around the vertical, to the last by x. Which way an axis points
    is left open elsewhere, so whatever uses the axes must treat both ways alike.
    """
    middle = areas @ points / areas.sum()
    flat = (points - middle)[:, :2]
    lengths, horizontal = np.linalg.eigh(-(flat * areas[:, None]).T @ flat)
    axes = np.eye(3)
    axes[:2, :2] = horizontal.T
    if lengths[1] - lengths[0] <= ROUND * abs(lengths[0]):
        distances = np.linalg.norm(ends[:, :2] - middle[:2], axis=1)
        farthest = (ends[:, :2] - middle[:2])[distances >= distances.max() * (1 - ROUNDING)]
        x, y = farthest[np.lexsort(farthest.round(9).T[::-1])[-1]]
        axes[:2, :2] = np.array([[x, y], [-y, x]]) / max(np.hypot(x, y), 1e-300) if x or y else np.eye(2)
    return axes, middle


def nearest(tree: KDTree, positions: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(distances (n, k), ids (n, k)) of the nearest of a tree's points; k is less than count where it has fewer.

    Rounding would decide which points come first among those that are as far as the first one left out. All of these
    have distance inf, unless all k points are as far.
    """
    near = tree.query(positions, min(count + 1, tree.n))
    distance, ids = (np.reshape(values, (len(positions), -1)) for values in near)
    if tree.n <= count:
        return distance, ids
    at_end = distance[:, :-1] >= distance[:, -1:] * (1 - ROUNDING)
    return np.where(at_end & ~at_end[:, :1], np.inf, distance[:, :-1]), ids[:, :-1]


kernel = cached_njit()
# Averages: a grid of cubes gives the neighbours, faster than a tree.
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
                share = 1.0 if near_ids[k] == i else lesser(greater((cosine - low) / (high - low), 0.0), 1.0)
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

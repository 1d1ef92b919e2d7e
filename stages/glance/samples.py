"""Points spread evenly over a surface, which stand for it whatever its triangles are."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.spatial import KDTree

NEAREST = 4  # points that a value on the surface is interpolated from
NEIGHBOURS = 16  # points that a point is averaged with
WIDTH = 1.6  # of the Gaussian of that average, in units of the spacing
OTHER_SIDE = -0.2  # cosine between two normals below which points lie on two sides of a sheet
TURNED = 0.3  # added to the cosine between two normals: a point on the other side of a sheet has next to no weight


@dataclass(frozen=True, eq=False)
class Samples:
    """points (s, 3) f8 and their unit normals (s, 3), outwards, of one surface with z up and a bounding sphere of 0.5.

    The order is that of cells along x, so every k-th point is a coarser version of the same surface.
    """

    points: np.ndarray
    normals: np.ndarray

    @cached_property
    def tree(self) -> KDTree:
        """Finds the nearest points."""
        return KDTree(self.points)

    @cached_property
    def spacing(self) -> float:
        """The median over the points of the mean distance to the five nearest."""
        return float(np.median(self._near[0][:, 1:6].mean(axis=1)))

    @cached_property
    def average(self) -> sparse.csr_array:
        """(s, s) matrix that averages values (s, ...) over the neighbours of each point on its side of a sheet."""
        distance, near = self._near
        weight = np.exp(-((distance / (WIDTH * self.spacing)) ** 2))
        weight[np.einsum("nkj,nj->nk", self.normals[near], self.normals) < OTHER_SIDE] = 0
        ends, count = np.arange(0, near.size + 1, near.shape[1]), len(self.points)
        one_way = sparse.csr_array((weight.ravel(), near.ravel(), ends), shape=(count, count))
        both = one_way.maximum(one_way.T)
        return sparse.csr_array(sparse.diags_array(1 / both.sum(axis=1)) @ both)

    @cached_property
    def _near(self) -> tuple[np.ndarray, np.ndarray]:
        return nearest(self.tree, self.points, NEIGHBOURS + 1)

    def smoothed(self, values: np.ndarray, length: float) -> np.ndarray:
        """Values (s,) averaged over the surface, about as by a Gaussian of a deviation of `length`."""
        for _ in range(round((length / self.spacing) ** 2)):
            values = self.average @ values
        return values

    def interpolation(self, positions: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(ids (n, 4), weights (n, 4)) of the points whose mean is the value at positions (n, 3) with normals (n, 3).

        Nearer points, and those that face the same way, weigh more.
        """
        distance, near = nearest(self.tree, positions, NEAREST)
        alike = np.einsum("nkj,nj->nk", self.normals[near], normals)
        weights = (alike + TURNED).clip(0.01) / (distance + 1e-4) ** 2
        return near, weights / weights.sum(axis=1, keepdims=True)


def nearest(tree: KDTree, positions: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(distances (n, k), ids (n, k)) of the nearest of a tree's points; k is less than count where it has fewer."""
    near = tree.query(positions, min(count, tree.n))
    distance, ids = (np.reshape(one, (len(positions), -1)) for one in near)
    return distance, ids

"""Points spread evenly over a surface, which stand for it whatever its triangles are."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.spatial import KDTree

from stages.kit import Mesh
from stages.kit.mesh import unit
from stages.kit.rng import rng
from stages.kit.surface_samples import sample_surface

COUNT = 15_000  # about as many points: fewer lose detail such as eyes, more cost time
DRAWN = 4  # points drawn for each that is kept: the mean of a cell has less noise than one point
CELL = 1.08  # side of a cell, in units of the distance of evenly spread points; leaves about COUNT cells
SMALLEST = 2.0**-19  # side of a cell: a smaller one, of a mesh with next to no area, has no number of its own
ONE_SIDE = 0.15  # length of a cell's mean normal below which two sides of a sheet are in it: one point stands for it
NEAREST = 4  # points that a value on the surface is interpolated from
NEIGHBOURS = 16  # points that a point is averaged with
WIDTH = 1.6  # of the Gaussian of that average, in units of the spacing
OTHER_SIDE = -0.2  # cosine between two normals below which points lie on two sides of a sheet
ROUGH = 0.1  # one minus the cosine of a normal and its neighbours' mean: the median of the roughest of 33 clean objects
MOST_STEPS = 8  # of denoising
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


def samples_of_mesh(mesh: Mesh, count: int = COUNT) -> Samples:
    """The Samples of a normalised mesh whose faces are oriented; the same at every call.

    Raises ValueError for a mesh without area.
    """
    draws = rng(0, "glance").random((3, DRAWN * count))
    shares = (np.arange(draws.shape[1]) + draws[0]) / draws.shape[1]
    points, faces, _ = sample_surface(mesh, shares, draws[1:])
    return _even(points, mesh.face_normals[faces], float(mesh.face_areas.sum()), count)


def samples_of_points(points: np.ndarray, normals: np.ndarray, count: int = COUNT) -> Samples:
    """The Samples of a normalised point cloud (n, 3) with unit normals (n, 3), outwards.

    Raises ValueError for fewer than two points at different places.
    """
    apart = KDTree(points).query(points, 2)[0][:, 1]
    area = float((apart**2).sum()) * np.pi / 2  # of evenly spread points
    if not area > 0:
        raise ValueError("the points of a cloud must lie at different places")
    return _even(points, normals, area, min(count, max(len(points) // 2, 1)))


def _even(points, normals, area, count):
    """The Samples of drawn points: one a cell of a grid, at the mean of the points in it."""
    side = max(CELL * np.sqrt(area / count), SMALLEST)
    key = np.floor(points / side).astype(np.int64) @ [1 << 42, 1 << 21, 1]
    _, cell, size = np.unique(key, return_inverse=True, return_counts=True)
    first = np.zeros(len(size), dtype=np.int64)
    first[cell[::-1]] = np.arange(len(cell))[::-1]
    means = [np.stack([np.bincount(cell, one) for one in values.T], axis=1) / size[:, None]
             for values in (points, normals)]  # fmt: skip
    plain = np.linalg.norm(means[1], axis=1, keepdims=True) > ONE_SIDE
    return _denoised(Samples(np.where(plain, means[0], points[first]), unit(np.where(plain, means[1], normals[first]))))


def _denoised(samples):
    """The Samples averaged over their neighbours until their normals agree as they do on surfaces without noise."""
    for _ in range(MOST_STEPS):
        average = samples.average
        normals = average @ samples.normals
        if np.median(1 - np.einsum("ij,ij->i", normals, samples.normals)) <= ROUGH:
            break
        samples = Samples(average @ samples.points, unit(normals))
    return samples

"""Samples drawn from a mesh or a cloud: as even, and as smooth, as its surface would be without noise."""

import numpy as np
from scipy.spatial import KDTree

from stages.kit import Mesh
from stages.kit.mesh import unit
from stages.kit.rng import rng
from stages.kit.surface_samples import sample_surface

from .denoise import denoised
from .samples import Samples

COUNT = 15_000  # about as many points: fewer lose detail such as eyes, more cost time
DRAWN = 4  # points drawn for each that is kept: the mean of a cell has less noise than one point
CELL = 1.08  # side of a cell, in units of the distance of evenly spread points; leaves about COUNT cells
SMALLEST = 2.0**-19  # side of a cell: a smaller one, of a mesh with next to no area, has no number of its own
ONE_SIDE = 0.15  # length of a cell's mean normal below which two sides of a sheet are in it: one point stands for it


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
    return denoised(Samples(np.where(plain, means[0], points[first]), unit(np.where(plain, means[1], normals[first]))))

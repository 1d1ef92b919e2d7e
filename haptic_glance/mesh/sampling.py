"""Points on the surface of a mesh, uniform by area, compiled by numba."""

import math
from typing import TYPE_CHECKING

import numpy as np

from haptic_glance.base.jit import cached_njit

if TYPE_CHECKING:
    from .mesh import Mesh

kernel = cached_njit()


def sample_surface(
    mesh: "Mesh", shares: np.ndarray, draws: np.ndarray, areas: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(points (k, 3), faces (k,) i8, barycentric weights (k, 3)) of one point at each share of the surface.

    shares (k,) in 0..1, ascending: each point lies in the face in which the running sum of the areas, in the order of
    the faces, passes that share of the total. Shares drawn one in each of k equal slices give each face its number of
    points to within one (stratified sampling). draws (2, k) in 0..1: where in the face, see `points_in_faces`. areas
    (m,): the weight of each face, None for its area. Raises ValueError for a mesh without area.
    """
    total = np.cumsum(mesh.face_areas if areas is None else areas)
    if not (len(total) and total[-1] > 0):
        raise ValueError("cannot sample a mesh without area")
    faces = _faces_at(total, shares * total[-1])
    points, weights = points_in_faces(mesh, faces, draws)
    return points, faces, weights


BITS = 10  # of a coordinate on the curve
ROUNDING = 1e-6  # smaller differences of steps along a coordinate are rounding


def along_curve(points: np.ndarray) -> np.ndarray:
    """(n,) i8 numbers of the cells of points (n, 3) along a curve that fills space: near points have near numbers.

    Source: Morton, A computer oriented geodetic data base, IBM 1966.
    """
    inside = points - points.min(axis=0, initial=np.inf)
    steps = (inside / max(inside.max(initial=0), 1e-12) * (2**BITS - 1) + ROUNDING).astype(np.int64)
    return np.asarray(sum((steps[:, axis] >> bit & 1) << (3 * bit + axis) for bit in range(BITS) for axis in range(3)))


def points_in_faces(mesh: "Mesh", faces: np.ndarray, draws: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(points (k, 3), barycentric weights (k, 3)), uniform in faces (k,) for uniform draws (2, k) in 0..1.

    Source: Osada, Funkhouser, Chazelle and Dobkin, Shape distributions, ACM TOG 21(4), 2002, eq. 1.
    """
    return _points(mesh.vertices, mesh.faces, faces, draws)


@kernel
def _faces_at(total, sums):
    """(k,) the first face at which the running sum total (m,) exceeds each of the ascending sums (k,)."""
    faces, f = np.empty(len(sums), dtype=np.int64), 0
    for i in range(len(sums)):
        while f < len(total) - 1 and total[f] <= sums[i]:
            f += 1
        faces[i] = f
    return faces


@kernel
def _points(vertices, faces, owners, draws):
    points, weights = np.empty((len(owners), 3)), np.empty((len(owners), 3))
    for i in range(len(owners)):
        root = math.sqrt(draws[0, i])
        weights[i, 0], weights[i, 1], weights[i, 2] = 1 - root, root * (1 - draws[1, i]), root * draws[1, i]
        a, b, c = faces[owners[i], 0], faces[owners[i], 1], faces[owners[i], 2]
        for axis in range(3):
            at_a, at_b, at_c = vertices[a, axis], vertices[b, axis], vertices[c, axis]
            points[i, axis] = weights[i, 0] * at_a + weights[i, 1] * at_b + weights[i, 2] * at_c
    return points, weights

"""Positions on the surface that need not be vertices."""

import numpy as np
from numpy.typing import ArrayLike

from stages.kit import Mesh
from stages.kit.extras import from_extra
from stages.kit.mesh import unit

from .frame import CANCELLED, mean_vertex_normals
from .surface import Surface, as_surface

MAX_OFFSET = 0.01  # of the mesh's diagonal: a point farther from the surface is an error
EDGE_WEIGHT = 1e-6  # weight of a corner, below which a position is on the opposite edge


def snap_to_surface(
    surface: Mesh | Surface, points: ArrayLike, tolerance: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """(positions (k, 3), normals (k, 3)): the positions on the surface nearest to points (k, 3), in units of the mesh.

    A normal is the unweighted average of the unit normals of the faces at the position (T4.3.1): inside a face its own,
    on an edge that of the faces along it, at a vertex that of `sensor_normals`.
    Raises ValueError that names the first point more than `tolerance` units off the surface (by default a hundredth of
    the mesh's diagonal), or the first position at which the faces cancel out.
    """
    mesh = as_surface(surface).mesh
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise ValueError(f"points must be finite and have shape (k, 3), got shape {points.shape}")
    if len(points) == 0:
        return points, points.copy()
    distances_off, face, weights = _closest(mesh, points)
    tolerance = MAX_OFFSET * mesh.diagonal if tolerance is None else tolerance
    if not tolerance >= 0:
        raise ValueError(f"tolerance must be 0 or more units, got {tolerance}")
    outside = np.flatnonzero(distances_off > tolerance)
    if len(outside):
        raise ValueError(
            f"point {points[outside[0]].tolist()} is off the mesh: its surface is {distances_off[outside[0]]:.4g} away "
            f"(the tolerance is {tolerance:.4g}); give a point on the surface, or a larger tolerance"
        )
    positions = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[face]])
    average = _mean_normals(mesh, face, weights > 0)
    bad = np.flatnonzero(np.linalg.norm(average, axis=1) <= CANCELLED)
    if len(bad):
        raise ValueError(f"the surface has no normal at {positions[bad[0]].tolist()}: its faces cancel out there")
    return positions, unit(average)


def _closest(mesh, points):
    """(distances (k,), faces (k,), corner weights (k, 3)) of the nearest positions."""
    with from_extra():
        import point_cloud_utils

    twice = np.concatenate([points, points[:1]])  # point_cloud_utils 0.34 misreads an array of a single point
    distances_off, face, weights = point_cloud_utils.closest_points_on_mesh(twice, mesh.vertices, mesh.faces)
    weights = np.where(weights[:-1] > EDGE_WEIGHT, weights[:-1], 0.0)
    return distances_off[:-1], face[:-1].astype(np.int64), weights / weights.sum(axis=1, keepdims=True)


def _mean_normals(mesh, face, at_corner):
    """(k, 3) mean unit normals at positions on faces (k,); at_corner (k, 3): the corners that a position depends on."""
    average, count = mesh.face_normals[face], at_corner.sum(axis=1)
    at_vertex, on_edge = count == 1, np.flatnonzero(count == 2)
    average[at_vertex] = mean_vertex_normals(mesh)[mesh.faces[face[at_vertex]][at_corner[at_vertex]]]
    if len(on_edge):
        corners = np.sort(mesh.faces, axis=1)[:, [[0, 1], [0, 2], [1, 2]]]
        keys = (corners[..., 0] * len(mesh.vertices) + corners[..., 1]).ravel()
        ends = np.sort(mesh.faces[face[on_edge]][at_corner[on_edge]].reshape(-1, 2), axis=1)
        wanted, back = np.unique(ends[:, 0] * len(mesh.vertices) + ends[:, 1], return_inverse=True)
        slot = np.searchsorted(wanted, keys).clip(max=len(wanted) - 1)
        along = np.flatnonzero(wanted[slot] == keys)
        total = np.zeros((len(wanted), 3))
        np.add.at(total, slot[along], mesh.face_normals[along // 3])
        average[on_edge] = total[back]
    return average

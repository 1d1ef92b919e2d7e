"""Places on the surface: where an array can stand that is not at a vertex."""

import numpy as np
import point_cloud_utils

from stages.kit.mesh import unit

from .frame import CANCELLED, vertex_averages
from .surface import ready

OFF = 0.01  # of the mesh's diagonal: a point farther from the surface is not meant to be on it
ON = 1e-6  # weight of a corner below which a place is on the edge across from it


def place(surface, points, tolerance=None):
    """(positions (k, 3), normals (k, 3)): the places on the surface nearest to points (k, 3), in units of the mesh.

    A normal is the average of the unit normals of the faces at the place, each counted alike (T4.3.1): inside a face
    its own, on an edge that of the faces along it, at a vertex what `sensor_normals` says.
    Raises ValueError naming the first point that is more than `tolerance` units off the surface (by default a
    hundredth of the mesh's diagonal), or where the faces at a place cancel out.
    """
    mesh = ready(surface).mesh
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise ValueError(f"points must be finite and have shape (k, 3), got shape {points.shape}")
    if len(points) == 0:
        return points, points.copy()
    far, face, weights = _nearest(mesh, points)
    tolerance = OFF * mesh.diagonal if tolerance is None else tolerance
    if not tolerance >= 0:
        raise ValueError(f"tolerance must be 0 or more units, got {tolerance}")
    off = np.flatnonzero(far > tolerance)
    if len(off):
        raise ValueError(
            f"point {points[off[0]].tolist()} is off the mesh: its surface is {far[off[0]]:.4g} away, and at most "
            f"{tolerance:.4g} is taken for a place on it; give a point on the surface, or a larger tolerance"
        )
    positions = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[face]])
    average = _averages(mesh, face, weights > 0)
    bad = np.flatnonzero(np.linalg.norm(average, axis=1) <= CANCELLED)
    if len(bad):
        raise ValueError(f"the surface has no normal at {positions[bad[0]].tolist()}: its faces cancel out there")
    return positions, unit(average)


def _nearest(mesh, points):
    """(distances (k,), faces (k,), corner weights (k, 3)) of the nearest places."""
    twice = np.concatenate([points, points[:1]])  # point_cloud_utils 0.34 misreads an array of a single point
    far, face, weights = point_cloud_utils.closest_points_on_mesh(twice, mesh.vertices, mesh.faces)
    weights = np.where(weights[:-1] > ON, weights[:-1], 0.0)
    return far[:-1], face[:-1].astype(np.int64), weights / weights.sum(axis=1, keepdims=True)


def _averages(mesh, face, on):
    """(k, 3) means of the unit normals of the faces at places that lie on corners `on` (k, 3) of faces (k,)."""
    average, count = mesh.face_normals[face], on.sum(axis=1)
    at_vertex, on_edge = count == 1, np.flatnonzero(count == 2)
    average[at_vertex] = vertex_averages(mesh)[mesh.faces[face[at_vertex]][on[at_vertex]]]
    if len(on_edge):
        corners = np.sort(mesh.faces, axis=1)[:, [[0, 1], [0, 2], [1, 2]]]
        keys = (corners[..., 0] * len(mesh.vertices) + corners[..., 1]).ravel()
        ends = np.sort(mesh.faces[face[on_edge]][on[on_edge]].reshape(-1, 2), axis=1)
        wanted, back = np.unique(ends[:, 0] * len(mesh.vertices) + ends[:, 1], return_inverse=True)
        slot = np.searchsorted(wanted, keys).clip(max=len(wanted) - 1)
        along = np.flatnonzero(wanted[slot] == keys)
        total = np.zeros((len(wanted), 3))
        np.add.at(total, slot[along], mesh.face_normals[along // 3])
        average[on_edge] = total[back]
    return average

"""Parallel rays from outside a mesh along the axis of a viewpoint, for tests of visibility without an image."""

import numpy as np

from stages.kit import Mesh, Viewpoint

OUTSIDE = 0.6  # distance of a plane from the centre of a mesh of diagonal one, which never touches the mesh


def scaled_to_unit_diagonal(mesh: Mesh) -> Mesh:
    """The mesh with its bounding box centred at the origin and a diagonal of one, so that lengths are shares of it.

    Vertices in no face do not count. Raises ValueError for a mesh without area.
    """
    used = mesh.vertices[np.unique(mesh.faces)]
    size = np.linalg.norm(np.ptp(used, axis=0)) if len(used) else 0.0
    if size > 0:
        surface = Mesh((mesh.vertices - (used.min(axis=0) + used.max(axis=0)) / 2) / size, mesh.faces)
        if surface.face_areas.sum() > 0:
            return surface
    raise ValueError("the mesh has no visible surface: it needs at least one face with an area")


def sightlines(points: np.ndarray, viewpoint: Viewpoint) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rays from outside through points (k, 3) of a unit-diagonal mesh: origins, directions (k, 3), distances (k,)."""
    back = viewpoint.axes[2]
    distances = OUTSIDE - points @ back
    return points + distances[:, None] * back, np.broadcast_to(-back, points.shape), distances

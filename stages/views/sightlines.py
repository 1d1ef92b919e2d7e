"""Parallel rays from outside a mesh along the axis of a viewpoint, for what needs no picture."""

import numpy as np

from stages.kit import Mesh

OUTSIDE = 0.6  # a plane so far from the middle of a mesh of diagonal one never touches it


def unit_surface(mesh):
    """The mesh with the middle of its bounding box at the origin and a diagonal of one; faces as they are.

    Distances below are then shares of the diagonal. Vertices in no face do not count. Raises ValueError for a mesh
    without area: there is nothing to see.
    """
    used = mesh.vertices[np.unique(mesh.faces)]
    size = np.linalg.norm(np.ptp(used, axis=0)) if len(used) else 0.0
    if size > 0:
        surface = Mesh((mesh.vertices - (used.min(axis=0) + used.max(axis=0)) / 2) / size, mesh.faces)
        if surface.face_areas.sum() > 0:
            return surface
    raise ValueError("the mesh has no surface to look at: it needs at least one face with an area")


def sightlines(points, viewpoint):
    """Rays from outside through points (k, 3) of a unit_surface: origins, directions (k, 3) and distances (k,)."""
    back = viewpoint.axes[2]
    distances = OUTSIDE - points @ back
    return points + distances[:, None] * back, np.broadcast_to(-back, points.shape), distances

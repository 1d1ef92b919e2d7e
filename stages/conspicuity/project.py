"""The vertex that a place on the surface belongs to (T3.2.6)."""

import numpy as np

from stages.kit import Mesh


def nearest_corners(mesh: Mesh, faces: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """(k,) i8: the corner of each face (k,) nearest to a position (k, 3).

    T3.2.6 takes the vertex nearest to the centroid of the face, whichever point of the face was seen. The corner
    nearest to the point itself is never farther away, and on slivers, common in CAD meshes, it is much nearer.
    """
    corners = mesh.faces[faces]
    distance = ((mesh.vertices[corners] - positions[:, None]) ** 2).sum(axis=2)
    return corners[np.arange(len(corners)), distance.argmin(axis=1)]

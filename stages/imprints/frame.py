"""The normal of the array's plane at a vertex."""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from stages.kit import Mesh
from stages.kit.mesh import corner_sum, unit

CANCELLED = 1e-6  # length below which an average of unit normals is rounding error


def sensor_normals(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """(k, 3) unit normals of the array's plane at vertices (k,): the average of the unit normals of the faces around.

    Every face around the vertex has the same weight, as in T4.3.1. Weights by area (`Mesh.vertex_normals`) or by angle
    tilt the plane where the faces differ in size. Faces without area have no normal and do not count.
    Raises ValueError that names the first vertex that is not in the mesh, is in no face, or whose faces cancel out.
    """
    vertices = check_vertices(mesh, vertices)
    average = mean_vertex_normals(mesh)[vertices]
    bad = np.flatnonzero(np.linalg.norm(average, axis=1) <= CANCELLED)
    if len(bad):
        raise ValueError(
            f"vertex {vertices[bad[0]]} has no normal: it is in no face with area, or its faces cancel out; "
            "leave it out (stages.imprints.touchable tells which vertices can be touched)"
        )
    return unit(average)


def touchable(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """(k,) boolean: the vertices (k,) at which the array has a normal, so that it can be pressed on the object."""
    return np.linalg.norm(mean_vertex_normals(mesh)[check_vertices(mesh, vertices)], axis=1) > CANCELLED


def check_vertices(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """The vertex ids as (k,) i8; raises ValueError if they are not integers or not in the mesh."""
    vertices = np.asarray(vertices)
    if vertices.ndim != 1:
        raise ValueError(f"vertices must have shape (k,), got {vertices.shape}")
    if vertices.size and not np.issubdtype(vertices.dtype, np.integer):
        raise ValueError(f"vertices must be whole numbers (vertex ids), got {vertices.dtype}")
    vertices = vertices.astype(np.int64)
    outside = vertices[(vertices < 0) | (vertices >= len(mesh.vertices))]
    if len(outside):
        raise ValueError(f"vertex {outside[0]} is not in the mesh: its vertices are 0..{len(mesh.vertices) - 1}")
    return vertices


@lru_cache(maxsize=4)  # used at every touch
def mean_vertex_normals(mesh: Mesh) -> np.ndarray:
    """(n, 3) means of the unit normals of the faces around each vertex; zero at a vertex in no face."""
    solid = mesh.face_areas > 0
    total = corner_sum(mesh, np.repeat(mesh.face_normals[:, None], 3, axis=1))
    count = corner_sum(mesh, np.repeat(solid[:, None], 3, axis=1))
    return total / np.maximum(count, 1)[:, None]

"""How the array stands on the object: its normal and the directions of its rows and columns."""

from functools import lru_cache

import numpy as np

from stages.kit.mesh import corner_sum, unit

POLE = 0.95  # |z| of a normal above which "up" is no usable direction on the plane: within 18 degrees of the pole
CANCELLED = 1e-6  # shorter than this, an average of unit normals is rounding error and has no direction


def sensor_normals(mesh, vertices):
    """(k, 3) unit normals of the array's plane at vertices (k,): the average of the unit normals of the faces around.

    Every face around the vertex counts alike, as in T4.3.1. Weighting by area (`Mesh.vertex_normals`) or by angle
    tilts the plane where the faces differ in size. Faces without area have no normal and do not count.
    Raises ValueError naming the first vertex that is not in the mesh, is in no face, or whose faces cancel out.
    """
    vertices = check_vertices(mesh, vertices)
    average = vertex_averages(mesh)[vertices]
    bad = np.flatnonzero(np.linalg.norm(average, axis=1) <= CANCELLED)
    if len(bad):
        raise ValueError(
            f"vertex {vertices[bad[0]]} has no normal: it is in no face with area, or its faces cancel out; "
            "leave it out (stages.imprints.touchable says which vertices can be touched)"
        )
    return unit(average)


def touchable(mesh, vertices):
    """(k,) boolean: the vertices (k,) at which the array has a normal and so can be pressed on the object."""
    return np.linalg.norm(vertex_averages(mesh)[check_vertices(mesh, vertices)], axis=1) > CANCELLED


def sensor_axes(normals):
    """(k, 3, 3) rows right, up, normal of arrays with unit normals (k, 3), seen from outside onto the object.

    Up is +z projected on the plane, so that the array keeps upright wherever it touches; within 18 degrees of the
    poles, where that has no stable direction, +y takes its place. The thesis is silent on the array's turn about its
    normal. The axes depend on the normal alone: neither on the order of the vertices nor on that of the faces.
    """
    normals = np.asarray(normals, dtype=np.float64)
    if normals.ndim != 2 or normals.shape[1] != 3:
        raise ValueError(f"normals must have shape (k, 3), got {normals.shape}")
    polar = np.abs(normals[:, 2:]) > POLE
    towards = np.where(polar, [[0.0, 1.0, 0.0]], [[0.0, 0.0, 1.0]])
    up = unit(towards - np.sum(towards * normals, axis=1, keepdims=True) * normals)
    return np.stack([np.cross(up, normals), up, normals], axis=1)


def check_vertices(mesh, vertices):
    """The vertex ids as (k,) i8; ValueError where they are no whole numbers or not in the mesh."""
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


@lru_cache(maxsize=4)  # asked for at every touch
def vertex_averages(mesh):
    """(n, 3) means of the unit normals of the faces around each vertex; zero at a vertex in no face."""
    solid = mesh.face_areas > 0
    total = corner_sum(mesh, np.repeat(mesh.face_normals[:, None], 3, axis=1))
    count = corner_sum(mesh, np.repeat(solid[:, None], 3, axis=1))
    return total / np.maximum(count, 1)[:, None]

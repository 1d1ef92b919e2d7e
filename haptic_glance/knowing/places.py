"""Places of the array on a mesh: a vertex where one is near, else the point itself with the normal of its face."""

import numpy as np

from stages.imprints import Surface
from stages.imprints.frame import CANCELLED, mean_vertex_normals
from stages.imprints.user_mesh import Places
from stages.kit.mesh import unit
from stages.kit.surface_samples import sample_surface

NEAR = 0.01  # units, one cell of the default array: within it a point belongs to its vertex


def sample_places(surface: Surface, count: int, random: np.random.Generator) -> Places:
    """Places of `count` points, drawn uniformly by area; those whose faces have no normal are left out.

    Raises ValueError for a mesh without area.
    """
    shares = (np.arange(count) + random.random(count)) / count  # one in each of `count` equal parts of the surface
    points, faces, _ = sample_surface(surface.mesh, shares, random.random((2, count)))
    return place_at(surface, points, faces)


def place_at(surface: Surface, points: np.ndarray, faces: np.ndarray) -> Places:
    """Places of points (k, 3) that lie in faces (k,).

    A point within NEAR of a corner of its face is moved to this vertex, with the normal that `press` has there. A
    single face of a fine scan is no guide to how an array lies on it. On a large face the normal is the face's own.
    """
    mesh, rows = surface.mesh, np.arange(len(points))
    corners = mesh.faces[faces]
    distances = np.linalg.norm(mesh.vertices[corners] - points[:, None], axis=2)
    nearest = distances.argmin(axis=1)
    vertices = corners[rows, nearest]
    averages = mean_vertex_normals(mesh)[vertices]
    at_vertex = (distances[rows, nearest] <= NEAR) & (np.linalg.norm(averages, axis=1) > CANCELLED)
    return Places(
        np.where(at_vertex, vertices, -1),
        np.where(at_vertex[:, None], mesh.vertices[vertices], points),
        np.where(at_vertex[:, None], unit(averages), mesh.face_normals[faces]),
    )

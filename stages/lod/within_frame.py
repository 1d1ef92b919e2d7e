"""Meshes drawn smaller together where one of them reaches beyond the picture."""

import numpy as np

from stages.kit import Mesh
from stages.kit.camera import DISTANCE, VIEW_ANGLE

FITS = 0.999 * DISTANCE * np.tan(np.radians(VIEW_ANGLE) / 2)  # radius that fills the rows, less 0.1 % for rounding


def within_frame(meshes):
    """(list of Meshes, scale): all shrunk about the origin by one scale, at most 1, so that no picture crops any.

    With few faces the vertices stand far outside a round surface, since its facets cut through it. A scale of 1 hands
    the meshes back as they are; vertices in no face do not count.
    """
    reach = max(np.linalg.norm(mesh.vertices[np.unique(mesh.faces)], axis=1).max(initial=0.0) for mesh in meshes)
    if reach <= FITS:
        return list(meshes), 1.0
    scale = float(FITS / reach)
    return [Mesh(scale * mesh.vertices, mesh.faces, mesh.colors, mesh.texture) for mesh in meshes], scale

"""Meshes scaled down together where one of them exceeds the picture."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stages.kit import Mesh
from stages.kit.camera import DISTANCE, VIEW_ANGLE

FITS = 0.999 * DISTANCE * np.tan(np.radians(VIEW_ANGLE) / 2)  # radius that fills the rows, less 0.1 % for rounding


def within_frame(meshes: Sequence[Mesh]) -> tuple[list[Mesh], float]:
    """(list of Meshes, scale): all scaled about the origin by one factor, at most 1, so that no picture crops any.

    With few faces the vertices lie far outside a round surface, since the facets cut through it. At a scale of 1 the
    meshes are returned unchanged; vertices in no face do not count.
    """
    radius = max(np.linalg.norm(mesh.vertices[np.unique(mesh.faces)], axis=1).max(initial=0.0) for mesh in meshes)
    if radius <= FITS:
        return list(meshes), 1.0
    scale = float(FITS / radius)
    return [replace(mesh, vertices=scale * mesh.vertices) for mesh in meshes], scale

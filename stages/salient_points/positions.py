"""The position of a vertex as its saliency: the simplest rivals, and strong ones on human gaze."""

import numpy as np

from stages.conspicuity import facing
from stages.kit import Mesh
from stages.views import FOUR


def height(mesh: Mesh) -> np.ndarray:
    """(n,) height of each vertex: people look at the upper part of things."""
    return mesh.vertices[:, 2] - mesh.vertices[:, 2].min()


def centre_distance(mesh: Mesh) -> np.ndarray:
    """(n,) distance of each vertex to the centre of the bounding sphere."""
    return np.linalg.norm(mesh.vertices, axis=1)


def facing_viewer(mesh: Mesh) -> np.ndarray:
    """(n,) cosine between the normal and the view direction, averaged over the four views from the side."""
    return facing(mesh, FOUR).mean(axis=0)

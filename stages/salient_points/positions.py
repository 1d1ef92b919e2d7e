"""Where a place is, as if it were a saliency: the plainest rivals, and strong ones on human gaze."""

import numpy as np

from stages.conspicuity import facing
from stages.views import FOUR


def height(mesh):
    """How high each vertex is, (n,): people look at the upper part of things."""
    return mesh.vertices[:, 2] - mesh.vertices[:, 2].min()


def centre_distance(mesh):
    """How far each vertex is from the centre of the bounding sphere, (n,)."""
    return np.linalg.norm(mesh.vertices, axis=1)


def facing_viewer(mesh):
    """How squarely the four views from the side see each vertex on average, (n,)."""
    return facing(mesh, FOUR).mean(axis=0)

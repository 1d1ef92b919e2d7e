"""The model has fewer faces than the object."""

from functools import partial

import numpy as np

from stages.imprints import Surface, place, sensor_axes
from stages.lod import simplify

from .perturbation import Felt

SOFT = "enhanced-soft"  # of lod.methods: the error counts more where the object is salient


def coarse(touches, severity, draw, way):
    """The touches at the nearest places of a mesh of `severity` faces, made by a way of lod.methods.

    That of data/lod where there is one, else made here in the same manner. An object that has no more faces stays.
    """
    faces = int(severity)
    if len(touches.mesh.faces) <= faces:
        return Felt(touches.images)
    found = touches.levels.get(f"{way}_{faces}")
    mesh = simplify(touches.mesh, faces, weights=touches.saliency if way == SOFT else None) if found is None else found
    surface = Surface(mesh)
    positions, normals = place(surface, touches.positions, tolerance=np.inf)
    return Felt(touches.press(positions, sensor_axes(normals), surface))


plain = partial(coarse, way="qem")
salient_kept = partial(coarse, way=SOFT)

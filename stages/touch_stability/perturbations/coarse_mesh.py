"""The model has fewer faces than the object."""

from functools import partial

import numpy as np

from haptic_glance.lod import simplify
from haptic_glance.touch import Surface, sensor_axes, snap_to_surface

from ..touches import Touches
from .perturbation import PerturbedTouches

SOFT = "glance-soft"  # of lod.methods: errors have more weight where the object is salient


def touch_simplified(touches: Touches, severity: float, draw: int, way: str) -> PerturbedTouches:
    """The touches at the nearest positions on a mesh of `severity` faces, simplified by a method of lod.methods.

    The mesh is that of data/SET/lod if it exists, else it is simplified here in the same way. An object without more
    faces is unchanged.
    """
    faces = int(severity)
    if len(touches.mesh.faces) <= faces:
        return PerturbedTouches(touches.images)
    found = touches.levels.get(f"{way}_{faces}")
    mesh = simplify(touches.mesh, faces, weights=touches.saliency if way == SOFT else None) if found is None else found
    surface = Surface(mesh)
    positions, normals = snap_to_surface(surface, touches.positions, tolerance=np.inf)
    return PerturbedTouches(touches.press(positions, sensor_axes(normals), surface))


simplified = partial(touch_simplified, way="qem")
simplified_by_saliency = partial(touch_simplified, way=SOFT)

"""The directions of the rows and columns of an array on an object."""

import numpy as np
from numpy.typing import ArrayLike

from .axes import Axis, axis_named, to_z_up
from .mesh import unit

POLE = 0.95  # |z| of a normal above which +z has no stable projection on the plane: within 18 degrees of the pole


def sensor_axes(normals: ArrayLike, up: Axis = "z") -> np.ndarray:
    """(k, 3, 3) rows right, up, normal of arrays with unit normals (k, 3), seen from outside onto the object.

    up: the axis of the object that points up, a name or a vector; in what follows it is z. Up is +z projected on the
    plane, so that the array is upright everywhere. Within 18 degrees of the poles, where that has no stable direction,
    +y is projected. The thesis does not give the array's rotation about its normal. The axes depend on the normal
    alone, not on the order of vertices or faces.
    """
    normals = np.asarray(normals, dtype=np.float64)
    if normals.ndim != 2 or normals.shape[1] != 3:
        raise ValueError(f"normals must have shape (k, 3), got {normals.shape}")
    if len(wrong := np.flatnonzero(~(np.isfinite(normals).all(axis=1) & normals.any(axis=1)))):
        raise ValueError(f"normals must be finite and not zero, got {normals[wrong[0]]} at place {wrong[0]}")
    if (axis := axis_named(up)) != "z":
        return sensor_axes(normals @ to_z_up(axis).T) @ to_z_up(axis)
    polar = np.abs(normals[:, 2:]) > POLE
    towards = np.where(polar, [[0.0, 1.0, 0.0]], [[0.0, 0.0, 1.0]])
    upwards = unit(towards - np.sum(towards * normals, axis=1, keepdims=True) * normals)
    return np.stack([np.cross(upwards, normals), upwards, normals], axis=1)

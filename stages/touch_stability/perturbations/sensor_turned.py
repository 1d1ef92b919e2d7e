"""The sensor is not held upright: turned about its normal, or leaning."""

import numpy as np

from ..touches import about
from .perturbation import Felt, in_range


def sensor_turned(touches, severity, draw):
    """Each array turned about its normal by `severity` degrees, to the left or to the right."""
    in_range(severity, 0, 180, "the turn in degrees")
    side = touches.random("sensor_turned", draw).choice([-1, 1], len(touches.positions))
    return Felt(touches.press(axes=touches.axes @ about(touches.normals, side * severity).transpose(0, 2, 1)))


def sensor_leaning(touches, severity, draw):
    """Each array's normal `severity` degrees off the surface's, towards a random side; it stays on its place."""
    in_range(severity, 0, 60, "the lean in degrees")
    angle = touches.random("sensor_leaning", draw).uniform(0, 2 * np.pi, len(touches.positions))[:, None]
    axis = np.cos(angle) * touches.axes[:, 0] + np.sin(angle) * touches.axes[:, 1]
    degrees = np.full(len(axis), severity)
    return Felt(touches.press(axes=touches.axes @ about(axis, degrees).transpose(0, 2, 1)))

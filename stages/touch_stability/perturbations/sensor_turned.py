"""The sensor is not upright: rotated about its normal, or tilted."""

import numpy as np

from ..touches import Touches, rotations_about
from .perturbation import PerturbedTouches, check_range


def sensor_turned(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """Each array rotated about its normal by `severity` degrees, randomly to the left or to the right."""
    check_range(severity, 0, 180, "the turn in degrees")
    side = touches.random("sensor_turned", draw).choice([-1, 1], len(touches.positions))
    return PerturbedTouches(
        touches.press(axes=touches.axes @ rotations_about(touches.normals, side * severity).transpose(0, 2, 1))
    )


def sensor_leaning(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """Each array tilted by `severity` degrees from the surface's normal in a random direction, at the same place."""
    check_range(severity, 0, 60, "the lean in degrees")
    angle = touches.random("sensor_leaning", draw).uniform(0, 2 * np.pi, len(touches.positions))[:, None]
    axis = np.cos(angle) * touches.axes[:, 0] + np.sin(angle) * touches.axes[:, 1]
    degrees = np.full(len(axis), severity)
    return PerturbedTouches(touches.press(axes=touches.axes @ rotations_about(axis, degrees).transpose(0, 2, 1)))

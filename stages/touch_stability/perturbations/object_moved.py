"""The object is not as in training: rotated, tilted or of another size."""

import numpy as np

from haptic_glance.touch import sensor_axes

from ..touches import Touches, rotations_about
from .perturbation import PerturbedTouches, check_range

UP = np.array([0.0, 0.0, 1.0])


def object_turned(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """The object rotated about the vertical by `severity` degrees: the same places, the array upright."""
    check_range(severity, 0, 360, "the turn in degrees")
    return _turned(touches, rotations_about(UP, np.float64(severity)))


def object_tilted(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """The object tilted about a random horizontal axis by `severity` degrees; the places on it are the same."""
    check_range(severity, 0, 180, "the tilt in degrees")
    azimuth = touches.random("object_tilted", draw).uniform(0, 2 * np.pi)
    return _turned(touches, rotations_about(np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.float64(severity)))


def object_scaled(touches: Touches, severity: float, draw: int) -> PerturbedTouches:
    """The object `severity` times as large, touched by the same array: equivalent to a finer array on the original."""
    check_range(severity, 0.05, 20, "the scale")
    return PerturbedTouches(touches.press(pitch=touches.pitch / severity), severity * touches.positions)


def _turned(touches, rotation):
    """The touches after a rotation (3, 3) of the object, computed by the inverse rotation of the array."""
    images = touches.press(axes=sensor_axes(touches.normals @ rotation.T) @ rotation)
    return PerturbedTouches(images, touches.positions @ rotation.T)

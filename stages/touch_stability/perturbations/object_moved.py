"""The object stands otherwise than it was learned: turned, tilted or of another size."""

import numpy as np

from stages.imprints import sensor_axes

from ..touches import about
from .perturbation import Felt, in_range

UP = np.array([0.0, 0.0, 1.0])


def object_turned(touches, severity, draw):
    """The object turned about the vertical by `severity` degrees: the same places on it, the array upright as ever."""
    in_range(severity, 0, 360, "the turn in degrees")
    return _turned(touches, about(UP, np.float64(severity)))


def object_tilted(touches, severity, draw):
    """The object tilted about a random level axis by `severity` degrees: the same places on it."""
    in_range(severity, 0, 180, "the tilt in degrees")
    azimuth = touches.random("object_tilted", draw).uniform(0, 2 * np.pi)
    return _turned(touches, about(np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.float64(severity)))


def object_scaled(touches, severity, draw):
    """The object `severity` times as large, touched by the same array: as a finer one on the object as it was."""
    in_range(severity, 0.05, 20, "the scale")
    return Felt(touches.press(pitch=touches.pitch / severity), severity * touches.positions)


def _turned(touches, rotation):
    """What is felt after a rotation (3, 3) of the object: the array is put back with it, and the object stays."""
    images = touches.press(axes=sensor_axes(touches.normals @ rotation.T) @ rotation)
    return Felt(images, touches.positions @ rotation.T)

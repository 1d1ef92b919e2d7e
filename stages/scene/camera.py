"""A perspective camera on a path: what a person before a screen sees (the kit's is the thesis's orthographic)."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from stages.kit.mesh import unit


@dataclass(frozen=True)
class Camera:
    """Where a frame is taken from, in metres: eye and target (3,); angle, vertical in degrees; size, rows and columns.

    +z is up. Pixel centres lie at whole numbers. Raises ValueError for a camera that has no direction or looks straight
    up or down, and for an angle outside 1 to 170 degrees.
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    angle: float
    size: tuple[int, int]

    def __post_init__(self):
        along = np.subtract(self.target, self.eye)
        if not np.isfinite(along).all() or np.hypot(along[0], along[1]) <= 1e-6 * (1 + np.abs(along[2])):
            raise ValueError(f"a camera at {self.eye} cannot look at {self.target}: same place, or straight up or down")
        if not 1 <= self.angle <= 170:
            raise ValueError(f"the view angle is {self.angle} degrees: give the vertical one, from 1 to 170")
        if min(self.size) < 1:
            raise ValueError(f"a screen of {self.size[0]} x {self.size[1]} pixels shows nothing")

    @property
    def axes(self):
        """(3, 3) rows right, up, forward: the camera's axes in the world."""
        forward = unit(np.subtract(self.target, self.eye))
        right = unit(np.cross(forward, [0.0, 0.0, 1.0]))
        return np.array([right, np.cross(right, forward), forward])

    @property
    def focal(self):
        """Pixels that a metre takes at a depth of one metre; at depth d it takes focal / d."""
        return self.size[0] / (2 * np.tan(np.radians(self.angle) / 2))

    def project(self, points):
        """World points (k, 3) to (rows (k,), columns (k,), depths (k,)): pixels, and metres along the view axis."""
        right, up, depth = self.axes @ (np.asarray(points, dtype=np.float64) - self.eye).T
        far = np.where(depth > 0, depth, np.nan)
        h, w = self.size
        return (h - 1) / 2 - up / far * self.focal, (w - 1) / 2 + right / far * self.focal, depth

    def directions(self, rows, columns):
        """Directions (k, 3) of length one of the rays through pixels."""
        h, w = self.size
        right, up, forward = self.axes
        across = ((np.asarray(columns) - (w - 1) / 2) / self.focal)[:, None]
        down = (((h - 1) / 2 - np.asarray(rows)) / self.focal)[:, None]
        return unit(forward + across * right + down * up)


def fly(eyes, targets, frames, angle, size):
    """`frames` Cameras along keyframes: eyes and targets (k, 3), at equal times, joined by a smooth curve.

    The curve (Fritsch and Carlson 1980, monotone piecewise cubic) never swings out beyond its keyframes.
    Raises ValueError for no keyframe or no frame.
    """
    eyes, targets = (np.asarray(points, dtype=np.float64) for points in (eyes, targets))
    if eyes.ndim != 2 or eyes.shape[1:] != (3,) or eyes.shape != targets.shape or not len(eyes) or frames < 1:
        raise ValueError("a camera path needs a frame or more, and keyframes of an eye and a target, x, y, z each")
    if len(eyes) > 1:
        times = np.linspace(0, len(eyes) - 1, frames)
        eyes, targets = (PchipInterpolator(range(len(points)), points)(times) for points in (eyes, targets))
    else:
        eyes, targets = np.repeat(eyes, frames, axis=0), np.repeat(targets, frames, axis=0)
    return [Camera(tuple(eye), tuple(target), angle, tuple(size)) for eye, target in zip(eyes, targets, strict=True)]

"""A perspective camera on a path, as for a screen (the kit's camera is the thesis's orthographic one)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from stages.kit.mesh import unit


@dataclass(frozen=True)
class Camera:
    """The camera of one frame: eye and target (3,) in metres; vertical view angle in degrees; size, rows and columns.

    +z is up. Pixel centres lie at whole numbers. Raises ValueError for a camera that has no direction or renderings
    straight up or down, and for an angle outside 1 to 170 degrees.
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    angle: float
    size: tuple[int, int]

    def __post_init__(self) -> None:
        along = np.subtract(self.target, self.eye)
        if not np.isfinite(along).all():
            raise ValueError(f"a camera at {self.eye} that looks at {self.target} is nowhere: give finite numbers")
        if np.hypot(along[0], along[1]) <= 1e-6 * (1 + np.abs(along[2])):
            raise ValueError(f"a camera at {self.eye} cannot look at {self.target}: same place, or straight up or down")
        if not 1 <= self.angle <= 170:
            raise ValueError(f"the view angle is {self.angle} degrees: give the vertical one, from 1 to 170")
        if min(self.size) < 1:
            raise ValueError(f"a screen of {self.size[0]} x {self.size[1]} pixels shows nothing")

    @cached_property
    def axes(self) -> np.ndarray:
        """(3, 3) rows right, up, forward: the camera's axes in the world."""
        forward = unit(np.subtract(self.target, self.eye))
        right = unit(np.cross(forward, [0.0, 0.0, 1.0]))
        return np.array([right, np.cross(right, forward), forward])

    @property
    def focal(self) -> float:
        """Focal length: the pixels that one metre covers at a depth of one metre; at depth d it is focal / d."""
        return self.size[0] / (2 * np.tan(np.radians(self.angle) / 2))

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """World points (k, 3) to (rows (k,), columns (k,), depths (k,)): pixels, and metres along the view axis."""
        right, up, depth = self.axes @ (np.asarray(points, dtype=np.float64) - self.eye).T
        far = np.where(depth > 0, depth, np.nan)
        h, w = self.size
        return (h - 1) / 2 - up / far * self.focal, (w - 1) / 2 + right / far * self.focal, depth

    def directions(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Unit directions (k, 3) of the rays through pixels."""
        h, w = self.size
        right, up, forward = self.axes
        across = ((np.asarray(columns) - (w - 1) / 2) / self.focal)[:, None]
        down = (((h - 1) / 2 - np.asarray(rows)) / self.focal)[:, None]
        return unit(forward + across * right + down * up)


def fly(eyes: ArrayLike, targets: ArrayLike, frames: int, angle: float, size: Sequence[int]) -> list[Camera]:
    """`frames` Cameras along keyframes: eyes and targets (k, 3), at equal times, joined by a smooth curve.

    The curve (Fritsch and Carlson 1980, monotone piecewise cubic) does not overshoot its keyframes.
    Raises ValueError for no keyframe or no frame, and for keyframes that are not finite.
    """
    eye, target = np.asarray(eyes, dtype=np.float64), np.asarray(targets, dtype=np.float64)
    if eye.ndim != 2 or eye.shape[1:] != (3,) or eye.shape != target.shape or not len(eye) or frames < 1:
        raise ValueError("a camera path needs at least one frame, and keyframes with x, y, z of an eye and a target")
    if not (np.isfinite(eye).all() and np.isfinite(target).all()):
        raise ValueError("the keyframes of a camera path must be finite: an eye or a target holds NaN or infinity")
    if len(eye) > 1:
        times = np.linspace(0, len(eye) - 1, frames)
        eye, target = (PchipInterpolator(range(len(points)), points)(times) for points in (eye, target))
    else:
        eye, target = np.repeat(eye, frames, axis=0), np.repeat(target, frames, axis=0)
    screen = size[0], size[1]
    return [Camera(tuple(place), tuple(aim), angle, screen) for place, aim in zip(eye, target, strict=True)]

"""The thesis's virtual camera: orthographic, 10 units from the origin, view angle 6 degrees (T3.2.6)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

DISTANCE = 10.0  # camera to origin, in units of the mesh; T3.2.6
VIEW_ANGLE = 6.0  # degrees, over the rows of the image; T3.2.6


@dataclass(frozen=True)
class Viewpoint:
    """The place of the camera, which looks at the origin; +z is up.

    Parameters
    ----------
    azimuth : float
        Degrees from +x, counter-clockwise seen from +z.
    elevation : float
        Degrees above the horizon. At +-90 the image's up is the limit of the elevations below, so that the poles have
        no jump.
    roll : float
        Degrees by which the image turns counter-clockwise about the view axis.

    Raises
    ------
    ValueError
        For an angle that is not finite.

    Examples
    --------
    >>> from haptic_glance import Viewpoint
    >>> Viewpoint(azimuth=30, elevation=20).roll
    0.0
    """

    azimuth: float
    elevation: float
    roll: float = 0.0

    def __post_init__(self) -> None:
        if not np.isfinite([self.azimuth, self.elevation, self.roll]).all():
            angles = f"azimuth {self.azimuth}, elevation {self.elevation}, roll {self.roll}"
            raise ValueError(f"a viewpoint has finite angles in degrees, got {angles}")

    @property
    def name(self) -> str:
        """A short name for files and tables, for example `az120_el-45`."""
        name = f"az{self.azimuth:g}_el{self.elevation:g}"
        return name if self.roll == 0 else f"{name}_ro{self.roll:g}"

    @cached_property
    def axes(self) -> np.ndarray:
        """(3, 3): the camera's axes in the world, in rows: to the right, upwards, and from the origin to the camera."""
        az, el, roll = np.radians([self.azimuth, self.elevation, self.roll])
        back = np.array([np.cos(el) * np.cos(az), np.cos(el) * np.sin(az), np.sin(el)])
        right = np.array([-np.sin(az), np.cos(az), 0.0])
        up = np.cross(back, right)
        return np.array([np.cos(roll) * right - np.sin(roll) * up, np.sin(roll) * right + np.cos(roll) * up, back])


def pixels_per_unit(rows: int) -> float:
    """Image rows per unit of the mesh: 858.7 at 900 rows (T eq. 3.11)."""
    return rows / (2 * DISTANCE * np.tan(np.radians(VIEW_ANGLE) / 2))


def project(points: np.ndarray, viewpoint: Viewpoint, size: Sequence[int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """World points (k, 3) to image: (rows (k,), columns (k,), depths (k,)), fractional pixels and units.

    Pixel centres lie at whole numbers; depth is the distance from the camera's plane along the view axis.
    """
    h, w = size
    right, up, back = viewpoint.axes @ np.asarray(points, dtype=np.float64).T
    scale = pixels_per_unit(h)
    return (h - 1) / 2 - up * scale, (w - 1) / 2 + right * scale, DISTANCE - back


def pixel_rays(
    rows: np.ndarray, columns: np.ndarray, viewpoint: Viewpoint, size: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Rays through pixels: (origins (k, 3), directions (k, 3) of length one), the camera's plane to the object.

    Exact where T eq. 3.12 to 3.16 turn offsets into angles and back: in an orthographic camera every ray runs parallel
    to the view axis, so the offset itself is the answer.
    """
    right, up, back = viewpoint.axes
    x, y = screen_position(rows, columns, size)
    origins = DISTANCE * back + x[..., None] * right + y[..., None] * up
    return origins, np.broadcast_to(-back, origins.shape)


def screen_position(rows: np.ndarray, columns: np.ndarray, size: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
    """(to the right (k,), up (k,)) of the view axis, in units: where the rays of pixels meet the camera's plane."""
    h, w = size
    scale = pixels_per_unit(h)
    x = (np.asarray(columns, dtype=np.float64) - (w - 1) / 2) / scale
    return x, ((h - 1) / 2 - np.asarray(rows, dtype=np.float64)) / scale

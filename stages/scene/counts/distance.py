"""From pixels on a screen at a distance to an error on the surface, by perspective.

The thesis determined its distances by moving each object away in VRML until features seemed to disappear (T3.1.3). Here
the distance follows from the screen: an error on the surface is tolerated up to a number of pixels.
"""

import numpy as np
from numpy.typing import ArrayLike

ROWS, VIEW_ANGLE = 1080, 60.0  # a full-HD screen and a common view angle over its rows, in degrees


def focal_length(rows: int = ROWS, view_angle: float = VIEW_ANGLE) -> float:
    """The focal length in pixels, rows / (2 tan(view_angle / 2)): the size on the screen of one unit at distance one.

    Raises ValueError for fewer than one row or an angle outside 0 to 180 degrees.
    """
    if rows < 1 or not 0 < view_angle < 180:
        raise ValueError(f"a screen cannot have {rows} rows and a view angle of {view_angle} degrees")
    return float(rows / (2 * np.tan(np.radians(view_angle) / 2)))


def tolerated_error(tolerance: ArrayLike, distance: ArrayLike, focal: float | None = None) -> np.ndarray:
    """The surface error that `tolerance` pixels allow at a distance, in the unit of the distance; both may be arrays.

    With distances in bounding-box diagonals of the object it is comparable with Metro's errors. focal: `focal_length`.
    Raises ValueError for tolerances or distances that are not above zero.
    """
    tolerance, distance = np.asarray(tolerance, dtype=np.float64), np.asarray(distance, dtype=np.float64)
    for name, values in (("tolerance", tolerance), ("distance", distance)):
        if not np.isfinite(values).all() or (values <= 0).any():
            raise ValueError(f"{name} must be finite and above 0, got {values}")
    return tolerance * distance / (focal_length() if focal is None else focal)

"""From pixels on a screen at a distance to an error on the surface, by perspective.

The thesis found its distances by moving each object away in VRML until features seemed to disappear (T3.1.3). Here the
distance follows from the screen: an error on the surface is tolerated while it covers no more than so many pixels.
"""

import numpy as np

ROWS, VIEW_ANGLE = 1080, 60.0  # a full-HD screen and a common view angle over its rows, in degrees


def focal_length(rows=ROWS, view_angle=VIEW_ANGLE):
    """The focal length in pixels, rows / (2 tan(view_angle / 2)): what one unit at distance one covers on the screen.

    Raises ValueError for fewer than one row or an angle outside 0 to 180 degrees.
    """
    if rows < 1 or not 0 < view_angle < 180:
        raise ValueError(f"no screen has {rows} rows and a view angle of {view_angle} degrees")
    return float(rows / (2 * np.tan(np.radians(view_angle) / 2)))


def tolerated_error(tolerance, distance, focal=None):
    """The surface error that `tolerance` pixels allow at a distance, in the unit of the distance: both may be arrays.

    With distances in bounding-box diagonals of the object it compares with Metro's errors. focal: `focal_length`.
    Raises ValueError for tolerances or distances that are not above zero.
    """
    tolerance, distance = np.asarray(tolerance, dtype=np.float64), np.asarray(distance, dtype=np.float64)
    for name, values in (("tolerance", tolerance), ("distance", distance)):
        if not np.isfinite(values).all() or (values <= 0).any():
            raise ValueError(f"{name} must be finite and above 0, got {values}")
    return tolerance * distance / (focal_length() if focal is None else focal)

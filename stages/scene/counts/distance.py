"""From pixels on a screen at a distance to an error on the surface, by perspective.

The thesis determined its distances by moving each object away in VRML until features seemed to disappear (T3.1.3). Here
the distance follows from the screen: an error on the surface is tolerated up to a number of pixels.
"""

import numpy as np

ROWS, VIEW_ANGLE = 1080, 60.0  # a full-HD screen and a common view angle over its rows, in degrees


def focal_length(rows: int = ROWS, view_angle: float = VIEW_ANGLE) -> float:
    """The focal length in pixels, rows / (2 tan(view_angle / 2)): the size on the screen of one unit at distance one.

    Raises ValueError for fewer than one row or an angle outside 0 to 180 degrees.
    """
    if rows < 1 or not 0 < view_angle < 180:
        raise ValueError(f"a screen cannot have {rows} rows and a view angle of {view_angle} degrees")
    return float(rows / (2 * np.tan(np.radians(view_angle) / 2)))

"""The 62 candidate viewpoints in 18 sets of four perpendicular ones (T3.2.4).

The thesis gives 18 sets of four perpendicular viewpoints. Ten of the 72 are shared, so that 62 are distinct. It shows
them around an object (T figure 3.14a), but does not state the arrangement, which is derived here. There are six great
circles through the poles, 30 degrees apart, with twelve positions each, also 30 degrees apart. These twelve form
three squares, which start at 0, 30 and 60 degrees above the horizon: 6 x 3 = 18 sets. Each circle has one square with
both poles, so each pole is in six sets and 2 x 5 = 10 of the 72 are repeated. The 62 that remain are five parallels of
twelve viewpoints, and the two poles. T3.3.2 arranges its 218 viewpoints in the same way: nine parallels with a
viewpoint every 15 degrees, and the poles. The four principal views of T3.1.2 (+-z and +-y) are one of the sets.
"""

from stages.kit import Viewpoint

STEP = 30  # degrees between neighbours on a circle, and between circles
QUARTER = 90  # degrees between the views of a set


def on_circle(azimuth: float, angle: float) -> Viewpoint:
    """The Viewpoint `angle` degrees along the great circle from the horizon at `azimuth` through the pole.

    Images stay upright: beyond a pole the elevation decreases and the azimuth is the opposite one. At a pole the
    azimuth is 0 for every circle, so that each pole is one viewpoint.
    """
    angle = (angle + 180) % 360 - 180
    if abs(angle) > 90:
        azimuth, angle = azimuth + 180, (180 if angle > 0 else -180) - angle
    return Viewpoint(0 if abs(angle) == 90 else azimuth % 360, angle)


def _squares(shift):
    """18 tuples of four viewpoints, `shift` degrees further along the circle than those of the perpendicular sets."""
    return tuple(
        tuple(on_circle(azimuth, start + shift + QUARTER * k) for k in range(4))
        for azimuth in range(0, 180, STEP)
        for start in range(0, QUARTER, STEP)
    )


PERPENDICULAR_SETS = _squares(0)  # each in order along its circle
BETWEEN = _squares(
    QUARTER // 2
)  # BETWEEN[i][k] stands half-way from PERPENDICULAR_SETS[i][k] to the next view of set i
CANDIDATES = tuple(dict.fromkeys(viewpoint for views in PERPENDICULAR_SETS for viewpoint in views))

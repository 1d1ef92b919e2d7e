"""The 62 candidate viewpoints in 18 sets of four perpendicular ones (T3.2.4).

Given by the thesis: 18 sets of four perpendicular viewpoints, ten of the 72 shared, so that 62 are distinct, and a
picture of them around an object (T figure 3.14a). The arrangement is derived here, since no text states it: six great
circles through the poles, 30 degrees apart; on each, twelve places 30 degrees apart; these are three squares, begun
at 0, 30 and 60 degrees above the horizon. That makes 6 x 3 = 18 sets. Each circle has one square with both poles, so
the poles stand in six sets each, and 2 x 5 = 10 of the 72 are repetitions: 62 remain, five parallels of twelve
viewpoints and two poles. T3.3.2 builds its 218 viewpoints alike: nine parallels at every 15 degrees, and the poles.
The four principal views of T3.1.2 (+-z and +-y) are one of the sets.
"""

from stages.kit import Viewpoint

STEP = 30  # degrees between neighbours on a circle, and between circles
QUARTER = 90  # degrees between the views of a set


def on_circle(azimuth, angle):
    """The Viewpoint `angle` degrees along the great circle that rises from the horizon at `azimuth` over the top.

    Images stay upright: beyond a pole the elevation falls again and the azimuth is the opposite one. At a pole the
    azimuth is 0, whichever circle leads there, so that it is one viewpoint.
    """
    angle = (angle + 180) % 360 - 180
    if abs(angle) > 90:
        azimuth, angle = azimuth + 180, (180 if angle > 0 else -180) - angle
    return Viewpoint(0 if abs(angle) == 90 else azimuth % 360, angle)


def _squares(shift):
    """18 tuples of four viewpoints, each `shift` degrees further along its circle than the set's own."""
    return tuple(
        tuple(on_circle(azimuth, start + shift + QUARTER * k) for k in range(4))
        for azimuth in range(0, 180, STEP)
        for start in range(0, QUARTER, STEP)
    )


SETS = _squares(0)  # each in the order along its circle
BETWEEN = _squares(QUARTER // 2)  # BETWEEN[i][k] stands half-way from SETS[i][k] to the next view of set i
CANDIDATES = tuple(dict.fromkeys(viewpoint for views in SETS for viewpoint in views))

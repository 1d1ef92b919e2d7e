"""The viewpoints all round an object from which its pictures are taken (T3.3.2)."""

from stages.kit import Viewpoint


def sphere(parallels, azimuths):
    """Viewpoints on parallel circles and at both poles, (parallels x azimuths + 2) of them; the first view first.

    T3.3.2: nine circles, a picture at every 15 degrees, and the poles, so 218 = sphere(9, 24). The thesis does not say
    how the circles lie: here they are evenly apart, 18 degrees for nine. Raises ValueError for numbers without an
    equator or without three views a third of a turn apart on it, which `evaluated` names.
    """
    if parallels < 1 or parallels % 2 == 0:
        raise ValueError(f"fixation.parallels must be an odd number, one of them is the equator, got {parallels}")
    if azimuths < 3 or azimuths % 3:
        raise ValueError(f"fixation.azimuths must be a multiple of three, got {azimuths}")
    step = 180 / (parallels + 1)
    around = [Viewpoint(360 / azimuths * k, step * (row + 1) - 90) for row in range(parallels) for k in range(azimuths)]
    return (*around, Viewpoint(0, 90), Viewpoint(0, -90))


def evaluated(parallels, azimuths):
    """(3,) list: the numbers, within sphere, of the three views from the side, a third of a turn apart.

    The thesis judges at the three viewpoints of Lavoue's data, whose directions are not published with it.
    """
    return [parallels // 2 * azimuths + k * azimuths // 3 for k in range(3)]

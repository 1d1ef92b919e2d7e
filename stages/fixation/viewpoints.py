"""The viewpoints around an object from which its pictures are rendered (T3.3.2)."""

from haptic_glance.look.camera import Viewpoint


def viewpoint_sphere(parallels: int, azimuths: int) -> tuple[Viewpoint, ...]:
    """Viewpoints on parallel circles and at both poles, (parallels x azimuths + 2) of them; the first view first.

    T3.3.2: nine circles, a picture every 15 degrees, and the poles: viewpoint_sphere(9, 24) has 218. The thesis does
    not say where the circles are; here they are evenly spaced, by 18 degrees for nine. Raises ValueError for numbers
    without an equator, or without three views on it a third of a turn apart (see evaluated_views).
    """
    if parallels < 1 or parallels % 2 == 0:
        raise ValueError(f"fixation.parallels must be an odd number, one of them is the equator, got {parallels}")
    if azimuths < 3 or azimuths % 3:
        raise ValueError(f"fixation.azimuths must be a multiple of three, got {azimuths}")
    step = 180 / (parallels + 1)
    around = [Viewpoint(360 / azimuths * k, step * (row + 1) - 90) for row in range(parallels) for k in range(azimuths)]
    return (*around, Viewpoint(0, 90), Viewpoint(0, -90))


def evaluated_views(parallels: int, azimuths: int) -> list[int]:
    """The indices in viewpoint_sphere of three views on the equator, a third of a turn apart.

    The thesis evaluates at the three viewpoints of Lavoue's data, whose directions are not published with it.
    """
    return [parallels // 2 * azimuths + k * azimuths // 3 for k in range(3)]

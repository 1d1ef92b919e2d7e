"""Presses the pressure array on every object."""

from dataclasses import dataclass

from stages.engine.settings import REQUIRED, setting
from stages.salient_points import method_names


def _contact():
    from haptic_glance.touch.quasi_tangent import SENSORS

    return SENSORS


@dataclass
class Params:
    """Section `imprints` of params.yaml."""

    methods: list[str] = setting(
        REQUIRED,
        "of salient_points, at whose points the object is touched",
        names=method_names,
    )
    cells: list[int] = setting(REQUIRED, "rows and columns of the array; T4.3 has 16 x 16 and 32 x 32", least=1)
    pitch: float = setting(
        REQUIRED,
        "distance of neighbouring cells, in units of the object (its bounding sphere has radius 0.5)",
        above=0,
    )
    contact: str = setting(
        REQUIRED,
        "tangent: the array stands at the point; rigid: it rests on what it meets first; contours: T4.2.3.1",
        names=_contact,
    )

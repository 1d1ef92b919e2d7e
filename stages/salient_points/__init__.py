"""Finds the salient points of a data set."""

from collections.abc import Callable
from dataclasses import dataclass

from stages.engine.settings import REQUIRED, setting


def _selection():
    from haptic_glance.look.points.options import SELECTIONS

    return SELECTIONS


def method_names() -> Callable[[str], object]:
    """The function that refuses a name that no method of salient points has."""
    from haptic_glance.look.points.methods import method_named

    return method_named


@dataclass
class Params:
    """The methods that find the points, and their number."""

    methods: list[str] = setting(
        REQUIRED,
        "names of METHODS in haptic_glance/look/points/methods.py",
        names=method_names,
    )
    count: int = setting(60, "points (touches) an object and method", least=1)
    selection: str = setting(
        "suppression",
        "how points are taken from a map: suppression (T3.2.5) or centroid (T3.1.2)",
        names=_selection,
    )
    radius: float = setting(
        0.058,
        "least distance between points, in units: 50 pixels at 900 rows, the kernel of T3.2.1.3",
        above=0,
    )
    smoothing: float = setting(
        0.02,
        "length over which the saliency on the vertices is smooth, in units of the mesh",
        least=0,
    )

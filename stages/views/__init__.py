"""Renders the views of a data set."""

from collections.abc import Container
from dataclasses import dataclass, field

from haptic_glance.look.views.view import Material
from stages.engine.settings import setting

COLUMNS = {"viewpoint": "name of the viewpoint", "views": "how many views together, this one the last"}


def _renderer():
    from haptic_glance.look.views.renderer import resolve_renderer

    return resolve_renderer


def _background():
    from haptic_glance.look.views.view import BACKGROUNDS

    return BACKGROUNDS


def viewpoint_names() -> Container[str]:
    """Named sets of viewpoints."""
    from haptic_glance.look.views.viewpoints import VIEWPOINTS

    return VIEWPOINTS


@dataclass
class Params:
    """Section `views` of params.yaml."""

    viewpoints: str = setting(
        "twelve",
        "named set: twelve (T figure 3.2), principal (+-y and +-z, T3.1.2) or four (all round)",
        names=viewpoint_names,
    )
    size: list[int] = setting([900, 1200], "rows, columns of an image; the object spans 858.7 of 900 rows", least=1)
    renderer: str = setting(
        "raster",
        "raster (same bytes on every machine), pyrender (needs EGL) or auto",
        names=_renderer,
    )
    background: str = setting("black", "black (as in the thesis), grey or white", names=_background)
    compare_sets: bool = setting(
        True,
        "also measure how much of the surface the views see, and the fewest that see nearly all",
    )
    material: Material = field(
        default_factory=Material, metadata={"meaning": "how the surfaces reflect the light; matte by default"}
    )

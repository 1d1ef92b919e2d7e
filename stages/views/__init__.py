"""Renders the views of a data set."""

from dataclasses import dataclass, field

from haptic_glance.look.views.view import Material

COLUMNS = {"viewpoint": "name of the viewpoint", "views": "how many views together, this one the last"}


@dataclass
class Params:
    """Section `views` of params.yaml."""

    viewpoints: str  # named set: twelve (T figure 3.2), principal (+-y, +-z, T3.1.2) or four (all round)
    size: list[int]  # rows, columns of an image; the object spans 858.7 of 900 rows
    renderer: str  # raster (everywhere the same bytes), pyrender (needs EGL) or auto
    background: str  # black (as in the thesis), grey or white
    compare_sets: bool  # also measure how much of the surface the views see, and the fewest that see nearly all
    material: Material = field(default_factory=Material)  # how the surfaces reflect the light; matte by default

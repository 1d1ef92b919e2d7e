"""Renders the views of a data set."""

from dataclasses import dataclass, field

from haptic_glance.look.views.view import Material

COLUMNS = {"viewpoint": "name of the viewpoint", "views": "how many views together, this one the last"}


@dataclass
class Params:
    """Section `views` of params.yaml."""

    viewpoints: str
    size: list[int]
    background: str
    compare_sets: bool
    material: Material = field(default_factory=Material)

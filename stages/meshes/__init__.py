"""Collects the meshes of a data set."""

from dataclasses import dataclass

from haptic_glance.mesh.axes import axis_named


@dataclass
class Params:
    """Section `meshes` of params.yaml."""

    source: str  # which collection: a name of stages.meshes.sources.SOURCES
    folder: str
    up: str
    unit: str
    objects: list[str]
    classes: dict[str, list[str]]
    strict: bool
    colours: str = "vertex"
    remove_plane: bool = False

    def __post_init__(self) -> None:
        self.up = axis_named(self.up)

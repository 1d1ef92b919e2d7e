"""Collects the meshes of a data set."""

from dataclasses import dataclass

from haptic_glance.mesh.axes import axis_named
from stages.engine.settings import REQUIRED, setting


def _source():
    from stages.meshes.sources import SOURCES

    return SOURCES


def _colours():
    from haptic_glance.mesh.materials import COLOURS

    return COLOURS


@dataclass
class Params:
    """Section `meshes` of params.yaml."""

    source: str = setting(REQUIRED, "which collection: a name of stages.meshes.sources.SOURCES", names=_source)
    folder: str = setting(
        "",
        "your own folder of meshes, or the folder or zip of a collection that is not downloaded automatically",
    )
    up: str = setting(
        "z",
        "the axis that points up in the files of folder (there auto: by file, else by shape), interest_points "
        "and fixation_maps; GLB is always y",
    )
    unit: str = setting("unknown", "the unit of those files, for the manifest")
    objects: list[str] = setting([], "the objects to take, all of the source when empty")
    classes: dict[str, list[str]] = setting(
        {},
        "class: its objects, for stages that recognise classes of several objects",
    )
    strict: bool = setting(False, "stop at the first refused mesh instead of going on without it")
    colours: str = setting(
        "vertex",
        "vertex (colours per vertex, else grey), own (also of faces, materials, textures) or palette (own, "
        "else one by name)",
        names=_colours,
    )
    remove_plane: bool = setting(
        False,
        "of scans: take out the table that the object stands on, before anything else (T4.2.3.2)",
    )

    def __post_init__(self) -> None:
        self.up = axis_named(self.up)

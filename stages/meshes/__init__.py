"""Collects the meshes of a data set."""

from dataclasses import dataclass

from haptic_glance.mesh.axes import axis_named


@dataclass
class Params:
    """Section `meshes` of params.yaml."""

    source: str  # which collection: a name of stages.meshes.sources.SOURCES
    folder: str  # where the files lie: your own folder, or the folder or zip of a collection that is not fetched
    up: str  # the axis that points up in the files of folder and interest_points: as --up takes it, such as y, -z, auto
    unit: str  # the unit of the folder's files, for the manifest
    objects: list[str]  # the objects to take; empty: those of classes, or all
    classes: dict[str, list[str]]  # class: its objects, for stages that recognise classes of several objects
    strict: bool  # stop at the first refused mesh instead of going on without it
    colours: str = "vertex"  # vertex (per vertex, else grey), own (all that a file has) or palette (else one by name)
    remove_plane: bool = False  # take out the table that a scanned object stands on, before anything else (T4.2.3.2)

    def __post_init__(self) -> None:
        self.up = axis_named(self.up)

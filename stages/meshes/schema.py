"""The settings of the meshes stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `meshes` of params.yaml."""

    source: str  # which collection: household or folder
    folder: str  # where a person's own meshes lie; read by source folder only
    up: str  # the axis that points up in the folder's files: x, y or z
    unit: str  # the unit of the folder's files, for the manifest
    objects: list[str]  # the objects to take, all of the source when empty
    strict: bool  # stop at the first refused mesh instead of going on without it

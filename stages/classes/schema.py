"""The settings of the classes stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `classes` of params.yaml."""

    source: str  # which collection the objects come from: a name of stages.meshes.sources.SOURCES
    folder: str  # where that collection lies: a folder or a zip; furniture and household need none
    up: str  # the axis that points up in the files of folder and interest_points: x, y or z
    names: dict[str, list[str]]  # class: its objects, names of the source
    methods: list[str]  # detectors of stages.salient_points.METHODS that guide the touch
    count: int  # salient points an object and detector

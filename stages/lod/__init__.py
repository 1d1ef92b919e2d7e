"""Simplifies every object of a data set to several sizes and measures the errors."""

from dataclasses import dataclass

COLUMNS = {
    "target": "the face count asked for, as in the settings",
    "asked": "the same as a number of faces",
    "faces": "the faces of the simplified mesh; empty where there is none",
    "points": "salient points to keep",
    "kept": "those that were kept",
    "rings": "mean rings of faces frozen around a kept point",
    "smallest_feasible": "the fewest faces with which all points can be kept",
    "infeasible": "whether the target is too low for what is kept",
    "shrunk": "whether neighbourhoods are smaller than asked for",
}


@dataclass
class Params:
    """Section `lod` of params.yaml."""

    methods: list[str]  # qem, qslim, or a method of salient_points, also with -adaptive, -area or -soft behind it
    targets: list[str]
    rings: int
    backend: str
    samples: int
    viewpoints: str
    size: list[int]
    shrink: bool

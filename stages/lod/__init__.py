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
    targets: list[str]  # face counts, absolute ("1500") or as a share of the object's own ("25%")
    rings: int  # edges around a kept point within which every face is frozen; T3.1.3 takes 3
    backend: str  # who simplifies: fast; qslim, without its fit, as in the thesis; or pymeshlab, the reference
    samples: int  # points on each surface for the Metro error
    viewpoints: str  # named set for the picture errors: twelve (T figure 3.2) or four
    size: list[int]  # rows, columns of the pictures for the picture errors
    shrink: bool  # where the target is too low, keep smaller neighbourhoods, the least salient points first

"""Simplifies every object of a data set to several sizes and measures the errors."""

from dataclasses import dataclass

from stages.engine.settings import REQUIRED, setting
from stages.views import viewpoint_names

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


def _methods():
    from haptic_glance.lod.task import variant

    return variant


def _targets():
    from haptic_glance.lod.export import face_count

    return face_count


def _backend():
    from haptic_glance.lod.simplify import BACKENDS

    return BACKENDS


@dataclass
class Params:
    """Section `lod` of params.yaml."""

    methods: list[str] = setting(
        REQUIRED,
        "qem, qslim, or a method of salient_points, also with -adaptive, -area or -soft behind it",
        names=_methods,
    )
    targets: list[str] = setting(
        ["50%", "25%", "10%", "3000", "1500", "750"],
        'face counts, absolute ("1500") or as a share of the object\'s own ("25%")',
        names=_targets,
    )
    rings: int = setting(3, "edges around a kept point within which every face is frozen (T3.1.3)", least=0)
    backend: str = setting(
        "fast",
        "who simplifies: fast (compiled), qslim (the same without the fit, as in the thesis), or pymeshlab",
        names=_backend,
    )
    samples: int = setting(10000, "points on each surface for the Metro error: mean within 1 %", least=1)
    viewpoints: str = setting(
        "twelve",
        "named set for the SSIM error: twelve (T figure 3.2) or four",
        names=viewpoint_names,
    )
    size: list[int] = setting([225, 300], "rows, columns of the pictures for the SSIM error", least=1)
    shrink: bool = setting(
        True,
        "where the target is too low, keep smaller neighbourhoods, the least salient points first",
    )

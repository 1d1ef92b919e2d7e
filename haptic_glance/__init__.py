"""Haptic Glance, for a mesh of your own: where people look at it, fewer faces, and what a finger feels there.

    from haptic_glance import find_points, load, press, simplify

    mesh = load("bunny.stl")
    points = find_points(mesh, count=10)
    small = simplify(mesh, 1500, keep=points)
    images = [press(mesh, point) for point in points]

A thin package over `stages`, which is the pipeline's own. A name is imported when it is first asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stages.conspicuity import CHANNELS, conspicuity
    from stages.imprints import (
        Layer,
        Sequence,
        Surface,
        follow,
        forces,
        gaps_at,
        layout_forces,
        press,
        press_forces,
        press_many,
        read_layout,
        sensor_axes,
        sensor_normals,
        shear,
    )
    from stages.kit import Mesh, Viewpoint
    from stages.lod import metro, perceptual, simplify, write_any
    from stages.meshes import Cloud, MeshError, cloud_of_depth, load, normalise, surface_of
    from stages.salient_points import METHODS, Detection, detect, find_points, saliency
    from stages.scene import Camera, Placed, Scene, budget, fly
    from stages.views import View, render

__all__ = [
    "CHANNELS", "Camera", "Cloud", "Detection", "Layer", "METHODS", "Mesh", "MeshError", "Placed",
    "Scene", "Sequence", "Surface", "View", "Viewpoint", "budget", "cloud_of_depth", "conspicuity", "detect",
    "find_points", "fly", "follow", "forces", "gaps_at", "layout_forces", "load", "metro", "normalise",
    "perceptual", "press", "press_forces", "press_many", "read_layout", "render", "saliency", "sensor_axes",
    "sensor_normals", "shear", "simplify", "surface_of", "write_any",
]  # fmt: skip

_NAMES = {
    "conspicuity": ("CHANNELS", "conspicuity"),
    "imprints": (
        "Layer", "Sequence", "Surface", "follow", "forces", "gaps_at", "layout_forces", "press", "press_forces",
        "press_many", "read_layout", "sensor_axes", "sensor_normals", "shear",
    ),
    "kit": ("Mesh", "Viewpoint"),
    "lod": ("metro", "perceptual", "simplify", "write_any"),
    "meshes": ("Cloud", "MeshError", "cloud_of_depth", "load", "normalise", "surface_of"),
    "salient_points": ("METHODS", "Detection", "detect", "find_points", "saliency"),
    "scene": ("Camera", "Placed", "Scene", "budget", "fly"),
    "views": ("View", "render"),
}  # fmt: skip
_STAGES = {name: stage for stage, names in _NAMES.items() for name in names}


def __getattr__(name: str) -> object:
    if name not in _STAGES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = getattr(import_module(f"stages.{_STAGES[name]}"), name)
    return globals()[name]


def __dir__() -> list[str]:
    return __all__

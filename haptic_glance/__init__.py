"""Haptic Glance, for a mesh of your own: where people look at it, fewer faces, and what a finger feels there.

    from haptic_glance import find_points, load, press, simplify

    mesh = load("bunny.stl")
    points = find_points(mesh, count=10)
    small = simplify(mesh, 1500, keep=points)
    images = [press(mesh, point) for point in points]

A thin package over `stages`, which is the pipeline's own. A name is imported when it is first asked for. Most of what
takes a mesh takes a path, `(vertices, faces)` or an object of trimesh as well, see `as_mesh`.
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
        press_forces,
        read_layout,
        sensor_axes,
        sensor_normals,
        shear,
    )
    from stages.imprints import press as _press
    from stages.imprints import press_many as _press_many
    from stages.kit import Mesh, Viewpoint
    from stages.lod import metro, perceptual, to_trimesh, write_any
    from stages.lod import simplify as _simplify
    from stages.meshes import Cloud, MeshError, as_mesh, cloud_of_depth, load, normalise, surface_of
    from stages.salient_points import METHODS, Detection
    from stages.salient_points import detect as _detect
    from stages.salient_points import find_points as _find_points
    from stages.salient_points import saliency as _saliency
    from stages.scene import Camera, Placed, Scene, budget, fly
    from stages.views import View, render

    from .doors import takes_any_mesh

    detect, find_points, saliency = takes_any_mesh(_detect), takes_any_mesh(_find_points), takes_any_mesh(_saliency)
    press, press_many, simplify = takes_any_mesh(_press), takes_any_mesh(_press_many), takes_any_mesh(_simplify)

__all__ = [
    "CHANNELS", "Camera", "Cloud", "Detection", "Layer", "METHODS", "Mesh", "MeshError", "Placed",
    "Scene", "Sequence", "Surface", "View", "Viewpoint", "as_mesh", "budget", "cloud_of_depth", "conspicuity", "detect",
    "find_points", "fly", "follow", "forces", "gaps_at", "layout_forces", "load", "metro", "normalise",
    "perceptual", "press", "press_forces", "press_many", "read_layout", "render", "saliency", "sensor_axes",
    "sensor_normals", "shear", "simplify", "surface_of", "to_trimesh", "write_any",
]  # fmt: skip

_NAMES = {
    "conspicuity": ("CHANNELS", "conspicuity"),
    "imprints": (
        "Layer", "Sequence", "Surface", "follow", "forces", "gaps_at", "layout_forces", "press", "press_forces",
        "press_many", "read_layout", "sensor_axes", "sensor_normals", "shear",
    ),
    "kit": ("Mesh", "Viewpoint"),
    "lod": ("metro", "perceptual", "simplify", "to_trimesh", "write_any"),
    "meshes": ("Cloud", "MeshError", "as_mesh", "cloud_of_depth", "load", "normalise", "surface_of"),
    "salient_points": ("METHODS", "Detection", "detect", "find_points", "saliency"),
    "scene": ("Camera", "Placed", "Scene", "budget", "fly"),
    "views": ("View", "render"),
}  # fmt: skip
_DOORS = ("detect", "find_points", "press", "press_many", "saliency", "simplify")
_STAGES = {name: stage for stage, names in _NAMES.items() for name in names}


def __getattr__(name: str) -> object:
    if name not in _STAGES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"stages.{_STAGES[name]}"), name)
    globals()[name] = import_module("haptic_glance.doors").takes_any_mesh(found) if name in _DOORS else found
    return globals()[name]


def __dir__() -> list[str]:
    return __all__

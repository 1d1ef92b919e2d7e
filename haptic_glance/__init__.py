"""Haptic Glance, for a mesh of your own: where people look at it, fewer faces, and what a finger feels there.

    from haptic_glance import find_points, load, press, simplify

    mesh = load("bunny.stl")
    points = find_points(mesh, count=10)
    small = simplify(mesh, 1500, keep=points)
    images = [press(mesh, point) for point in points]

A name is imported at its first use. A function that takes a mesh also takes a path, `(vertices, faces)`, an object of
trimesh or a point cloud, see `as_mesh`.
Lengths of `press`, `press_many` and `follow` are shares of the object's diameter.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from haptic_glance.gallery.viewer import Shown, show
    from haptic_glance.lod import InfeasibleTarget, SimplifyError, metro, perceptual, to_trimesh, write_any
    from haptic_glance.lod.scene import Camera, Placed, Scene, budget, fly
    from haptic_glance.look.camera import Viewpoint
    from haptic_glance.look.channels import CHANNELS, conspicuity
    from haptic_glance.look.points import METHODS, Detection, detect, find_points, saliency
    from haptic_glance.look.views import View, render
    from haptic_glance.mesh import (
        Cloud,
        Mesh,
        MeshError,
        as_mesh,
        clean,
        cloud_of_depth,
        normalise,
        rotate_to_z_up,
        surface_of,
    )
    from haptic_glance.touch import (
        Layer,
        Sequence,
        Surface,
        follow,
        forces,
        gaps_at,
        press,
        press_forces,
        press_many,
        sensor_axes,
        sensor_normals,
        shear,
    )

    from .public import load, repair, simplify

__all__ = [
    "CHANNELS", "Camera", "Cloud", "Detection", "InfeasibleTarget", "Layer", "METHODS", "Mesh", "MeshError", "Placed",
    "Scene", "Sequence", "Shown", "SimplifyError", "Surface", "View", "Viewpoint", "as_mesh", "budget", "clean",
    "cloud_of_depth", "conspicuity", "detect", "find_points", "fly", "follow", "forces", "gaps_at", 
    "load", "metro", "normalise", "perceptual", "press", "press_forces", "press_many", "render",
    "repair", "rotate_to_z_up", "saliency", "sensor_axes", "sensor_normals", "shear", "show", "simplify", "surface_of",
    "to_trimesh", "write_any",
]  # fmt: skip

_NAMES = {
    "haptic_glance.look.channels": ("CHANNELS", "conspicuity"),
    "haptic_glance.touch": (
        "Layer", "Sequence", "Surface", "follow", "forces", "gaps_at", "press", "press_forces",
        "press_many", "sensor_axes", "sensor_normals", "shear",
    ),
    "haptic_glance.look.camera": ("Viewpoint",),
    "haptic_glance.lod": (
        "InfeasibleTarget", "SimplifyError", "metro", "perceptual", "simplify", "to_trimesh", "write_any",
    ),
    "haptic_glance.mesh": (
        "Cloud", "Mesh", "MeshError", "as_mesh", "clean", "cloud_of_depth", "normalise", "rotate_to_z_up", "surface_of",
    ),
    "haptic_glance.look.points": ("METHODS", "Detection", "detect", "find_points", "saliency"),
    "haptic_glance.lod.scene": ("Camera", "Placed", "Scene", "budget", "fly"),
    "haptic_glance.look.views": ("View", "render"),
    "haptic_glance.public": ("load", "repair"),
    "haptic_glance.gallery.viewer": ("Shown", "show"),
}  # fmt: skip
_MODULES = {name: module for module, names in _NAMES.items() for name in names}


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("haptic-glance")
        except PackageNotFoundError:  # a tree that is not installed
            return "0+unknown"
    if name not in _MODULES:
        from haptic_glance.base.gone import went

        hint = went(name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{hint and ': '}{hint}")
    member = getattr(import_module(_MODULES[name]), name)
    public = import_module("haptic_glance.public")
    globals()[name] = public.accepts_any_mesh(name, member) if name in public.PATH_ARGUMENTS else member
    return globals()[name]


def __dir__() -> list[str]:
    return [*__all__, "__version__"]

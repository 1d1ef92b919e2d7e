"""Meshes: reads any file, repairs or refuses, finds the up axis, centres and scales (T3.1.5, T3.2.9)."""

from typing import TYPE_CHECKING

from haptic_glance.base.lazy import lazy_names

if TYPE_CHECKING:
    from .clouds import Cloud, cloud_of_depth, surface_of
    from .files import as_mesh, load
    from .headers import MeshError
    from .mesh import Mesh
    from .plane import remove_plane
    from .repair import clean, normalise, rotate_to_z_up

_MODULES = {
    "Cloud": "clouds",
    "Mesh": "mesh",
    "MeshError": "headers",
    "as_mesh": "files",
    "clean": "repair",
    "cloud_of_depth": "clouds",
    "load": "files",
    "normalise": "repair",
    "remove_plane": "plane",
    "rotate_to_z_up": "repair",
    "surface_of": "clouds",
}
__all__ = [
    "Cloud", "Mesh", "MeshError", "as_mesh", "clean", "cloud_of_depth", "load", "normalise", "remove_plane",
    "rotate_to_z_up", "surface_of",
]  # fmt: skip
__getattr__ = lazy_names(__name__, _MODULES)

"""Meshes: reads any file, repairs or refuses, finds the up axis, centres and scales (T3.1.5, T3.2.9)."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

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


def __getattr__(name: str) -> Any:
    """Imports a public name when it is first asked for, since some of the modules take long to import."""
    if name in _MODULES:
        return getattr(import_module(f".{_MODULES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

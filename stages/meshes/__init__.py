"""Meshes: reads a data set, repairs or refuses each mesh, centres and scales it (T3.1.5, T3.2.9)."""

from stages.kit import Mesh

from .clean import clean
from .clouds import Cloud, cloud_of_depth, surface_of
from .load import MeshError, as_mesh, load
from .normalise import normalise, rotate_to_z_up
from .plane import remove_plane

__all__ = [
    "Cloud", "Mesh", "MeshError", "as_mesh", "clean", "cloud_of_depth", "load", "normalise", "remove_plane",
    "rotate_to_z_up", "surface_of",
]  # fmt: skip

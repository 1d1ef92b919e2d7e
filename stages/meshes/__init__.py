"""Meshes: reads a data set, repairs or refuses each mesh, centres and scales it (T3.1.5, T3.2.9)."""

from stages.kit import Mesh

from .clean import clean
from .load import MeshError, load
from .normalise import normalise, rotate_to_z_up
from .plane import remove_plane

__all__ = ["Mesh", "MeshError", "clean", "load", "normalise", "remove_plane", "rotate_to_z_up"]

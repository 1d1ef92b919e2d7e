"""Meshes: collect a data set, repair or refuse each mesh, centre and scale it (T3.1.5, T3.2.9)."""

from stages.kit import Mesh

from .clean import clean
from .load import MeshError, load
from .normalise import normalise, turn_up
from .plane import remove_plane

__all__ = ["Mesh", "MeshError", "clean", "load", "normalise", "remove_plane", "turn_up"]

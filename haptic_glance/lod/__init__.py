"""Levels of detail: simplification that spares the salient regions, and its errors (T3.1.3, T3.1.4, T3.2.8)."""

from .attributes import carry
from .errors import colour_error, metro, salient_error, surface_errors, vertex_errors
from .export import to_trimesh, write_any
from .feasibility import InfeasibleTarget, SimplifyError, frozen_faces, smallest_feasible
from .neighbourhood import neighbourhoods, shrunk_rings
from .perceptual import perceptual, picture_errors, take_pictures
from .simplify import BACKENDS, quadric_weights, simplify
from .weight_files import write_weights

__all__ = [
    "BACKENDS", "InfeasibleTarget", "SimplifyError", "carry", "colour_error", "frozen_faces", "metro",
    "neighbourhoods", "perceptual", "picture_errors", "quadric_weights", "salient_error", "shrunk_rings",
    "simplify", "smallest_feasible", "surface_errors", "take_pictures", "to_trimesh", "vertex_errors", "write_any",
    "write_weights",
]  # fmt: skip

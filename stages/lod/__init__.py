"""LOD: simplification that spares the salient regions, and its errors (T3.1.3, T3.1.4, T3.2.8)."""

from .attributes import carry
from .colour_error import colour_error
from .export import to_trimesh, write_any
from .feasibility import InfeasibleTarget, SimplifyError, frozen_faces, smallest_feasible
from .metro import metro, surface_errors, vertex_errors
from .neighbourhood import neighbourhoods
from .perceptual import perceptual, picture_errors, take_pictures
from .salient_error import salient_error
from .shrink import shrunk_rings
from .simplify import BACKENDS, quadric_weights, simplify

__all__ = [
    "BACKENDS", "InfeasibleTarget", "SimplifyError", "carry", "colour_error", "frozen_faces", "metro", "neighbourhoods",
    "perceptual", "picture_errors", "quadric_weights", "salient_error", "shrunk_rings", "simplify", "smallest_feasible",
    "surface_errors", "take_pictures", "to_trimesh", "vertex_errors", "write_any",
]  # fmt: skip

"""LOD: fewer faces where nobody looks, and how much that shows (T3.1.3, T3.1.4, T3.2.8)."""

from .feasibility import InfeasibleTarget, frozen_faces, smallest_feasible
from .metro import metro
from .perceptual import perceptual, picture_errors, take_pictures
from .simplify import BACKENDS, SimplifyError, simplify

__all__ = [
    "BACKENDS", "InfeasibleTarget", "SimplifyError", "frozen_faces", "metro", "perceptual", "picture_errors",
    "simplify", "smallest_feasible", "take_pictures",
]  # fmt: skip

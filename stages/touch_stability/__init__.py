"""Where recognition by touch breaks: misplaced, turned and faulty sensors, moved objects, coarse models, few touches.

Public names: PERTURBATIONS, Perturbation, Felt, FEATURES, Touches, breaking_point, lead_left, recognise, NONE.
"""

from .breaking import breaking_point, lead_left
from .perturbations import PERTURBATIONS, Felt, Perturbation
from .recognise import FEATURES, NONE, recognise
from .touches import Touches

__all__ = [
    "FEATURES",
    "NONE",
    "PERTURBATIONS",
    "Felt",
    "Perturbation",
    "Touches",
    "breaking_point",
    "lead_left",
    "recognise",
]

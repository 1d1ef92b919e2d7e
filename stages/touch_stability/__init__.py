"""Breaking points of recognition by touch: sensor errors, moved objects, coarse models, few touches.

Public names: recognition_rows, Perturbation, PerturbedTouches, Touches, CLEAN, FEATURES, PERTURBATIONS.
"""

from .perturbations import PERTURBATIONS, Perturbation, PerturbedTouches
from .recognition import CLEAN, FEATURES, recognition_rows
from .touches import Touches

__all__ = ["CLEAN", "FEATURES", "PERTURBATIONS", "Perturbation", "PerturbedTouches", "Touches", "recognition_rows"]

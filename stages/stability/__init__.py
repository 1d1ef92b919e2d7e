"""Stability: what each method still finds when the mesh, the light or the image changes, and where it breaks."""

from .measures import breaking_point, chance_repeatability, drift, repeatability
from .perturbations import PERTURBATIONS, Conditions, Perturbation, Perturbed
from .sights import look

__all__ = [
    "PERTURBATIONS", "Conditions", "Perturbation", "Perturbed", "breaking_point", "chance_repeatability", "drift",
    "look", "repeatability",
]  # fmt: skip

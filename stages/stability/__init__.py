"""Stability: what each method still finds when the mesh, the light or the image changes, and where it breaks.

And what becomes of broken meshes when they are simplified.
"""

from .broken import BROKEN
from .measures import breaking_point, chance_repeatability, drift, repeatability
from .perturbations import PERTURBATIONS, Conditions, Perturbation, Perturbed
from .sights import look
from .simplification import simplification_rows

__all__ = [
    "BROKEN", "PERTURBATIONS", "Conditions", "Perturbation", "Perturbed", "breaking_point", "chance_repeatability",
    "drift", "look", "repeatability", "simplification_rows",
]  # fmt: skip

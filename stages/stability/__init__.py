"""Stability: what each method still finds when the mesh, the light or the image changes, and where it breaks.

Also: what happens to broken meshes when they are simplified.
"""

from .broken import DAMAGES
from .maps import maps_under_conditions
from .measures import chance_repeatability, drift, repeatability
from .perturbations import PERTURBATIONS, Conditions, Perturbation, Perturbed
from .simplification import simplification_rows

__all__ = [
    "DAMAGES", "PERTURBATIONS", "Conditions", "Perturbation", "Perturbed", "chance_repeatability",
    "drift", "maps_under_conditions", "repeatability", "simplification_rows",
]  # fmt: skip

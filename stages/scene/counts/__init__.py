"""How many faces? The count that an object needs for an error that is tolerated at a distance (T3.1.3).

Three models, which need ever more measurements of the object: `fit_counts` learns from other objects (the thesis's
networks, or a linear model), `fit_power_law` extrapolates from one simplified mesh of the object, and `Curve` looks up
the object's own measured errors. `evaluate_counts` compares them on objects that were left out of the training.
"""

from .cases import PowerLaw, fit_power_law
from .evaluate import evaluate_counts
from .models import Counts, Curve, fit_counts, focal_length, read_curves

__all__ = [
    "Counts", "Curve", "PowerLaw", "fit_counts", "fit_power_law", "focal_length", "evaluate_counts", "read_curves",
]  # fmt: skip

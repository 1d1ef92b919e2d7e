"""How many faces? The count that an object needs for an error that is tolerated at a distance (T3.1.3).

Three answers, from the least that is known of the object to the most: `fit_counts` learns from other objects (the
thesis's networks, or a linear model), `fit_power_law` carries one measured mesh of the object along, and `Curve` looks
the object's own measured errors up. `judge_counts` compares them on objects that were left out.
"""

from .curves import Curve, read_curves
from .distance import focal_length, tolerated_error
from .judge import judge_counts
from .models import Counts, fit_counts
from .one_mesh import PowerLaw, fit_power_law

__all__ = [
    "Counts", "Curve", "PowerLaw", "fit_counts", "fit_power_law", "focal_length", "judge_counts", "read_curves",
    "tolerated_error",
]  # fmt: skip

"""A glance at a surface: where people look, from the middle of small cells of it, without a picture.

The features describe height, what can be seen from where, relief and symmetry around each point. A log-linear model of
them, learned from human gaze, gives the density of fixations. The result depends on the surface alone, not on its
faces, and the cost hardly depends on their number."""

from .draw import COUNT, samples_of_mesh, samples_of_points
from .features import FEATURES, standardised
from .samples import Samples

__all__ = [
    "COUNT", "FEATURES", "Samples", "samples_of_mesh", "samples_of_points", "standardised",
]  # fmt: skip

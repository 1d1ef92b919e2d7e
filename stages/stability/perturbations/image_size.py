"""Smaller images, which in an orthographic view is the same as an object farther away."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Conditions, Perturbed, in_range, under_conditions


def image_size(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Images with the share `severity` of the rows and columns; the maps shrink by the same factor."""
    return under_conditions(mesh, Conditions(rows=in_range(severity, 0.05, 1, "the share of rows")))

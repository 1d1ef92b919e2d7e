"""The background, black in the thesis after a trial of black, grey and white (T3.1.5)."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Conditions, Perturbed, in_range, under_conditions

WHAT = "the background's brightness"


def background(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Another background, which is kept out of the maps (haptic_glance.look.channels.cropped_view)."""
    return under_conditions(mesh, Conditions(background=in_range(severity, 0, 1, WHAT)))


def background_left_in(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Another background, left in the image from which the maps are computed, as in the thesis."""
    return under_conditions(mesh, Conditions(background=in_range(severity, 0, 1, WHAT), filled=False))

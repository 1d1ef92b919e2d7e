"""Light from the side instead of from the camera."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Conditions, Perturbed, in_range, under_conditions


def light(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The head light moves `severity` degrees off the camera, up and to the left in the image."""
    return under_conditions(mesh, Conditions(light=in_range(severity, 0, 180, "degrees off the camera")))

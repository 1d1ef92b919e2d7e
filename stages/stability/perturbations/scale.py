"""The same object in another unit of length."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range


def scale(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """Coordinates multiplied by `severity`. For a smaller object in the image see image_size."""
    factor = in_range(severity, 1e-12, 1e12, "the factor")
    return Perturbed(Mesh(mesh.vertices * factor, mesh.faces, mesh.colors), mesh.vertices)

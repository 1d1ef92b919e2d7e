"""Noise of a scanner: every vertex moves a little."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range


def noise(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """Gaussian noise on each coordinate of the vertices, with a sigma of `severity` of the diagonal.

    Vertices at one position move together, so that a seam does not open.
    """
    in_range(severity, 0, 1, "sigma over the diagonal")
    places, at = np.unique(mesh.vertices, axis=0, return_inverse=True)
    steps = severity * mesh.diagonal * generator.standard_normal(places.shape)
    return Perturbed(Mesh(mesh.vertices + steps[at.ravel()], mesh.faces, mesh.colors), mesh.vertices)

"""Noise of a scanner: every place of the surface moves a little."""

import numpy as np

from stages.kit import Mesh

from .perturbed import Perturbed, in_range


def noise(mesh, severity, generator):
    """Gaussian noise on the vertices, sigma `severity` of the diagonal in each coordinate.

    Vertices at one place move together, so that a seam does not tear.
    """
    in_range(severity, 0, 1, "sigma over the diagonal")
    places, at = np.unique(mesh.vertices, axis=0, return_inverse=True)
    steps = severity * mesh.diagonal * generator.standard_normal(places.shape)
    return Perturbed(Mesh(mesh.vertices + steps[at.ravel()], mesh.faces, mesh.colors), mesh.vertices)

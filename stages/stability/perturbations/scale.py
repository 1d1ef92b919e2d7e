"""The same object in another unit of length."""

from stages.kit import Mesh

from .perturbed import Perturbed, in_range


def scale(mesh, severity, _generator):
    """Coordinates times `severity`. That it looks smaller in the image is another matter: see image_size."""
    factor = in_range(severity, 1e-12, 1e12, "the factor")
    return Perturbed(Mesh(mesh.vertices * factor, mesh.faces, mesh.colors), mesh.vertices)

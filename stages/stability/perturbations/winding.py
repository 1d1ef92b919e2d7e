"""Faces with inverted winding, as in files whose winding nobody checked."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range


def winding(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The share `severity` of the faces, drawn at random, is inverted; at 1 the whole mesh is inside out.

    The meshes stage corrects such faces; a caller who computes a saliency directly may still have them.
    """
    turned = generator.random(len(mesh.faces)) < in_range(severity, 0, 1, "the share of faces")
    faces = mesh.faces.copy()
    faces[turned] = faces[turned][:, ::-1]
    return Perturbed(Mesh(mesh.vertices, faces, mesh.colors), mesh.vertices)

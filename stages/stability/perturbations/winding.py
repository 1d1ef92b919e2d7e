"""Faces that look inwards, as in files whose winding nobody checked."""

from stages.kit import Mesh

from .perturbed import Perturbed, in_range


def winding(mesh, severity, generator):
    """The share `severity` of the faces, drawn at random, is wound the other way; at 1 the whole mesh is inside out.

    The meshes stage turns such faces back; whoever asks for a saliency directly brings them along.
    """
    turned = generator.random(len(mesh.faces)) < in_range(severity, 0, 1, "the share of faces")
    faces = mesh.faces.copy()
    faces[turned] = faces[turned][:, ::-1]
    return Perturbed(Mesh(mesh.vertices, faces, mesh.colors), mesh.vertices)

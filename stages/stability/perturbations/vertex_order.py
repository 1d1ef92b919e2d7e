"""The same surface with its vertices in another order."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range


def vertex_order(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The share `severity` of the vertices are shuffled; the surface is unchanged."""
    n = len(mesh.vertices)
    old = np.arange(n)
    moved = generator.choice(n, int(round(in_range(severity, 0, 1, "the share of vertices") * n)), replace=False)
    old[np.sort(moved)] = moved
    colors = None if mesh.colors is None else mesh.colors[old]
    return Perturbed(Mesh(mesh.vertices[old], np.argsort(old)[mesh.faces], colors), mesh.vertices[old])

"""Fewer faces, by quadric edge collapse."""

import numpy as np

from haptic_glance.lod import simplify
from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range


def decimation(mesh: Mesh, severity: float, _generator: np.random.Generator) -> Perturbed:
    """The mesh with the share `severity` of its faces (Garland and Heckbert 1997)."""
    faces = int(in_range(severity, 1e-6, 1, "the share of faces kept") * len(mesh.faces))
    simplified = simplify(mesh, max(faces, 1))
    return Perturbed(simplified, simplified.vertices)

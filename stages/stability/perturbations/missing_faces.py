"""Holes, as a scanner leaves them."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .perturbed import Perturbed, in_range

PATCHES = 4  # holes per object


def missing_faces(mesh: Mesh, severity: float, generator: np.random.Generator) -> Perturbed:
    """The share `severity` of the faces is missing, in round patches around faces drawn by area.

    A harsher severity widens the same holes. Salient points that lay there count as lost.
    """
    lost = int(in_range(severity, 0, 1, "the share of faces missing") * len(mesh.faces))
    if lost >= len(mesh.faces) or not mesh.face_areas.sum() > 0:
        raise ValueError(f"{lost} of {len(mesh.faces)} faces missing leave no surface: take a smaller share")
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    centres = middles[generator.choice(len(middles), PATCHES, p=mesh.face_areas / mesh.face_areas.sum())]
    away = np.linalg.norm(middles[:, None] - centres, axis=2).min(axis=1)
    faces = mesh.faces[np.sort(np.argsort(away, kind="stable")[lost:])]
    used, at = np.unique(faces, return_inverse=True)
    colors = None if mesh.colors is None else mesh.colors[used]
    return Perturbed(Mesh(mesh.vertices[used], at.reshape(-1, 3), colors), mesh.vertices[used])

"""Repairs what can be repaired without moving a vertex, and refuses the rest."""

import numpy as np

from stages.kit import Mesh

from .load import MeshError
from .orient import orient

LEAST_AREA = 1e-12  # of the squared diagonal: below it, single-precision rays see no surface
LEAST_SEEN = 1e-4  # of the squared extent: some five pixels of the stored maps (225 rows)


def clean(mesh):
    """(mesh, notes): faces that repeat a vertex and doubled ones go, the others face outwards; vertices keep ids.

    Faces of no area with three distinct vertices stay: they hold their neighbours together, and taking them out would
    open a closed mesh. Raises MeshError when no face or no area is left.
    """
    ids, notes = np.arange(len(mesh.faces)), []
    a, b, c = mesh.faces.T
    ids, notes = _keep(ids, (a != b) & (b != c) & (c != a), notes, "degenerate")
    faces = mesh.faces[ids]
    # Equal up to a cyclic turn: two faces back to back are a thin sheet and both stay.
    turned = np.take_along_axis(faces, (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    _, first = np.unique(turned, axis=0, return_index=True)
    single = np.zeros(len(faces), dtype=bool)
    single[first] = True
    ids, notes = _keep(ids, single, notes, "doubled")
    if len(ids) == 0:
        raise MeshError("no face with three different vertices")
    faces = mesh.faces[ids]
    cleaned = Mesh(mesh.vertices, faces, mesh.colors, mesh.texture and mesh.texture.of(ids))
    spread = np.ptp(mesh.vertices[np.unique(faces)], axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        area, square = cleaned.face_areas.sum(), float(spread @ spread)
    if not np.isfinite([area, square]).all():
        raise MeshError("coordinates so large that areas overflow")
    if area <= LEAST_AREA * max(square, np.finfo(float).tiny):
        raise MeshError("the surface has no area")
    if area <= LEAST_SEEN * square:
        raise MeshError("too small to be seen beside its extent: are stray parts far from the object?")
    cleaned, turned = orient(cleaned)
    return cleaned, notes + turned


def _keep(ids, good, notes, what):
    removed = int((~good).sum())
    return ids[good], notes + ([f"{removed} {what} faces removed"] if removed else [])

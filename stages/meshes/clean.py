"""Repairs what can be repaired without moving a vertex, and refuses the rest."""

from dataclasses import replace

import numpy as np

from stages.kit import Mesh

from .load import MeshError
from .orient import orient

MIN_AREA = 1e-12  # share of the squared diagonal; below it, rays in single precision find no surface
BACK_TO_BACK = 0.5  # share of the faces from which on a surface is taken for one that was doubled
MIN_VISIBLE_AREA = 1e-4  # share of the squared extent: about five pixels of the stored maps, which have 225 rows


def clean(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """The repaired mesh and notes on what was repaired: (Mesh, list of str).

    Removes faces that repeat a vertex and duplicate faces, and turns the others outwards. Vertices keep their ids.
    Where most faces lie back to back, as SketchUp and games write surfaces to be seen from both sides, one of each two
    is removed: together they would have no normal. Faces without area that have three distinct vertices stay: they
    connect their neighbours, and removing them would open a closed mesh. Raises MeshError when no face or no area is
    left.
    """
    ids, notes = np.arange(len(mesh.faces)), []
    a, b, c = mesh.faces.T
    ids, notes = _keep(ids, (a != b) & (b != c) & (c != a), notes, "degenerate")
    faces = mesh.faces[ids]
    # Compared up to a cyclic permutation: two faces back to back are a thin sheet, and both stay.
    rotated = np.take_along_axis(faces, (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    _, first = np.unique(rotated, axis=0, return_index=True)
    single = np.zeros(len(faces), dtype=bool)
    single[first] = True
    ids, notes = _keep(ids, single, notes, "duplicate")
    ordered = np.sort(mesh.faces[ids], axis=1)
    _, first, count = np.unique(ordered, axis=0, return_index=True, return_counts=True)
    if count[count > 1].sum() > BACK_TO_BACK * len(ids):
        front = np.zeros(len(ids), dtype=bool)
        front[first] = True
        ids, notes = _keep(ids, front, notes, "back-to-back")
    if len(ids) == 0:
        raise MeshError("no face has three different vertices")
    faces = mesh.faces[ids]
    cleaned = replace(mesh, faces=faces, texture=mesh.texture and mesh.texture.of(ids))
    spread = np.ptp(mesh.vertices[np.unique(faces)], axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        area, square = cleaned.face_areas.sum(), float(spread @ spread)
    if not np.isfinite([area, square]).all():
        raise MeshError("the coordinates are so large that areas overflow")
    if area <= MIN_AREA * max(square, np.finfo(float).tiny):
        raise MeshError("the surface has no area")
    if area <= MIN_VISIBLE_AREA * square:
        raise MeshError("the surface is too small for its extent: are there stray parts far from the object?")
    cleaned, turned = orient(cleaned)
    return cleaned, notes + turned


def _keep(ids, good, notes, what):
    removed = int((~good).sum())
    return ids[good], notes + ([f"{removed} {what} faces removed"] if removed else [])

"""The files of marks in data/annotations as amounts at the vertices of the meshes that they fit."""

from collections.abc import Iterable
from functools import partial
from pathlib import Path

import numpy as np

from haptic_glance.look.marks import read_marks
from haptic_glance.mesh.mesh import Mesh

TOLERANCE = 0.01  # of the diagonal, between the position of a mark and its vertex; larger if the mesh was changed


def annotations_on_vertices(mesh: Mesh, path: str | Path, content: bytes | None = None) -> np.ndarray:
    """(n,) f8: how many annotators marked each vertex of the normalised mesh.

    path: a CSV with columns annotator, time, vertex, x, y, z (haptic_glance.look.marks); content: what it holds, where
    that is known. Since vertices are stored by
    id, marks would move on a mesh that was changed. Raises ValueError with the file, the rows and their distances when
    a vertex does not exist or is farther than 1 % of the diagonal from the position of the mark.
    """
    marks, n = read_marks(path, content), len(mesh.vertices)
    vertex = marks.vertex.to_numpy()
    outside = np.flatnonzero((vertex < 0) | (vertex >= n))
    if len(outside):
        raise ValueError(f"{path}, row {outside[0] + 1}: vertex {vertex[outside[0]]} is not in 0..{n - 1}")
    away = np.linalg.norm(marks[["x", "y", "z"]].to_numpy() - mesh.vertices[vertex], axis=1)
    distance = away / max(mesh.diagonal, np.finfo(float).tiny)
    far = np.flatnonzero(distance > TOLERANCE)
    if len(far):
        named = ", ".join(f"row {row + 1}: {distance[row]:.2%}" for row in far[:5])
        raise ValueError(
            f"{path}: {len(far)} of {len(marks)} marks are off the mesh, as shares of its diagonal {named}; they belong"
            " to another mesh or to an earlier version, and are not used: mark this mesh in the studio"
        )
    distinct = marks.drop_duplicates(["annotator", "vertex"])
    return np.bincount(distinct.vertex, minlength=n).astype(np.float64)


def marked_files(meshes: Iterable[tuple[str, Mesh]], folder: str | Path) -> dict[str, list[tuple[str, partial[bytes]]]]:
    """{object: its file of marks, (path, function that gives the bytes)} of the objects that a file fits.

    meshes: (name, normalised mesh) of each object. A file fits the mesh on whose vertices its marks lie, whatever both
    are called; the file of the object's own name is tried first. An object whose namesake fits no mesh at hand keeps
    it, so that its reader can say why it is of no use.
    """
    files = {path.stem: path for path in sorted(Path(folder).glob("*.csv"))}
    found, strange = {}, {}
    for name, mesh in meshes:
        own = [name] if name in files else []
        fitting = next((stem for stem in [*own, *files] if _fits(mesh, files[stem])), None)
        found |= {name: fitting} if fitting else {}
        strange |= {name: name for name in own if not fitting}
    found |= {name: stem for name, stem in strange.items() if stem not in found.values()}
    return {name: [(str(files[stem]), partial(bytes, files[stem].read_bytes()))] for name, stem in found.items()}


def _fits(mesh, path):
    try:
        return bool(annotations_on_vertices(mesh, path).any())
    except ValueError:
        return False

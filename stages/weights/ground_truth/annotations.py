"""The marks of data/annotations/NAME.csv as amounts at the vertices of the annotated mesh."""

from pathlib import Path

import numpy as np

from stages.kit import Mesh
from stages.weights.annotate import read_marks

TOLERANCE = 0.01  # of the diagonal, between the position of a mark and its vertex; larger if the mesh was changed


def annotations_on_vertices(mesh: Mesh, path: str | Path) -> np.ndarray:
    """(n,) f8: how many annotators marked each vertex of the normalised mesh.

    path: a CSV with columns annotator, time, vertex, x, y, z (stages.weights.annotate). Since vertices are stored by
    id, marks would move on a mesh that was changed. Raises ValueError with the file, the rows and their distances when
    a vertex does not exist or is farther than 1 % of the diagonal from the position of the mark.
    """
    marks, n = read_marks(path), len(mesh.vertices)
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
            " to another mesh of this name or to an earlier version: remove the file, or annotate this mesh"
        )
    distinct = marks.drop_duplicates(["annotator", "vertex"])
    return np.bincount(distinct.vertex, minlength=n).astype(np.float64)

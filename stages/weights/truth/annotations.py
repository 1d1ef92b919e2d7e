"""Our own marks, data/annotations/NAME.csv, as amounts on the vertices of the mesh on which they were made."""

import numpy as np

from stages.weights.annotate import read_marks

TOLERANCE = 0.01  # of the diagonal, between a mark's position and its vertex; a changed mesh is farther off


def annotations_on_vertices(mesh, path):
    """(n,) f8: how many annotators marked each vertex of the normalised mesh.

    path: a CSV with columns annotator, time, vertex, x, y, z (stages.weights.annotate). Vertices are named by number,
    so a mesh that was changed since would silently move the marks: ValueError that names the file, the rows and their
    distances when a vertex does not exist or is farther than 1 % of the mesh's diagonal from where the mark was made.
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
            f"{path}: {len(far)} of {len(marks)} marks are off the mesh, in parts of its diagonal {named}; they belong"
            " to another mesh of this name or to one that was changed since: take the file away, or mark this mesh"
        )
    once = marks.drop_duplicates(["annotator", "vertex"])
    return np.bincount(once.vertex, minlength=n).astype(np.float64)

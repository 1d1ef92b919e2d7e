"""Human gaze on meshes, as published in the repository FandosA/3D_Mesh_Saliency_Prediction_PyTorch.

A file dataset_SPLIT/NAME.txt has one row per vertex, shuffled: x y z nx ny nz, the total seconds that 32 people in
virtual reality looked there, and a binary label that is not used. Most files have exactly the vertices of
Models_3D/NAME.obj. Larger meshes are sub-sampled to 20,000 rows, smaller ones padded with points between vertices.
"""

import io
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.mesh.mesh import Mesh

COLUMNS = 8
MIN_MATCHED = 0.5  # of the rows; the published file with most padding (sofa) has 0.758
OFF_MESH = 0.05  # of the diagonal; padding lies up to 0.033 from the nearest vertex (sofa)


def read_gaze(path_or_bytes: str | Path | bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(positions (k, 3), normals (k, 3), seconds (k,)), f8, units of the mesh file, from a file or its bytes.

    Normals are as published: not unit, and invalid in some files. Raises ValueError for other than eight columns, NaN
    or negative seconds.
    """
    content = path_or_bytes if isinstance(path_or_bytes, bytes) else Path(path_or_bytes).read_bytes()
    rows = _rows(content, COLUMNS)
    return rows[:, :3], rows[:, 3:6], rows[:, 6]


def read_cloud_gaze(content: bytes) -> np.ndarray:
    """(k, 7) f8 x y z nx ny nz seconds, of the bytes of a cloud of the same experiment, which lacks the last column."""
    return _rows(content, COLUMNS - 1)


def _rows(content, columns):
    if not content.strip():
        raise ValueError("the gaze file is empty")
    try:
        rows = np.loadtxt(io.BytesIO(content), ndmin=2)
    except ValueError as error:
        raise ValueError(f"not a gaze file of numbers in {columns} columns: {error}") from None
    if rows.shape[1] != columns:
        raise ValueError(f"a gaze file has {columns} columns, got {rows.shape[0]} rows of {rows.shape[1]}")
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1) | (rows[:, 6] < 0))
    if len(bad):
        raise ValueError(f"{len(bad)} rows hold NaN or negative seconds, the first in line {bad[0] + 1}")
    return rows


def match_rows(mesh: Mesh, positions: np.ndarray, tolerance: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The vertex of each position: (vertex (k,) i8, -1 if none; distance (k,) to the nearest vertex).

    mesh: as read from the file, before rotation and scaling. Of vertices at the same position the lowest id is given.
    """
    places, first = np.unique(mesh.vertices, axis=0, return_index=True)
    distance, nearest = KDTree(places).query(positions)
    return np.where(distance <= tolerance, first[nearest], -1), distance


def gaze_on_vertices(mesh: Mesh, positions: np.ndarray, seconds: np.ndarray, tolerance: float = 0.0) -> np.ndarray:
    """(n,) f8: the seconds of gaze summed at the vertices of the mesh as published, before rotation and scaling.

    positions (k, 3) and seconds (k,): of `read_gaze`; tolerance: in units of the file, 0 since the published rows
    repeat the coordinates exactly. Vertices at the same position share its seconds equally. Rows without a vertex
    (`match_rows`) are left out: they are interpolated from their neighbours. Raises ValueError with the distances when
    rows are off the mesh or less than half of them match.
    """
    vertex, distance = match_rows(mesh, positions, tolerance)
    _check_matches(vertex < 0, distance / max(mesh.diagonal, np.finfo(float).tiny))
    n = len(mesh.vertices)
    amounts = np.bincount(vertex[vertex >= 0], np.asarray(seconds)[vertex >= 0], minlength=n)
    _, first, place, count = np.unique(
        mesh.vertices, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    return (amounts[first] / count)[place.ravel()]


def _check_matches(unmatched, distance):
    off = np.flatnonzero(unmatched & (distance > OFF_MESH))
    if len(off) == 0 and unmatched.mean() <= 1 - MIN_MATCHED:
        return
    worst = np.argsort(-distance, kind="stable")[:3]
    named = ", ".join(f"line {row + 1}: {distance[row]:.2%}" for row in worst)
    raise ValueError(
        f"{unmatched.sum()} of {len(unmatched)} gaze rows match no vertex and {len(off)} are off the mesh; distances as"
        f" shares of its diagonal: median {np.median(distance[unmatched]):.2%}, largest {named}. Is it the file of this"
        " mesh, in the units of the mesh file?"
    )

"""Human gaze on meshes, as published in the repository FandosA/3D_Mesh_Saliency_Prediction_PyTorch.

A file dataset_SPLIT/NAME.txt has a row a vertex, shuffled: x y z nx ny nz, seconds that 32 people in virtual reality
looked there together, and a binary label that is not read. Most files have exactly the vertices of Models_3D/NAME.obj;
larger meshes are sub-sampled to 20,000 rows, smaller ones padded with made-up points between vertices.
"""

import io
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

COLUMNS = 8
LEAST_MATCHED = 0.5  # of the rows; the most padded published file (sofa) has 0.758
OFF_MESH = 0.05  # of the diagonal; made-up rows lie up to 0.033 from the nearest vertex (sofa)


def read_gaze(path_or_bytes):
    """(positions (k, 3), normals (k, 3), seconds (k,)), f8, units of the mesh file, from a file or its bytes.

    Raises ValueError for other than eight columns, NaN or negative seconds. Normals are as published: not unit, and of
    no use in some files.
    """
    content = path_or_bytes if isinstance(path_or_bytes, bytes) else Path(path_or_bytes).read_bytes()
    if not content.strip():
        raise ValueError("the gaze file is empty")
    try:
        rows = np.loadtxt(io.BytesIO(content), ndmin=2)
    except ValueError as error:
        raise ValueError(f"no gaze file of numbers in {COLUMNS} columns: {error}") from None
    if rows.shape[1] != COLUMNS:
        raise ValueError(f"a gaze file has rows of {COLUMNS} columns, got {rows.shape[0]} of {rows.shape[1]}")
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1) | (rows[:, 6] < 0))
    if len(bad):
        raise ValueError(f"{len(bad)} rows hold NaN or negative seconds, the first in line {bad[0] + 1}")
    return rows[:, :3], rows[:, 3:6], rows[:, 6]


def match_rows(mesh, positions, tolerance=0.0):
    """(vertex (k,) i8, -1 where none; distance (k,) to the nearest vertex), in the units of the unturned mesh file.

    Of vertices at one place the lowest id is named.
    """
    places, first = np.unique(mesh.vertices, axis=0, return_index=True)
    distance, nearest = cKDTree(places).query(positions)
    return np.where(distance <= tolerance, first[nearest], -1), distance


def gaze_on_vertices(mesh, positions, seconds, tolerance=0.0):
    """(n,) f8: seconds summed on the vertices of the mesh as published, before it is turned and normalised.

    positions (k, 3) and seconds (k,) as `read_gaze` gives them; tolerance in units of the file, since published rows
    repeat the coordinates digit by digit. Vertices at one place share its seconds equally: the file cannot say which
    of them was looked at. Rows without a vertex are left out (`match_rows` names them): they are made up from their
    neighbours. Raises ValueError with the distances when rows are off the mesh or less than half of them match.
    """
    vertex, distance = match_rows(mesh, positions, tolerance)
    _refuse_foreign(vertex < 0, distance / max(mesh.diagonal, np.finfo(float).tiny))
    n = len(mesh.vertices)
    amounts = np.bincount(vertex[vertex >= 0], np.asarray(seconds)[vertex >= 0], minlength=n)
    _, first, place, count = np.unique(
        mesh.vertices, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    return (amounts[first] / count)[place.ravel()]


def _refuse_foreign(unmatched, distance):
    off = np.flatnonzero(unmatched & (distance > OFF_MESH))
    if len(off) == 0 and unmatched.mean() <= 1 - LEAST_MATCHED:
        return
    worst = np.argsort(-distance, kind="stable")[:3]
    named = ", ".join(f"line {row + 1}: {distance[row]:.2%}" for row in worst)
    raise ValueError(
        f"{unmatched.sum()} of {len(unmatched)} gaze rows match no vertex and {len(off)} are off the mesh; distances in"
        f" parts of its diagonal, median {np.median(distance[unmatched]):.2%}, worst {named}. Is it the file of this"
        " mesh, in the units of the mesh file?"
    )

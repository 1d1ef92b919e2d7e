"""The thesis's network for scenes: the faces of each object at each distance, by what others needed (T3.1.3)."""

import numpy as np
import pandas as pd

from stages.kit.files import read_mesh, read_table
from stages.kit.run import DATA
from stages.salient_points import read_strong_points

from .counts import fit_counts, judge_counts, read_curves


def measured_rows():
    """The rows that the lod stage measured, of all objects. Raises ValueError where it has not run."""
    tables = [read_table(path) for path in sorted((DATA / "lod").glob("*/curve.csv"))]
    if not tables:
        raise ValueError("no data/lod/NAME/curve.csv: run `dvc repro lod`")
    return pd.concat(tables)


def judged(objects, seed):
    """Rows of `judge_counts` on all these objects."""
    meshes = {name: read_mesh(DATA / "meshes" / f"{name}.npz") for name in objects}
    points = {name: read_strong_points(DATA / "salient_points" / f"{name}.npz") for name in objects}
    curves = read_curves(measured_rows(), {name: len(mesh.faces) for name, mesh in meshes.items()})
    return judge_counts(curves, meshes, points, seed)


def learn(faces, left_out, focal, combinations, seed):
    """Counts of the thesis's network, taught by the measured curves of all objects but those of the scene.

    faces: dict object -> its own count; left_out: names; focal: pixels a unit at distance one. Raises ValueError where
    no curve is left to learn from.
    """
    rows = measured_rows()
    rows = rows[~rows["object"].isin(left_out) & rows["object"].isin(faces)]
    if not len(rows):
        raise ValueError("no object outside the scene to learn from")
    return fit_counts(read_curves(rows, faces), combinations, "network", seed, focal)


def counts_wanted(model, frames, points, diagonals, tolerance):
    """(frames, objects) f8 faces that the model answers.

    points: a number, or dict combination -> number, for each object; diagonals: metres, one an object. Distances are
    measured in diagonals of each object, as it learned them.
    """
    distance = frames.distance / diagonals
    pixels = np.full(len(distance), tolerance)
    columns = [model.faces_needed(pixels, distance[:, item], level.faces, points[item])
               for item, level in enumerate(frames.full)]  # fmt: skip
    return np.stack(columns, axis=1).astype(np.float64)

"""The thesis's network for scenes: the faces of each object at each distance, learned from other objects (T3.1.3)."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_mesh, read_table
from haptic_glance.lod.scene.frames import Frames
from stages.kit.run import Rows
from stages.salient_points import read_strong_points

from .counts import Counts, evaluate_counts, fit_counts, read_curves
from .counts.evaluate import Map
from .counts.models import Points
from .read import MESH, POINTS

CURVE = "lod/{}/curve.csv"  # of an object, below data/SET


def lod_rows(data: Path, objects: Sequence[str]) -> pd.DataFrame:
    """The rows of the lod stage for some objects. Raises ValueError where it has none."""
    paths = [data / CURVE.format(name) for name in objects]
    tables = [read_table(path, {"item": str}) for path in paths if path.exists()]
    if not tables:
        raise ValueError(f"no {data / CURVE.format('NAME')} to learn from: run `dvc repro lod@{data.name}`")
    return pd.concat(tables)


def evaluation_rows(data: Path, objects: Sequence[str], seed: int, side_by_side: Map) -> Rows:
    """Rows of `evaluate_counts` on all these objects."""
    meshes = {name: read_mesh(data / MESH.format(name)) for name in objects}
    points = {name: read_strong_points(data / POINTS.format(name)) for name in objects}
    curves = read_curves(lod_rows(data, objects), {name: len(mesh.faces) for name, mesh in meshes.items()})
    return evaluate_counts(curves, meshes, points, seed, side_by_side)


def fit_network(data: Path, objects: Sequence[str], focal: float, combinations: Sequence[str], seed: int) -> Counts:
    """The thesis's network, trained on the measured curves of some objects.

    objects: those outside the scene; focal: pixels per unit at distance one. Raises ValueError where there is no curve
    to train on.
    """
    if not objects:
        raise ValueError("no object outside the scene to train on")
    rows = lod_rows(data, objects)
    faces = {name: len(read_mesh(data / MESH.format(name)).faces) for name in objects}
    return fit_counts(read_curves(rows, faces), combinations, "network", seed, focal)


def predicted_counts(
    model: Counts, frames: Frames, points: Sequence[Points], diagonals: np.ndarray, tolerance: float
) -> np.ndarray:
    """(frames, objects) f8 face counts that the model predicts.

    points: a number, or dict combination -> number, per object; diagonals: in metres, per object. Distances are in
    diagonals of the object, as in training.
    """
    distance = frames.distance / diagonals
    pixels = np.full(len(distance), tolerance)
    columns = [
        np.asarray(model.faces_needed(pixels, distance[:, item], level.faces, points[item]))
        for item, level in enumerate(frames.full)
    ]
    return np.stack(columns, axis=1).astype(np.float64)

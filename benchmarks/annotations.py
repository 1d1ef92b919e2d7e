"""How well the marks in data/annotations agree with each other and with human gaze.

Usage: `python -m benchmarks.annotations FOLDER`, where
FOLDER: a run of the pipeline on meshes with human gaze (`make gaze` leaves one in build/gaze). Writes
reports/attention/annotations.csv, a row an object and metric:
  found     share of one pass's marks that another pass has a mark within 5 % of the diagonal of, mean over the pairs
  chance    the same against as many vertices drawn uniformly over the surface
  nss, auc  of the marks spread over the surface against the gaze, beside the same of one pass (`one`) and of `height`
"""

from itertools import permutations
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial import cKDTree

from benchmarks import arguments
from stages.kit.files import read_arrays, read_mesh, write_table
from stages.kit.rng import rng
from stages.salient_points.chance import random_vertices
from stages.salient_points.positions import height
from stages.weights.agreement import Truth, auc, nss
from stages.weights.annotate import read_marks
from stages.weights.annotate.marks import check_on_mesh
from stages.weights.lessons import SPREAD
from stages.weights.truth import spread_on_surface

OUT = Path("reports/attention/annotations.csv")
NEAR = 0.05  # of the diagonal
DRAWS = 20


def passes(path, mesh):
    """The marked vertices of each annotator, in the order of the file."""
    marks = read_marks(path)
    check_on_mesh(marks, mesh, path)
    return [group.vertex.to_numpy() for _, group in marks.groupby("annotator", sort=False)]


def found(mesh, ours, theirs):
    """The share of `ours` that has one of `theirs` near."""
    distance, _ = cKDTree(mesh.vertices[theirs]).query(mesh.vertices[ours])
    return float((distance <= NEAR * mesh.diagonal).mean())


def between(name, mesh, marked):
    """Rows of how well the passes agree with each other, and what chance gives."""
    pairs = list(permutations(marked, 2))
    chance = [
        found(mesh, ours, random_vertices(mesh, len(theirs), rng(k, f"{name} annotations")))
        for k in range(DRAWS)
        for ours, theirs in pairs
    ]
    agreed = np.mean([found(mesh, ours, theirs) for ours, theirs in pairs])
    return [(name, "passes", "found", agreed), (name, "random", "found", np.mean(chance))]


def with_gaze(name, mesh, marked, lesson):
    """Rows of how well the marks agree with where people looked."""
    truth = Truth(lesson["amounts"], lesson["density"], lesson["areas"])
    spread = [_spread(mesh, [vertices]) for vertices in marked]
    answers = [("passes", _spread(mesh, marked)), *(("one", one) for one in spread), ("height", height(mesh))]
    return [(name, who, metric.__name__, metric(values, truth)) for who, values in answers for metric in (nss, auc)]


def _spread(mesh, marked):
    counts = np.bincount(np.concatenate(marked), minlength=len(mesh.vertices)).astype(float)
    return spread_on_surface(mesh, counts, SPREAD * mesh.diagonal)


def main():
    folder = Path(arguments(__doc__, "folder").folder) / "data"
    rows = []
    for path in sorted(Path("data/annotations").rglob("*.csv")):
        gaze = path.parent.name == "gaze"
        name = path.stem
        mesh = read_mesh((folder if gaze else Path("data")) / f"meshes/{name}.npz")
        marked = passes(path, mesh)
        found_rows = between(name, mesh, marked)
        if gaze:
            found_rows += with_gaze(name, mesh, marked, read_arrays(folder / f"weights/lessons/{name}.npz"))
        rows += [("gaze" if gaze else "household", *row) for row in found_rows]
    frame = pd.DataFrame(rows, columns=["dataset", "object", "method", "metric", "value"])
    frame = frame.groupby(["dataset", "object", "method", "metric"], sort=False, as_index=False).value.mean()
    write_table(OUT, frame)
    print(frame.groupby(["dataset", "method", "metric"]).value.mean().round(3).to_string())


if __name__ == "__main__":
    main()

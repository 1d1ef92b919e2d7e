"""Measures how well the marks in data/annotations agree with each other and with human gaze.

Reads data/annotations (data/annotations/gaze for meshes with human gaze), data/SET/meshes and, for the gaze,
data/SET/weights. Writes reports/measurements/SET/annotations.csv.gz, rows per object and metric:
  found     share of one pass's marks with a mark of another pass nearby, mean over the pairs
            (method `random`: the same against as many vertices drawn uniformly over the surface)
  nss, auc  of the marks spread over the surface against the gaze, beside the same of one pass (`one`) and of `height`
"""

import functools
from itertools import permutations
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.files import read_arrays, read_mesh
from haptic_glance.base.rng import rng
from haptic_glance.look.agreement import GroundTruth, auc, nss
from haptic_glance.look.marks import check_on_mesh, read_marks
from haptic_glance.look.points.detectors import height, random_vertices
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes import Params as MeshesParams
from stages.weights.ground_truth import spread_on_surface
from stages.weights.training import SPREAD

from . import Params


def process(name: str, folder: Path, data: Path, marks: Path, gaze: bool, settings: Params, seed: int) -> Rows:
    """Rows of one object. marks: folder of the marks; gaze: whether data/SET/weights holds the gaze on its mesh."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    marked = passes(marks / f"{name}.csv", mesh)
    rows = agreement_of_passes(name, mesh, marked, settings, seed)
    if gaze:
        arrays = read_arrays(data / "weights/ground_truth" / f"{name}.npz")
        rows += agreement_with_gaze(mesh, marked, GroundTruth(arrays["amounts"], arrays["density"], arrays["areas"]))
    return [{"item": name} | row for row in rows]


def passes(path: Path, mesh: Mesh) -> list[np.ndarray]:
    """The marked vertices of each annotator, in the order of the file."""
    marks = read_marks(path)
    check_on_mesh(marks.vertex, marks[["x", "y", "z"]], mesh, path)
    return [group.vertex.to_numpy() for _, group in marks.groupby("annotator", sort=False)]


def found_share(mesh: Mesh, ours: np.ndarray, theirs: np.ndarray, near: float) -> float:
    """The share of `ours` that has one of `theirs` within `near`, a share of the diagonal."""
    distance, _ = KDTree(mesh.vertices[theirs]).query(mesh.vertices[ours])
    return float((distance <= near * mesh.diagonal).mean())


def agreement_of_passes(name: str, mesh: Mesh, marked: list[np.ndarray], settings: Params, seed: int) -> list[dict]:
    """Rows of how well the passes agree with each other, and what chance gives."""
    pairs = list(permutations(marked, 2))
    chance = [
        found_share(mesh, ours, random_vertices(mesh, len(theirs), rng(number, f"{name} annotations")), settings.near)
        for number in range(seed * settings.draws, (seed + 1) * settings.draws)
        for ours, theirs in pairs
    ]
    agreed = [found_share(mesh, ours, theirs, settings.near) for ours, theirs in pairs]
    means = {"passes": float(np.mean(agreed)), "random": float(np.mean(chance))}
    return [{"method": method, "metric": "found", "value": value} for method, value in means.items()]


def agreement_with_gaze(mesh: Mesh, marked: list[np.ndarray], truth: GroundTruth) -> Rows:
    """Rows of how well all marks, those of one pass (the mean over the passes), and height agree with gaze."""
    answers = {
        "passes": [_spread(mesh, np.concatenate(marked))],
        "one": [_spread(mesh, vertices) for vertices in marked],
        "height": [height(mesh)],
    }
    return [
        {
            "method": method,
            "metric": metric.__name__,
            "value": float(np.mean([metric(saliency, truth) for saliency in values])),
        }
        for method, values in answers.items()
        for metric in (nss, auc)
    ]


def _spread(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    counts = np.bincount(vertices, minlength=len(mesh.vertices)).astype(float)
    return spread_on_surface(mesh, counts, SPREAD * mesh.diagonal)


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, gaze = workspace.settings(Params), workspace.settings(MeshesParams).source == "gaze"
    marks = workspace.root / "data/annotations" / ("gaze" if gaze else "")
    reads = ["meshes/{}.npz", "../annotations/gaze/{}.csv" if gaze else "../annotations/{}.csv"]
    reads += ["weights/ground_truth/{}.npz"] if gaze else []
    with StageRun(workspace, "annotations", inputs=("meshes", "weights")) as stage:
        names = [name for name in stage.objects if (marks / f"{name}.csv").exists()]
        work = functools.partial(
            process, data=workspace.data, marks=marks, gaze=gaze, settings=settings, seed=stage.seed
        )
        stage.each(work, names, reads=reads)
        stage.metrics(summary(stage.rows))
    print(f"annotations: {workspace.dataset}, {len(names)} objects with marks")


def summary(rows: Rows) -> dict[str, float]:
    """{metric.method: the mean over the objects}."""
    return named_means((f"{row['metric']}.{row['method']}", row["value"]) for row in rows)


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "annotations"))

"""Finds the salient points of each object by each method (T3.1.2, T3.2.5, T3.2.6), and how well they agree with people.

Reads data/SET/meshes, data/SET/conspicuity, data/SET/weights. Writes data/SET/salient_points/NAME.npz: for each method
METHOD the arrays METHOD.points (k,) vertex ids, most salient first; METHOD.strong (), how many leading ones pass the
method's own threshold; METHOD.saliency (n,) in 0..1, absent for `random` and `farthest`. In
reports/measurements/SET/salient_points.csv.gz, saliency_at_points is read on one map for all methods, that of the first
method that has one; cc, nss, auc, sim, kl and fne, fpe, wme are there for objects with ground truth; seconds include
the reading of the maps that the methods share.
"""

import functools
import sys
from pathlib import Path

from haptic_glance.base.files import read_arrays, read_mesh
from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.points.methods import find_all, method_named, split_runnable
from haptic_glance.look.points.options import Options
from haptic_glance.look.weights import read_learned_weights
from stages.conspicuity.measure import read_view_maps
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import Params
from .measure import agreement_rows, measurement_rows, summary, write_points

# Of the learned weights, what applies to an object: without ground truth in the set nothing here depends on the others.
READS = (
    "meshes/{}.npz", "conspicuity/{}.npz", "weights/weights.csv", "weights/ground_truth/{}.npz",
    "weights/convexity.csv", "weights/svm.npz", "weights/svm",
)  # fmt: skip


def process(name: str, folder: Path, data: Path, settings: Params, seed: int) -> Rows:
    """Finds, writes, measures and judges the points of one object by all methods."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    learned = read_learned_weights(data / "weights", name, mesh)
    methods, _ = split_runnable(settings.methods, learned)
    options = Options(learned, settings.selection, settings.radius, settings.smoothing, seed, name)
    with Stopwatch() as reading:
        maps = read_view_maps(data / "conspicuity" / f"{name}.npz", mesh)
    detections, seconds = find_all(mesh, maps, methods, options, settings.count)
    write_points(folder / f"{name}.npz", detections)
    standard = next((result.saliency for result in detections.values() if result.saliency is not None), None)
    cost = {
        method: seconds[method] + (reading.seconds if method_named(method).channels else 0) for method in detections
    }
    rows = [
        row
        for method, result in detections.items()
        for row in measurement_rows(name, method, result, mesh, standard, cost[method])
    ]
    ground_truth = data / "weights" / "ground_truth" / f"{name}.npz"
    if ground_truth.exists():
        agreed = agreement_rows(mesh, read_arrays(ground_truth), detections)
        rows += [{"item": name, "seconds": cost.get(row["method"])} | row for row in agreed]
    return rows


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    for method in settings.methods:
        method_named(method)
    if settings.count < 1 or not settings.methods:
        raise ValueError("salient_points: count must be 1 or more, and methods name at least one")
    with StageRun(workspace, "salient_points", inputs=("meshes", "conspicuity", "weights")) as stage:
        work = functools.partial(process, data=workspace.data, settings=settings, seed=stage.seed)
        rows = stage.each(work, stage.objects, READS)
        stage.metrics(summary(rows))
    methods = {row["method"] for row in rows}
    idle = [method for method in settings.methods if method not in methods]
    if idle:
        print(f"salient_points: left out for want of ground truth to learn from: {', '.join(idle)}", file=sys.stderr)
    count = sum(row["value"] for row in rows if row["metric"] == "points")
    print(
        f"salient_points: {workspace.dataset}, {len(stage.objects)} objects, "
        f"{len(settings.methods) - len(idle)} methods, {count:.0f} points"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "salient_points"))

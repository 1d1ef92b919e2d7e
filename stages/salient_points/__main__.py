"""Finds the salient points of each object by each method (T3.1.2, T3.2.5, T3.2.6).

Reads data/meshes, data/conspicuity, data/weights. Writes data/salient_points/NAME.npz: for each method METHOD the
arrays METHOD.points (k,) vertex ids, most salient first; METHOD.strong (), how many leading ones pass the 90 %
threshold; METHOD.saliency (n,) in 0..1, absent for `random`. In reports/measurements/salient_points.csv,
saliency_at_points is read on one map for all methods, that of the first method that has one; seconds include the sight
that the methods share.
"""

import functools

from stages.conspicuity import read_sight
from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.files import read_mesh
from stages.kit.run import DATA
from stages.weights import chosen_weights

from .measure import rows_of, summary
from .methods import find_all, method_named
from .options import Options
from .storage import write_found


def process(name, folder, settings, weights, seed):
    """Finds, writes and measures the points of one object by all methods."""
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    options = Options(weights, settings.selection, settings.radius, settings.smoothing, seed, name)
    with Stopwatch() as looking:
        sight = read_sight(DATA / "conspicuity" / f"{name}.npz", mesh)
    found, seconds = find_all(mesh, sight, settings.methods, options, settings.count)
    write_found(folder / f"{name}.npz", found)
    judge = next((result.saliency for result in found.values() if result.saliency is not None), None)
    shared = {method: looking.seconds if method_named(method).channels else 0.0 for method in found}
    return [
        row
        for method, result in found.items()
        for row in rows_of(name, method, result, mesh, judge, seconds[method] + shared[method])
    ]


def main():
    arguments(__doc__)
    settings = params("salient_points")
    for method in settings.methods:
        method_named(method)
    if settings.count < 1 or not settings.methods:
        raise ValueError("salient_points: count must be 1 or more, and methods name at least one")
    with StageRun("salient_points", inputs=("meshes", "conspicuity", "weights")) as run:
        weights = chosen_weights(DATA / "weights" / "weights.csv")
        work = functools.partial(process, settings=settings, weights=weights, seed=run.seed)
        rows = run.each(work, run.objects)
        run.metrics(summary(rows))
    found = sum(row["value"] for row in rows if row["metric"] == "points")
    print(f"salient_points: {len(run.objects)} objects, {len(settings.methods)} methods, {found:.0f} points")


if __name__ == "__main__":
    main()

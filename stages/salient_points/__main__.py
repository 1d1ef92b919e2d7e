"""Finds the salient points of each object by each method (T3.1.2, T3.2.5, T3.2.6), and how well they agree with people.

Reads data/meshes, data/conspicuity, data/weights. Writes data/salient_points/NAME.npz: for each method METHOD the
arrays METHOD.points (k,) vertex ids, most salient first; METHOD.strong (), how many leading ones pass the method's own
threshold; METHOD.saliency (n,) in 0..1, absent for `random` and `farthest`. In reports/measurements/salient_points.csv,
saliency_at_points is read on one map for all methods, that of the first method that has one; cc, nss, auc, sim, kl and
fne, fpe, wme are there for objects with ground truth; seconds include the sight that the methods share.
"""

import functools
import sys

from stages.conspicuity import read_sight
from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.files import read_arrays, read_mesh
from stages.kit.run import DATA
from stages.weights import learned_for

from .judge import judged
from .measure import rows_of, summary
from .methods import find_all, method_named, teachable
from .options import Options
from .storage import write_found


def process(name, folder, settings, seed):
    """Finds, writes, measures and judges the points of one object by all methods."""
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    learned = learned_for(DATA / "weights", name, mesh)
    methods, _ = teachable(settings.methods, learned)
    options = Options(learned, settings.selection, settings.radius, settings.smoothing, seed, name)
    with Stopwatch() as looking:
        sight = read_sight(DATA / "conspicuity" / f"{name}.npz", mesh)
    found, seconds = find_all(mesh, sight, methods, options, settings.count)
    write_found(folder / f"{name}.npz", found)
    standard = next((result.saliency for result in found.values() if result.saliency is not None), None)
    shared = {method: looking.seconds if method_named(method).channels else 0.0 for method in found}
    rows = [
        row
        for method, result in found.items()
        for row in rows_of(name, method, result, mesh, standard, seconds[method] + shared[method])
    ]
    lesson = DATA / "weights" / "lessons" / f"{name}.npz"
    if lesson.exists():
        cost = {method: seconds[method] + shared[method] for method in found}
        agreed = judged(mesh, read_arrays(lesson), found)
        rows += [{"object": name, "seconds": cost.get(row["method"])} | row for row in agreed]
    return rows


def main():
    arguments(__doc__)
    settings = params("salient_points")
    for method in settings.methods:
        method_named(method)
    if settings.count < 1 or not settings.methods:
        raise ValueError("salient_points: count must be 1 or more, and methods name at least one")
    with StageRun("salient_points", inputs=("meshes", "conspicuity", "weights")) as run:
        work = functools.partial(process, settings=settings, seed=run.seed)
        rows = run.each(work, run.objects)
        run.metrics(summary(rows))
    ran = {row["method"] for row in rows}
    idle = [method for method in settings.methods if method not in ran]
    if idle:
        print(f"salient_points: left out for want of ground truth to learn from: {', '.join(idle)}", file=sys.stderr)
    found = sum(row["value"] for row in rows if row["metric"] == "points")
    print(
        f"salient_points: {len(run.objects)} objects, {len(settings.methods) - len(idle)} methods, {found:.0f} points"
    )


if __name__ == "__main__":
    main()

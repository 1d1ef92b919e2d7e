"""Where networks look on an object while they name its kind: Grad-CAM attention of six tasks, fused (T3.3).

Reads data/meshes, data/weights (people's attention), data/salient_points (the rivals) and data/reference/semantics.csv.
Takes pictures of each object from all round, groups the objects by convexity, Gaussian curvature and eccentricity and
by three levels of meaning, teaches a head a task on each network of fixation.methods, and projects the maps of all
tasks and of their entropy-weighted mean to the vertices. Writes data/fixation: NAME.npz (see
stages.fixation.read_attention), tasks.csv (the class of every object in every task, and its measures), elbow.csv (sums
of squared distances over the number of clusters), heads/METHOD/TASK.npz.
"""

import functools
import shutil
import sys
import warnings

import pandas as pd

from stages.kit import StageRun, arguments, params
from stages.kit.files import write_table

from . import attend, backbone, finetune, heads, pictures
from .options import available, checked
from .summary import summary, verdicts
from .tasks import all_tasks
from .viewpoints import sphere

HIDDEN = (".pictures", ".maps", ".pooled", ".networks", ".cams")  # caches that a killed run goes on from


def measured(rows):
    """dict object -> dict measure -> value."""
    found = {}
    for row in rows:
        found.setdefault(row["object"], {})[row["metric"]] = row["value"]
    return found


def write_tasks(folder, measures, tasks, curves):
    """Writes tasks.csv and elbow.csv."""
    classes = {f"{task}_class": pd.Series(known) for task, known in tasks.items()}
    table = pd.DataFrame(measures).T.assign(**classes)
    write_table(folder / "tasks.csv", table.rename_axis("object").reset_index())
    rows = [
        {"task": task, "clusters": k, "ssd": ssd, "chosen": k == chosen}
        for task, (curve, chosen) in curves.items()
        for k, ssd in curve.items()
    ]
    write_table(folder / "elbow.csv", pd.DataFrame(rows, columns=["task", "clusters", "ssd", "chosen"]))


def learn(run, settings, method, objects, tasks):
    """All that one method learns and sees, before the maps are put on the surface."""
    given = {"settings": settings, "seed": run.seed}
    name = method.name
    if method.mode == "finetuned":
        run.each(functools.partial(finetune.train, tasks=tasks, **given), [f"{name}@{task}" for task in tasks])
        return run.each(functools.partial(finetune.look, tasks=tasks, **given), [f"{name}@{one}" for one in objects])
    if method.mode == "random":
        run.each(functools.partial(backbone.prepare, objects=objects, **given), [f"{name}@network"])
    run.each(functools.partial(backbone.look, **given), [f"{name}@{one}" for one in objects])
    return run.each(functools.partial(heads.teach, tasks=tasks, **given), [f"{name}@{task}" for task in tasks])


def main():
    arguments(__doc__)
    settings = params("fixation")
    # Torch's caches make a worker grow; joblib then renews it between two items, loses none, and warns.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
    checked(settings)
    views = len(sphere(settings.parallels, settings.azimuths))
    methods, missing = available(settings)
    with StageRun("fixation", inputs=("meshes", "salient_points", "weights")) as run:
        objects = run.objects
        shapes = run.each(functools.partial(pictures.take, settings=settings), [f"shape@{one}" for one in objects])
        measures = measured(shapes)
        tasks, curves = all_tasks(measures, run.dataset, run.seed)
        write_tasks(run.folder, measures, tasks, curves)
        for method in methods:
            learn(run, settings, method, objects, tasks)
        see = functools.partial(
            attend.attend, settings=settings, methods=[one.name for one in methods], tasks=tasks, seed=run.seed
        )
        run.each(see, [f"object@{one}" for one in objects])
        run.rows += [{"method": name, "metric": "accuracy", "note": reason} for name, reason in missing.items()]
        run.metrics(summary(run.rows, {task: len(set(known.values())) for task, known in tasks.items()}, run.seed))
        for line in verdicts(pd.DataFrame(run.rows), run.seed):
            print(f"fixation: {line}", file=sys.stderr)
        for cache in HIDDEN:
            shutil.rmtree(run.folder / cache, ignore_errors=True)
    print(f"fixation: {len(objects)} objects, {views} views, tasks {', '.join(tasks)}, {len(methods)} methods")


if __name__ == "__main__":
    main()

"""Finds where networks look on an object while they name its kind: Grad-CAM attention of six tasks, fused (T3.3).

Reads data/SET/meshes, data/SET/weights (people's attention), data/SET/salient_points (the rivals) and
data/reference/semantics.csv. Takes pictures of each object from all round, groups the objects by convexity, Gaussian
curvature and eccentricity and by three levels of meaning, trains a head per task on each network of fixation.methods,
or a network per task, and projects the maps of all tasks and of their entropy-weighted mean to the vertices. Writes
data/SET/fixation: NAME.npz (below), heads/METHOD/TASK.npz of frozen and random networks. The rows are in
reports/measurements/SET/fixation.csv.gz; they also hold the class of every object in every task, its measures, and the
sums of squared distances over the number of clusters.

NAME.npz has METHOD.TASK (n,) f2, the attention at the vertices in 0..1; METHOD.TASK.views (3, n), that in each of the
three evaluated views; METHOD.maps (3, t, i, j), their Grad-CAM maps in the order of the tasks in the rows; visible
(3, n), the vertices visible in each of them; seen (n,), the vertices visible in any view.
"""

import dataclasses
import functools
import shutil
from collections.abc import Mapping

from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes import Params as Meshes

from . import COLUMNS, Params, attention, backbone, finetune
from .agreement import summary
from .backbone import TRAINED, Method, available, check
from .tasks import SEMANTICS, assign_classes, viewpoint_sphere

HIDDEN = (".pictures", ".maps", ".pooled", ".networks", ".trunk", ".rates", ".cams")  # what one step hands to the next
PICTURES, ALL_PICTURES = "fixation/.pictures/{}.npz", "fixation/.pictures"
NETWORK, POOLED = "fixation/.networks/{}.npz", "fixation/.pooled"
TRUNK, RATE = "fixation/.trunk/{}", "fixation/.rates/{}.npz"


def task_rows(tasks: Mapping[str, Mapping[str, str]], curves: Mapping[str, tuple[dict[int, float], int]]) -> Rows:
    """Rows of the class of every object in every task, and of the sums of squared distances over the clusters."""
    rows: Rows = [
        {"item": name, "task": task, "metric": "class", "label": label}
        for task, classes in tasks.items()
        for name, label in classes.items()
    ]
    for task, (curve, elbow_count) in curves.items():
        row = {"task": task, "metric": "ssd"}
        rows += [row | {"clusters": k, "chosen": bool(k == elbow_count), "value": ssd} for k, ssd in curve.items()]
    return rows


def train(
    stage: StageRun, method: Method, settings: Params, objects: list[str], tasks: Mapping[str, Mapping[str, str]]
) -> None:
    """Trains the heads or networks of one method and computes its maps, before these are projected to the vertices."""
    common = {"made": stage.folder, "method": method, "settings": settings, "seed": stage.seed}
    if method.mode in TRAINED:
        inputs = [ALL_PICTURES]
        if method.mode == "last_block":
            stage.each(functools.partial(backbone.cache_trunk, **common), objects, [PICTURES])
            inputs = [TRUNK.format(method.name), RATE.format(method.name)]
            choose = functools.partial(finetune.choose_rate, objects=objects, tasks=tasks, **common)
            stage.each(choose, [method.name], inputs[:1])
        learn = functools.partial(finetune.train_network, objects=objects, tasks=tasks, **common)
        stage.each(learn, tasks.keys(), inputs)
        return
    if method.mode == "random":
        prepare = functools.partial(backbone.prepare_random_network, objects=objects, **common)
        stage.each(prepare, [method.name], [ALL_PICTURES])
    reads = [PICTURES, NETWORK.format(method.name)]  # only a random method has one
    stage.each(functools.partial(backbone.compute_maps, **common), objects, reads)
    fit = functools.partial(finetune.train_head, objects=objects, tasks=tasks, **common)
    stage.each(fit, tasks.keys(), [f"{POOLED}/{method.name}"])


def made_by(method: Method) -> list[str]:
    """The files of `train` that the attention on an object is computed from."""
    if method.mode in TRAINED:
        return [f"fixation/.cams/{method.name}"]
    return [f"fixation/.maps/{method.name}/{{}}.npz", f"fixation/heads/{method.name}"]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    check(settings)
    views = len(viewpoint_sphere(settings.parallels, settings.azimuths))
    methods, missing = available(settings)
    data, common = workspace.data, dataclasses.replace(settings, methods=[])  # what an object or one method depends on
    with StageRun(workspace, "fixation", COLUMNS, inputs=("meshes", "salient_points", "weights")) as stage:
        objects, seed = stage.objects, stage.seed
        take = functools.partial(backbone.take_pictures, data=data, settings=common)
        measures: dict[str, dict[str, float]] = {}  # of each object's shape
        for row in stage.each(take, objects, reads=("meshes/{}.npz",)):
            measures.setdefault(row["item"], {})[row["metric"]] = row["value"]
        source = workspace.settings(Meshes).source
        tasks, curves = assign_classes(measures, source, seed, workspace.root / SEMANTICS)
        if not tasks:
            raise ValueError("fixation: no task has two classes: give two objects or more")
        stage.rows += task_rows(tasks, curves)
        for method in methods:
            train(stage, method, common, objects, tasks)
        measure = functools.partial(
            attention.measure_attention,
            data=data, made=stage.folder, settings=common, methods=methods, tasks=tasks, seed=seed,
        )  # fmt: skip
        reads = ["meshes/{}.npz", "salient_points/{}.npz", "weights/ground_truth/{}.npz", PICTURES]
        stage.each(measure, objects, [*reads, *(path for method in methods for path in made_by(method))])
        stage.rows += [{"method": name, "metric": "accuracy", "note": reason} for name, reason in missing.items()]
        stage.metrics(summary(stage.rows, {task: len(set(classes.values())) for task, classes in tasks.items()}, seed))
        for cache in HIDDEN:
            shutil.rmtree(stage.folder / cache, ignore_errors=True)
    print(f"fixation: {len(objects)} objects, {views} views, tasks {', '.join(tasks)}, {len(methods)} methods")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "fixation"))

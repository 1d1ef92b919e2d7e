"""Finds the smallest pressure array that recognises classes of objects (T4.3.2, figure 4.11).

Reads data/SET/meshes and data/SET/salient_points, presses arrays of every number of cells and every pitch at the
salient points of each object, and tests each classifier on objects that it was not trained on. Writes
reports/measurements/SET/sensor_size.csv.gz: one row per array, classifier, split and tested object, and one per
classifier: the smallest array that is sufficient, and how often the same one is chosen when the objects are drawn anew.
"""

import functools
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import fmean
from typing import Any

import numpy as np
from sklearn import config_context
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_mesh
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.split import Split
from haptic_glance.touch import press_many, touchable, warm_up
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_metrics
from stages.meshes.collect import read_classes
from stages.salient_points.measure import read_points, read_saliency

from . import COLUMNS, Params
from .protocol import ARRAY, TOUCHES, choice_repeatability, drawn_sets, evaluate, sample_vertices, smallest_sufficient


def process(item: str, folder: Path, data: Path, classes: Mapping[str, list[str]], settings: Params, seed: int) -> Rows:
    """One array, CELLS-PITCH, two of them joined by +, or one with :EXTENT behind it: the rows of all classifiers.

    Presses it on every object.
    """
    array, _, extent = item.partition(":")
    arrays = [parts(part) for part in array.split("+")]
    (cells, pitch), fine = arrays[0], "+".join(array.split("+")[1:])
    warm_up()
    imprints: dict[str, np.ndarray] = {}
    rows = []
    for label, names in classes.items():
        for name in names:
            with Stopwatch() as watch:
                imprints[name] = touch(name, data, arrays, extent, settings, seed)
            cost = {"metric": "seconds_a_touch", "value": watch.seconds / len(imprints[name]), "seconds": watch.seconds}
            rows.append({"group": label, "item": name, **cost})
    drawn = dict(enumerate(drawn_sets(classes, settings.drawn, seed), 1))
    # One thread gives equal sums on any number of cores. The fits of trees are so small that checks would take longer.
    with threadpool_limits(1), config_context(assume_finite=True, skip_parameter_validation=True):
        for number, members in (drawn or {None: classes}).items():
            samples = {label: [imprints[name] for name in names] for label, names in members.items()}
            for row in evaluate(samples, settings.classifiers, seed, TOUCHES if extent else 1):
                rows.append(row | {"item": members[row["group"]][row["item"]], "set": number})
    common = {"method": settings.method, "cells": cells, "pitch": pitch, "touches": settings.touches}
    common |= {"fine": fine or None, "extent": extent or None}
    return [common | row for row in rows]


def parts(item: str) -> tuple[int, float]:
    """(cells along each side, pitch) of an item's name."""
    cells, _, pitch = item.partition("-")
    return int(cells), float(pitch)


def touch(
    name: str, data: Path, arrays: Sequence[tuple[int, float]], extent: str, settings: Params, seed: int
) -> np.ndarray:
    """(k, values) imprints of one object at its most salient points that can be touched. data: data/SET.

    arrays: (cells a side, pitch) of those whose imprints of a place stand side by side; extent: where the touches of a
    sample lie, empty for one touch a sample.
    """
    mesh, points = read_mesh(data / f"meshes/{name}.npz"), read_points(data / f"salient_points/{name}.npz")
    if settings.method not in points:
        names = ", ".join(points)
        raise ValueError(f"sensor_size.method={settings.method} is not among salient_points.methods: {names}")
    vertices = points[settings.method][: settings.touches]
    vertices = vertices[touchable(mesh, vertices)]
    if extent:
        saliency = read_saliency(data / f"salient_points/{name}.npz")[settings.method]
        vertices = sample_vertices(mesh, saliency, vertices, extent, rng(seed, f"{extent} {name}"))
    imprints = [press_many(mesh, vertices, (cells, cells), pitch) for cells, pitch in arrays]
    return np.concatenate([images.reshape(len(vertices), -1) for images in imprints], axis=1)


def chosen_classes(classes: Mapping[str, list[str]], names: Sequence[str]) -> dict[str, list[str]]:
    """The classes that the settings name, all when they name none; without those that have a single object."""
    missing = [name for name in names if name not in classes]
    if missing:
        raise ValueError(
            f"sensor_size.classes: no {', '.join(missing)} in meshes.classes; there are {', '.join(classes)}"
        )
    return {name: classes[name] for name in names or classes if len(classes[name]) > 1}


def summary(rows: Rows, slack: float, seed: int) -> dict[str, Any]:
    """{classifier: {smallest, arrays: {CELLS-PITCH: {mean, low, high}}}} over the objects left out.

    An object of several drawn sets counts once, with its mean.
    """
    values: defaultdict[str, defaultdict[tuple[int, float], defaultdict[str, list[float]]]]
    values = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    tree = {}
    for row in rows:
        single = not (row.get("fine") or row.get("extent"))
        if single and row["metric"] == "accuracy" and row["split"] == Split.OBJECTS:
            values[row["classifier"]][row["cells"], row["pitch"]][row["item"]].append(row["value"])
    for name, of_arrays in sorted(values.items()):
        scores = {array: list(map(fmean, items.values())) for array, items in of_arrays.items()}
        arrays = {}
        for array, accuracies in sorted(scores.items()):
            arrays["{}-{}".format(*array)] = interval_metrics(accuracies, seed)
        means = {parts(item): value["mean"] for item, value in arrays.items()}
        cells, pitch = smallest_sufficient(means, slack)
        repeatability = round(choice_repeatability(scores, slack, seed), 6)
        smallest = {"cells": cells, "pitch": pitch, "accuracy": means[cells, pitch], "again": repeatability}
        tree[name] = {"arrays": arrays, "smallest": smallest}
    return tree


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    with StageRun(workspace, "sensor_size", COLUMNS, inputs=("meshes", "salient_points")) as stage:
        classes = chosen_classes(read_classes(workspace.data / "meshes"), settings.classes)
        items = [f"{cells}-{pitch}" for cells in settings.cells for pitch in settings.pitches]
        items += [*settings.pairs, *(f"{ARRAY}:{extent}" for extent in settings.extents)]
        work = functools.partial(process, data=workspace.data, classes=classes, settings=settings, seed=stage.seed)
        rows = stage.each(work, items, reads=("meshes", "salient_points"))
        tree = summary(rows, settings.slack, stage.seed)
        stage.metrics(
            {name: entry["arrays"] for name, entry in tree.items()}
        )  # the smallest one is a choice, often luck
        smallest = [{"classifier": name} | entry["smallest"] for name, entry in tree.items()]
        keys = ("classifier", "cells", "pitch")
        repeat_rows = [{key: entry[key] for key in keys} | {"value": entry["again"]} for entry in smallest]
        stage.rows += [entry | {"metric": "smallest_chosen_again"} for entry in repeat_rows]
    for entry in smallest:
        print("sensor_size: {classifier} needs {cells} x {cells} cells, {pitch} apart: {accuracy:.3f}".format(**entry))


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "sensor_size"))

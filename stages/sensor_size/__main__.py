"""Finds the smallest pressure array that tells classes of objects apart (T4.3.2, figure 4.11).

Reads data/classes, presses arrays of every number of cells and every pitch at the salient points of each object, and
tests each classifier on objects that it never touched. Writes data/sensor_size/smallest.csv (the smallest array that
is enough, a row a classifier, and how often the same one is chosen when the objects are drawn anew),
reports/measurements/sensor_size.csv (one row an object left out) and reports/metrics/sensor_size.json.
"""

import functools
from collections import defaultdict

import pandas as pd
from threadpoolctl import threadpool_limits

from stages.classes import read_classes, read_object
from stages.imprints import press_many, touchable, warm_up
from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.files import write_table
from stages.kit.run import DATA
from stages.kit.stats import interval_metrics

from .protocol import evaluate
from .smallest import chosen_again, smallest_enough


def process(item, folder, classes, source, settings, seed):
    """One array, CELLS-PITCH: presses it on every object and tests all classifiers; the rows."""
    cells, pitch = parts(item)
    warm_up()
    with Stopwatch() as watch:
        imprints = {one: [touch(name, cells, pitch, settings) for name in names] for one, names in classes.items()}
    count = sum(len(images) for objects in imprints.values() for images in objects)
    rows = [{"metric": "seconds_a_touch", "value": watch.seconds / count, "seconds": watch.seconds}]
    with threadpool_limits(1):  # equal sums on any number of cores
        rows += evaluate(imprints, settings.classifiers, seed)
    for row in rows[1:]:
        row["tested"] = classes[row["class"]][row["tested"]]
    common = {"object": source, "method": settings.method, "cells": cells, "pitch": pitch, "touches": settings.touches}
    return [common | row for row in rows]


def parts(item):
    """(cells a side, pitch) of an item's name."""
    cells, _, pitch = item.partition("-")
    return int(cells), float(pitch)


def touch(name, cells, pitch, settings):
    """(k, cells, cells) imprints of one object at its most salient points that can be touched."""
    mesh, points = read_object(DATA / "classes" / f"{name}.npz")
    if settings.method not in points:
        raise ValueError(f"sensor_size.method={settings.method} is not among classes.methods: {', '.join(points)}")
    chosen = points[settings.method][: settings.touches]
    return press_many(mesh, chosen[touchable(mesh, chosen)], (cells, cells), pitch)


def chosen_classes(found, wanted):
    """The classes that the settings name, all when they name none; those with one object alone are left out."""
    missing = [one for one in wanted if one not in found]
    if missing:
        raise ValueError(f"sensor_size.classes: no {', '.join(missing)} in data/classes; there are {', '.join(found)}")
    return {one: found[one] for one in wanted or found if len(found[one]) > 1}


def summary(rows, slack, seed):
    """{classifier: {smallest, arrays: {CELLS-PITCH: {mean, low, high}}}} over the objects left out."""
    values, tree = defaultdict(lambda: defaultdict(list)), {}
    for row in rows:
        if row["metric"] == "accuracy":
            values[row["classifier"]][row["cells"], row["pitch"]].append(row["value"])
    for name, scores in sorted(values.items()):
        arrays = {}
        for array, found in sorted(scores.items()):
            arrays["{}-{}".format(*array)] = interval_metrics(found, seed)
        means = {parts(item): value["mean"] for item, value in arrays.items()}
        cells, pitch = smallest_enough(means, slack)
        again = round(chosen_again(scores, slack, seed), 6)
        smallest = {"cells": cells, "pitch": pitch, "accuracy": means[cells, pitch], "again": again}
        tree[name] = {"arrays": arrays, "smallest": smallest}
    return tree


def main():
    arguments(__doc__)
    settings, source = params("sensor_size"), params("classes").source
    with StageRun("sensor_size", inputs=("classes",)) as run:
        run.dataset = source
        classes = chosen_classes(read_classes(DATA / "classes"), settings.classes)
        items = [f"{cells}-{pitch}" for cells in settings.cells for pitch in settings.pitches]
        work = functools.partial(process, classes=classes, source=source, settings=settings, seed=run.seed)
        rows = run.each(work, items)
        found = summary(rows, settings.slack, run.seed)
        run.metrics({name: one["arrays"] for name, one in found.items()})  # the smallest one is a choice, often luck
        smallest = [{"classifier": name} | one["smallest"] for name, one in found.items()]
        write_table(run.folder / "smallest.csv", pd.DataFrame(smallest))
    for one in smallest:
        print("sensor_size: {classifier} needs {cells} x {cells} cells, {pitch} apart: {accuracy:.3f}".format(**one))


if __name__ == "__main__":
    main()

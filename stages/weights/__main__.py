"""Learns the weight of each conspicuity channel from where people look or mark (T3.2.1 to T3.2.3).

Reads data/meshes, data/conspicuity and the ground truth: data/annotations/NAME.csv, or what comes with the collection
(gaze, interest points). Writes data/weights: weights.csv (method, channel, weight, left_out: the object that this row
has not seen), lessons/NAME.npz (the ground truth on the vertices and all that the learning takes from an object),
svm.npz, svm/NAME.npz, convexity.csv. Objects without ground truth are left alone; with none at all only the published
weights are written. Settings: section `weights` of params.yaml.
"""

import functools
import sys

import numpy as np
import pandas as pd

from stages.conspicuity import read_sight
from stages.kit import StageRun, arguments, params
from stages.kit.files import read_arrays, read_mesh, write_arrays, write_table
from stages.kit.parallel import parallel_map
from stages.kit.run import DATA

from .convexity import convexity
from .lessons import lesson
from .table import weight_table
from .train import train_all, train_object
from .truth import truth_of


def process(name, folder, source, place, seed):
    """Takes the lesson of one object that has ground truth; a row of how many points it has, or why it is left out."""
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    path = DATA / "conspicuity" / f"{name}.npz"
    try:
        amounts = truth_of(name, source, mesh, place)
        if amounts is None or not amounts.any():
            return []
        found = lesson(name, mesh, read_sight(path, mesh), path, amounts, seed)
        row = {"object": name, "metric": "points", "value": len(found["points"]), "convexity": convexity(mesh)}
    except ValueError as error:  # marks of another mesh of this name, for example: the others still teach
        return [{"object": name, "metric": "points", "value": None, "note": str(error)}]
    write_arrays(folder / "lessons" / f"{name}.npz", **found)
    return [row]


def main():
    arguments(__doc__)
    chosen, meshes = params("weights").method, params("meshes")
    with StageRun("weights", inputs=("meshes", "conspicuity", "annotations")) as run:
        take = functools.partial(process, source=meshes.source, place=meshes.folder, seed=run.seed)
        rows = run.each(take, run.objects)
        taken = [row for row in rows if "note" not in row]
        for row in rows:
            if "note" in row:
                print(f"weights: {row['object']} is left out: {row['note']}", file=sys.stderr)
        lessons = {row["object"]: read_arrays(run.folder / "lessons" / f"{row['object']}.npz") for row in taken}
        table = weight_table(lessons, chosen)
        write_table(run.folder / "weights.csv", table)
        if lessons:
            write_table(run.folder / "convexity.csv", pd.DataFrame(taken)[["object", "convexity"]])
            train = functools.partial(train_object, folder=run.folder, lessons=lessons, seed=run.seed)
            run.rows += train_all(run.folder, lessons, run.seed)
            run.rows += [row for rows in parallel_map(train, lessons, desc="svm") for row in rows]
        run.rows = [{key: value for key, value in row.items() if key != "convexity"} for row in run.rows]
        run.metrics({"objects": len(lessons)} | accuracies(run.rows))
    print(f"weights: {len(lessons)} of {len(run.objects)} objects have ground truth; enhanced takes {chosen}")


def accuracies(rows):
    """The SVMs' mean accuracy for the gate: dict "TRAINING.VALIDATION" -> value, six digits."""
    found = {}
    for row in rows:
        if row["metric"] == "accuracy":
            found.setdefault(f"svm.{row['area']}.{row['training']}.{row['validation']}", []).append(row["value"])
    return {name: round(float(np.mean(values)), 6) for name, values in found.items()}


if __name__ == "__main__":
    main()

"""Learns the weight of each conspicuity channel from where people look or mark (T3.2.1 to T3.2.3).

Reads data/SET/meshes, data/SET/conspicuity and the ground truth: the file of data/annotations that fits a mesh, or what
comes with the collection (gaze, interest points). Writes data/SET/weights: weights.csv (method, channel, weight,
left_out: the object that was not trained on), ground_truth/NAME.npz (the ground truth on the vertices and all that the
training takes from an object), svm.npz, svm/NAME.npz, convexity.csv; and reports/measurements/SET/weights.csv.gz.
Objects without ground truth are left out; with none at all only the published weights are written.
"""

import functools
import sys
from pathlib import Path

from haptic_glance.base.files import read_mesh, write_arrays, write_table
from haptic_glance.base.lazy import pandas as pd
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes import Params as MeshesParams
from stages.weights.training import shape_rows

from . import COLUMNS, Params
from .ground_truth import Files, digest, ground_truth_amounts, ground_truth_files
from .training import (
    collect_training_data,
    read_training_data,
    train_all,
    train_object,
    weight_rows,
    weight_table,
)

GROUND_TRUTH = "ground_truth"  # the folder of the training data in data/SET/weights


def process(item: tuple[str, Files], folder: Path, data: Path, source: str, seed: int) -> Rows:
    """Writes the training data of an object with ground truth; rows on its points and shape, or why it has none.

    item: the object's name and the files of its ground truth.
    """
    name, files = item
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    path = data / "conspicuity" / f"{name}.npz"
    try:
        amounts = ground_truth_amounts(name, source, mesh, files)
        if amounts is None or not amounts.any():
            return []
        arrays = collect_training_data(name, mesh, path, amounts, seed)
        shape = shape_rows(name, mesh)
    except ValueError as error:  # marks of another mesh of this name, for example: the other objects are trained on
        return [{"item": name, "metric": "points", "value": None, "note": str(error)}]
    write_arrays(folder / GROUND_TRUTH / f"{name}.npz", **arrays)
    return [{"item": name, "metric": "points", "value": len(arrays["points"])}, *shape]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, meshes = workspace.settings(Params), workspace.settings(MeshesParams)
    marks = workspace.root / "data" / "annotations"
    with StageRun(workspace, "weights", COLUMNS, inputs=("meshes", "conspicuity")) as stage:
        # Objects without ground truth are no items: what is trained on the others does not depend on them.
        pairs = ((name, read_mesh(workspace.data / "meshes" / f"{name}.npz")) for name in stage.objects)
        files = ground_truth_files(pairs, meshes.source, meshes.folder, marks)
        collect = functools.partial(process, data=workspace.data, source=meshes.source, seed=workspace.seed)
        reads = ("meshes/{}.npz", "conspicuity/{}.npz")
        made_of = {name: digest(entry) for name, entry in files.items()}
        rows = stage.each(collect, {name: (name, entry) for name, entry in files.items()}, reads=reads, made_of=made_of)
        for row in rows:
            if "note" in row:
                print(f"weights: {row['item']} is left out: {row['note']}", file=sys.stderr)
        convexities = [(row["item"], row["value"]) for row in rows if row["metric"] == "convexity"]
        training_data = read_training_data(stage.folder / GROUND_TRUTH)
        table = weight_table(training_data, settings.method)
        write_table(stage.folder / "weights.csv", table)
        stage.rows += weight_rows(table)
        if training_data:
            write_table(stage.folder / "convexity.csv", pd.DataFrame(convexities, columns=["object", "convexity"]))
            stage.rows += train_all(stage.folder, training_data, stage.seed)
            train = functools.partial(
                train_object, made=stage.folder / GROUND_TRUTH, seed=stage.seed, trained_on=settings.svm
            )
            stage.each(train, list(training_data), reads=[f"weights/{GROUND_TRUTH}"])
        stage.metrics({"objects": len(training_data)} | accuracies(stage.rows))
    count = f"{len(training_data)} of {len(stage.objects)} objects"
    print(f"weights: {count} have ground truth; the glance takes {settings.method}")


def accuracies(rows: Rows) -> dict[str, float]:
    """The SVMs' mean accuracy for the gate: dict "TRAINING.VALIDATION" -> value, six digits."""
    scored = (row for row in rows if row["metric"] == "accuracy")
    return named_means((f"svm.{row['area']}.{row['training']}.{row['validation']}", row["value"]) for row in scored)


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "weights"))

"""Recognises classes of objects by whole contours: T tables 4.7 to 4.9 and figure 4.19.

Reads data/SET/contours/NAME.npz and the classes of data/SET/meshes. Two networks and the sum of their probabilities,
kNN and SVM, each with sequences drawn at random for testing, as in the thesis, and with whole objects held out. Writes
data/SET/sequences/predictions/TRIAL.npz, and reports/measurements/SET/sequences.csv.gz: one row per trial and
classifier, of unseen objects also one per class; confusions, and the layers of both networks.
"""

import functools
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptic_glance.base.files import read_arrays
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_tree
from stages.meshes.collect import read_classes

from . import COLUMNS, Params
from .networks import ImageNet, NormalNet, layers
from .sequence_trials import SPLITS, Trial, plan, process


def confusion_rows(folder: Path, trials: list[Trial], classes: list[str]) -> Rows:
    """Rows of how many sequences of `group` were taken for `predicted` over all rounds (T figure 4.19).

    Of the trials with whole sequences alone, the size that the first of them has.
    """
    counts = defaultdict(lambda: np.zeros((len(classes), len(classes)), dtype=int))
    for trial in trials:
        if trial.size != trials[0].size:
            continue
        predictions = read_arrays(folder / "predictions" / f"{trial.name}.npz")
        for name in set(predictions) - {"test", "true"}:
            np.add.at(counts[trial.strategy, trial.split, name], (predictions["true"], predictions[name]), 1)
    return [
        {"method": method, "split": split, "classifier": name, "group": classes[i], "predicted": classes[j]}
        | {"metric": "confusion", "value": int(counts[method, split, name][i, j])}
        for method, split, name in sorted(counts)
        for i, j in np.argwhere(counts[method, split, name])
    ]


def layer_rows(trials: list[Trial], classes: int) -> Rows:
    """Rows of the parameters of each layer of the networks for whole sequences (T tables 4.7 and 4.8)."""
    frames, cells = trials[0].frames_and_cells
    films, normals = torch.zeros((1, frames, cells, cells)), torch.zeros((1, frames, 3))
    networks = {
        "cnn_images": (ImageNet(frames, (cells, cells), classes), films),
        "cnn_normals": (NormalNet(frames, classes), normals),
    }
    return [
        {"classifier": name, "metric": "parameters"} | row for name, pair in networks.items() for row in layers(*pair)
    ]


def summary(rows: Rows, seed: int) -> dict[str, Any]:
    """{strategy: {split: {classifier: {mean, low, high}}}} of the accuracy with whole sequences, and chance."""
    values, chance = defaultdict(list), {}
    for row in rows:
        if row["metric"] == "accuracy" and (row["frames"], row["cells"]) == (rows[0]["frames"], rows[0]["cells"]):
            values[row["method"], SPLITS[row["split"]], row["classifier"]].append(row["value"])
            chance = {"chance": round(1 / row["classes"], 6)}
    return chance | interval_tree(values, seed)


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, data = workspace.settings(Params), workspace.data
    with StageRun(workspace, "sequences", COLUMNS, inputs=("meshes", "contours")) as stage:
        planned = plan(read_classes(data / "meshes"), data / "contours", settings)
        train = functools.partial(process, data=data, members=planned.members, settings=settings, seed=stage.seed)
        rows = stage.each(train, [trial.name for trial in planned.trials], reads=("contours",))
        stage.rows += [{"metric": "accuracy", "value": None, "note": note} for note in planned.notes]
        stage.metrics(summary(rows, stage.seed))
        if planned.trials:
            stage.rows += confusion_rows(stage.folder, planned.trials, list(planned.members))
            stage.rows += layer_rows(planned.trials, len(planned.members))
    for note in planned.notes:
        print(f"sequences: {note}", file=sys.stderr)
    classes, trials = len(planned.members), len(planned.trials)
    print(f"sequences: {workspace.dataset}, {classes} classes, {trials} trials, {len(rows)} rows")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "sequences"))

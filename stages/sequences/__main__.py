"""Tells classes of objects apart by whole contours: T tables 4.7 to 4.9 and figure 4.19.

Reads data/contours/NAME.npz and data/classes. Two networks and the sum of their probabilities, kNN and SVM, each with
sequences drawn at random for testing, as in the thesis, and with whole objects left out. Writes
data/sequences/confusion.csv, layers.csv and predictions/TRIAL.npz, reports/measurements/sequences.csv and
reports/metrics/sequences.json.
"""

import functools
import sys
import warnings
from collections import defaultdict

import numpy as np
import pandas as pd
import torch

from stages.classes import read_classes
from stages.kit import StageRun, arguments, params
from stages.kit.files import read_arrays, write_table
from stages.kit.run import DATA
from stages.kit.stats import interval_metrics

from .networks import ImageNet, NormalNet, layers
from .plan import plan
from .trial import process


def confusion(folder, trials, classes):
    """Tidy frame of the confusion matrices: method, split, classifier, true, predicted, count over all rounds.

    Of the trials with whole sequences alone, the size that the first of them has.
    """
    counts = defaultdict(lambda: np.zeros((len(classes), len(classes)), dtype=int))
    for trial in trials:
        if trial.size != trials[0].size:
            continue
        stored = read_arrays(folder / "predictions" / f"{trial.name}.npz")
        for name in set(stored) - {"test", "true"}:
            np.add.at(counts[trial.strategy, trial.split, name], (stored["true"], stored[name]), 1)
    rows = [
        {"method": method, "split": split, "classifier": name, "true": classes[i], "predicted": classes[j]}
        | {"count": counts[method, split, name][i, j]}
        for method, split, name in sorted(counts)
        for i, j in np.ndindex(len(classes), len(classes))
    ]
    return pd.DataFrame(rows)


def network_layers(trials, classes):
    """Tidy frame: network, layer, kind, output, parameters, of networks for whole sequences."""
    frames, cells = trials[0].frames_and_cells
    films, normals = torch.zeros((1, frames, cells, cells)), torch.zeros((1, frames, 3))
    both = {
        "images": (ImageNet(frames, (cells, cells), classes), films),
        "normals": (NormalNet(frames, classes), normals),
    }
    return pd.concat([layers(*one).assign(network=name) for name, one in both.items()])


def summary(rows, seed):
    """{strategy: {split: {classifier: {mean, low, high}}}} of the accuracy with whole sequences, and the chance."""
    values, tree = defaultdict(list), {}
    for row in rows:
        if row["metric"] == "accuracy" and (row["frames"], row["cells"]) == (rows[0]["frames"], rows[0]["cells"]):
            values[row["method"], row["split"], row["classifier"]].append(row["value"])
            tree["chance"] = round(1 / row["classes"], 6)
    for (method, split, classifier), found in values.items():
        branch = tree.setdefault(method, {}).setdefault(split, {})
        branch[classifier] = interval_metrics(found, seed)
    return tree


def main():
    arguments(__doc__)
    settings, source = params("sequences"), params("classes").source
    # Torch's caches make a worker grow; joblib then renews it between two items, loses none, and warns.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
    with StageRun("sequences", inputs=("classes", "contours")) as run:
        run.dataset = source
        planned = plan(read_classes(DATA / "classes"), DATA / "contours", settings)
        train = functools.partial(process, members=planned.members, settings=settings, seed=run.seed)
        rows = run.each(train, [trial.name for trial in planned.trials])
        for row in rows:
            row["object"] = source
        run.rows += [{"object": source, "metric": "accuracy", "value": None, "note": note} for note in planned.notes]
        run.metrics(summary(rows, run.seed))
        if planned.trials:
            write_table(run.folder / "confusion.csv", confusion(run.folder, planned.trials, list(planned.members)))
            write_table(run.folder / "layers.csv", network_layers(planned.trials, len(planned.members)))
    for note in planned.notes:
        print(f"sequences: {note}", file=sys.stderr)
    print(f"sequences: {len(planned.members)} classes of {source}, {len(planned.trials)} trials, {len(rows)} rows")


if __name__ == "__main__":
    main()

"""The tables of a run: what the trials' rows become."""

from collections import defaultdict

import numpy as np
import pandas as pd

from stages.kit.files import read_arrays
from stages.kit.stats import interval_metrics

from .plan import Trial

LAYERS = ["trial", "layer", "part", "value"]
KNOWN = {"data": None, "method": None, "weights": None, "had": None, "mode": None, "split": None, "repetition": None}


def told(row, had):
    """A row with what its trial is about in place of the trial's name. had: {network: which weights it had}."""
    trial = Trial.parse(row["trial"])
    about = {"data": trial.data, "method": trial.network, "weights": trial.weights}
    about["had"] = had[trial.network] if trial.weights == "imagenet" else None
    about |= {"mode": trial.mode, "split": trial.split, "repetition": trial.repetition}
    return about | {"seconds": None, "note": None} | {key: value for key, value in row.items() if key != "trial"}


def sorted_out(rows, had):
    """(rows of measurements, frame of the disturbed touches, frame of the layers' changes)."""
    layers = [row for row in rows if "layer" in row]
    disturbed = [told(row, had) for row in rows if "perturbation" in row]
    plain = [told(row, had) for row in rows if "layer" not in row and "perturbation" not in row]
    columns = [*KNOWN, "perturbation", "severity", "metric", "value"]
    return plain, pd.DataFrame(disturbed, columns=columns), pd.DataFrame(layers, columns=LAYERS)


def confusion(folder, trials, members):
    """Tidy frame of the confusion matrices: trial, true class, predicted class, count of test touches."""
    rows = []
    for trial in trials:
        classes = list(members[trial.split])
        stored = read_arrays(folder / "predictions" / f"{trial.name}.npz")
        counts = np.zeros((len(classes), len(classes)), dtype=int)
        np.add.at(counts, (stored["true"], stored["scores"].argmax(axis=1)), 1)
        rows += [
            {"trial": trial.name, "true": classes[i], "predicted": classes[j], "count": counts[i, j]}
            for i, j in np.ndindex(counts.shape)
        ]
    return pd.DataFrame(rows)


def summary(rows, seed):
    """{data: {split: {network: {MODE_WEIGHTS: {mean, low, high}}}}} of the accuracy, and the chance of each split."""
    values, tree = defaultdict(list), {}
    for row in rows:
        if row["metric"] == "accuracy":
            key = row["data"], row["split"], row["method"], f"{row['mode']}_{row['weights']}"
            values[key].append(row["value"])
        if row["metric"] == "chance":
            tree.setdefault("chance", {})[row["split"]] = round(row["value"], 6)
    for (data, split, network, kind), found in values.items():
        branch = tree.setdefault(data, {}).setdefault(split, {}).setdefault(network, {})
        branch[kind] = interval_metrics(found, seed)
    return tree

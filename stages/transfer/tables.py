"""The tables of a run, from the rows of its trials."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from stages.kit.files import read_arrays
from stages.kit.stats import interval_metrics

from .plan import Trial

LAYER_COLUMNS = ["trial", "layer", "part", "value"]
TRIAL_COLUMNS = ["data", "method", "weights", "pretrained", "mode", "split", "repetition"]


def trial_row(row: dict, pretrained: Mapping[str, str | None]) -> dict:
    """A row with the columns of its trial instead of the trial's name. pretrained: as in Plan."""
    trial = Trial.parse(row["trial"])
    about: dict = {"data": trial.data, "method": trial.network, "weights": trial.weights}
    about["pretrained"] = pretrained[trial.network] if trial.weights == "imagenet" else None
    about |= {"mode": trial.mode, "split": trial.split, "repetition": trial.repetition}
    return about | {key: value for key, value in row.items() if key != "trial"}


def sort_rows(rows: list[dict], pretrained: Mapping[str, str | None]) -> tuple[list[dict], pd.DataFrame, pd.DataFrame]:
    """(rows of measurements, frame of the disturbed touches, frame of the changes of the layers)."""
    layers = [row for row in rows if "layer" in row]
    disturbed = [trial_row(row, pretrained) for row in rows if "perturbation" in row]
    plain = [trial_row(row, pretrained) for row in rows if "layer" not in row and "perturbation" not in row]
    columns = [*TRIAL_COLUMNS, "perturbation", "severity", "metric", "value"]
    return plain, pd.DataFrame(disturbed, columns=columns), pd.DataFrame(layers, columns=LAYER_COLUMNS)


def confusion(
    folder: Path, trials: Sequence[Trial], members: Mapping[str, Mapping[str, Sequence[str]]]
) -> pd.DataFrame:
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


def summary(rows: list[dict], seed: int) -> dict[str, dict]:
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

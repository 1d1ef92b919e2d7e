"""Rows and metrics of a run, from the rows of its trials."""

from collections import defaultdict
from collections.abc import Mapping

from haptic_glance.deep.device import choose_device, precision
from haptic_glance.deep.training import CONVERGED
from stages.kit.stats import interval_metrics

from .plan import Trial
from .schema import Params


def seen(settings: Params) -> dict:
    """The columns of what a network saw and computed in."""
    numbers = precision(choose_device(settings.device))
    return {"size": settings.size, "touches": settings.touches, "precision": numbers}


def trial_row(row: dict, pretrained: Mapping[str, str | None], settings: Params) -> dict:
    """A row with the columns of its trial instead of the trial's name. pretrained: as in Plan."""
    trial = Trial.parse(row["trial"])
    about: dict = {"data": trial.data, "method": trial.network, "weights": trial.weights}
    about["pretrained"] = pretrained[trial.network] if trial.weights == "imagenet" else None
    about |= {"mode": trial.mode, "split": trial.split, "repetition": trial.repetition, "passes": trial.passes}
    about |= seen(settings)
    return about | {key: value for key, value in row.items() if key != "trial"}


def summary(rows: list[dict], seed: int) -> dict[str, dict]:
    """{data: {split: {network: {MODE_WEIGHTS: {mean, low, high}}}}} of the accuracy, and the chance of each split.

    The key of trainings until nothing improves ends with _converged.
    """
    values, tree = defaultdict(list), {}
    for row in rows:
        if row["metric"] == "accuracy" and not row.get("note"):
            end = "_converged" if row.get("passes") == CONVERGED else ""
            key = row["data"], row["split"], row["method"], f"{row['mode']}_{row['weights']}{end}"
            values[key].append(row["value"])
        if row["metric"] == "chance":
            tree.setdefault("chance", {})[row["split"]] = round(row["value"], 6)
    for (data, split, network, kind), found in values.items():
        branch = tree.setdefault(data, {}).setdefault(split, {}).setdefault(network, {})
        branch[kind] = interval_metrics(found, seed)
    return tree

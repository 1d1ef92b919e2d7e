"""The numbers that the gate checks, and the comparison of the models with the controls."""

from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np
import pandas as pd

from stages.kit.stats import interval

from .agreement import ALL_VIEWS

MODEL = "ewigc"
COLUMNS = ["item", "method", "task", "view", "split", "metric", "value"]


def summary(rows: Sequence[dict], chosen: Mapping[str, int], seed: int) -> dict[str, dict]:
    """dict for the metric file: classes and mean accuracy of each task, mean agreement of the fused model and controls.

    chosen: dict task -> number of classes. Agreement: the Pearson correlation in the three views, averaged per object,
    with its interval over the objects.
    """
    frame = pd.DataFrame(rows).reindex(columns=COLUMNS)
    found: dict[str, dict] = {"classes": {task: int(count) for task, count in chosen.items()}}
    accuracies = frame.loc[(frame["metric"] == "accuracy") & frame["value"].notna()]
    for key, part in accuracies.groupby(["method", "split"]):
        method, split = cast(tuple[str, str], key)
        found.setdefault("accuracy", {}).setdefault(method, {})[split] = round(float(np.mean(part["value"])), 6)
    for name, values in agreement(frame).items():
        mean, low, high = np.round(interval(values, seed=seed), 6).tolist()
        ends = {"low": low, "high": high} if np.isfinite(low) else {}
        found.setdefault("pcc", {})[name] = {"value": mean} | ends
    return found


def agreement(frame: pd.DataFrame) -> dict[str, pd.Series]:
    """dict method -> Series object -> mean pcc over the views, of the fused models, rivals and controls."""
    views = frame.loc[(frame["metric"] == "pcc") & (frame["view"] != ALL_VIEWS)]
    own = views.loc[(views["task"] == MODEL) | views["method"].isin(["control", "rival"])]
    found = {}
    for key, part in own.groupby(["method", "task"], sort=True):
        method, task = cast(tuple[str, str], key)
        found[task if method in ("control", "rival") else method] = part.groupby("item")["value"].mean()
    return found


def verdicts(frame: pd.DataFrame, seed: int) -> list[str]:
    """Sentences that compare each control with each model trained on photographs, over the objects."""
    found = agreement(frame)
    trained = [name for name in found if name.endswith(("-frozen", "-last_block", "-finetuned"))]
    controls = [name for name in found if name.endswith("-random") or name in ("random", "centre_prior")]
    sentences = []
    for name in trained:
        for control in controls:
            if control.endswith("-random") and control.rpartition("-")[0] != name.rpartition("-")[0]:
                continue
            mean, low, high = interval(found[name] - found[control], seed=seed)
            verdict = "loses" if low > 0 else "wins" if high < 0 else "does not differ"
            sentences.append(f"{control} {verdict} against {name} (PCC {mean:+.3f}, {low:+.3f} to {high:+.3f})")
    return sentences

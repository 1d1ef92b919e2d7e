"""The few numbers that the gate holds, and whether the controls lose."""

import numpy as np
import pandas as pd

from stages.kit.stats import bootstrap_interval

from .judge import WHOLE

MODEL = "ewigc"
COLUMNS = ["object", "method", "task", "view", "split", "metric", "value"]
CONTROLS = (("control", "centre_prior"), ("control", "random"))


def summary(rows, chosen, seed):
    """dict for the metric file: classes and mean accuracy of each task, mean agreement of the fused model and controls.

    chosen: dict task -> number of classes. Agreement: the Pearson correlation in the three views, a mean an object
    first, with its interval over the objects.
    """
    frame = pd.DataFrame(rows).reindex(columns=COLUMNS)
    found = {"classes": {task: int(count) for task, count in chosen.items()}}
    right = frame[(frame["metric"] == "accuracy") & frame["value"].notna()]
    for (method, split), part in right.groupby(["method", "split"]):
        found.setdefault("accuracy", {}).setdefault(method, {})[split] = round(float(part["value"].mean()), 6)
    for name, values in agreement(frame).items():
        mean, low, high = np.round(bootstrap_interval(values, seed), 6).tolist()
        interval = {"low": low, "high": high} if np.isfinite(low) else {}
        found.setdefault("pcc", {})[name] = {"value": mean} | interval
    return found


def agreement(frame):
    """dict method -> Series object -> mean pcc over the views, of the fused models, rivals and controls."""
    views = frame[(frame["metric"] == "pcc") & (frame["view"] != WHOLE)]
    own = views[(views["task"] == MODEL) | views["method"].isin(["control", "rival"])]
    found = {}
    for (method, task), part in own.groupby(["method", "task"], sort=True):
        found[task if method in ("control", "rival") else method] = part.groupby("object")["value"].mean()
    return found


def verdicts(frame, seed):
    """Sentences on whether each control loses against each model that learned from photographs, over the objects."""
    found = agreement(frame)
    learned = [name for name in found if name.endswith(("-frozen", "-finetuned"))]
    controls = [name for name in found if name.endswith("-random") or name in ("random", "centre_prior")]
    said = []
    for name in learned:
        for control in controls:
            if control.endswith("-random") and control.rpartition("-")[0] != name.rpartition("-")[0]:
                continue
            mean, low, high = bootstrap_interval(found[name] - found[control], seed)
            verdict = "loses" if low > 0 else "wins" if high < 0 else "is not told apart"
            said.append(f"{control} {verdict} against {name} (PCC {mean:+.3f}, {low:+.3f} to {high:+.3f})")
    return said

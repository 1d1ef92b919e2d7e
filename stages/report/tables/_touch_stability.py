"""What table and figure of the stability of touch have in common: curves of accuracy against severity."""

import numpy as np
import pandas as pd

from stages.report.intervals import interval, shared_by
from stages.touch_stability import NONE, PERTURBATIONS, breaking_point, lead_left

LINES = {  # (split, features, classifier): how a person says it
    ("anywhere", "imprint", "knn"): "kNN",
    ("apart", "imprint", "knn"): "kNN, unseen regions",
    ("anywhere", "imprint", "svm"): "SVM",
    ("anywhere", "imprint_place", "knn"): "kNN with places",
}
ENOUGH = 0.02  # accuracy that may be lost before it is said to suffer


def curve(rows, perturbation, line):
    """Frame by severity, from mild to harsh: accuracy, left, each with low and high; None where it was not measured.

    left: what is left of the lead over guessing. The intervals are over the repetitions, widened for what they share.
    """
    keys = dict(zip(("split", "features", "classifier"), line, strict=True))
    mine = rows[np.logical_and.reduce([rows[key] == value for key, value in keys.items()])]
    clean = mine[mine["perturbation"] == NONE].set_index("repetition")["value"]
    mine = mine[mine["perturbation"] == perturbation]
    if mine.empty or clean.empty:
        return None
    found = []
    for severity, group in mine.groupby("severity", sort=False):
        values = group.set_index("repetition")["value"]
        left = lead_left(values, clean.mean(), mine["chance"].iloc[0])
        line = {"severity": severity, "lost": float((clean - values).mean())}
        for name, scores in (("accuracy", values), ("left", left)):
            line |= dict(
                zip((name, f"{name}_low", f"{name}_high"), interval(scores, shared_by(keys["split"])), strict=True)
            )
        found.append(line)
    frame = pd.DataFrame(found)
    order = (frame["severity"] - PERTURBATIONS[perturbation].unharmed).abs().sort_values().index
    return frame.loc[order].reset_index(drop=True)


def breaking(points, perturbation):
    """(severity at which half of the lead is lost, and for the low and the high end of the interval); NaN: beyond."""
    unharmed = PERTURBATIONS[perturbation].unharmed
    ends = [points["left"], points["left_low"].fillna(points["left"]), points["left_high"].fillna(points["left"])]
    return tuple(breaking_point(list(points["severity"]), list(end), unharmed) for end in ends)


def harmless(points, perturbation):
    """The harshest severity up to which at most ENOUGH of accuracy is lost on average; NaN if none."""
    kept = (points["lost"] <= ENOUGH).cumprod().astype(bool)
    return float(points.loc[kept, "severity"].iloc[-1]) if kept.any() else float("nan")

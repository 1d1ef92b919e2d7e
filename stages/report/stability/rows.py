"""What table and figure of the stability of touch have in common: curves of accuracy against severity."""

import numpy as np
import pandas as pd

from stages.kit.breaking_point import breaking_point, lead_left
from stages.kit.split import shared_by
from stages.kit.stats import interval
from stages.report.markdown import number
from stages.touch_stability import CLEAN, PERTURBATIONS

KEYS = ("split", "features", "classifier")
LINES = {  # (split, features, classifier): how a person says it
    ("random", "imprint", "knn"): "kNN",
    ("regions", "imprint", "knn"): "kNN, unseen regions",
    ("random", "imprint", "svm"): "SVM",
    ("random", "imprint_place", "knn"): "kNN with places",
}
ENOUGH = 0.02  # accuracy that may be lost before it is said to suffer


def of_line(rows, line):
    """The rows of one of LINES."""
    return rows[np.logical_and.reduce([rows[key] == value for key, value in zip(KEYS, line, strict=True)])]


def breaking_text(row, unharmed):
    """`0.2 [0.1, > 0.3]`: the breaking point of a row with its interval; beyond the harshest severity: `> 0.3`."""
    beyond = f"{'<' if row.harshest < unharmed else '>'} {row.harshest:g}"
    at, low, high = (beyond if np.isnan(one) else number(one, 2) for one in (row.breaking_point, row.low, row.high))
    return beyond if at == low == high == beyond else f"{at} [{low}, {high}]"


def curve(rows, perturbation, line):
    """Frame by severity, from mild to harsh: accuracy, left, each with low and high; None where it was not measured.

    left: what is left of the lead over guessing. The intervals are over the repetitions, widened for what they share.
    """
    mine = of_line(rows, line)
    clean = mine[mine["perturbation"] == CLEAN].set_index("repetition")["value"]
    mine = mine[mine["perturbation"] == perturbation]
    if mine.empty or clean.empty:
        return None
    found, shared = [], shared_by(line[0])
    for severity, group in mine.groupby("severity", sort=False):
        values = group.set_index("repetition")["value"]
        left = lead_left(values, clean.mean(), mine["chance"].iloc[0])
        point = {"severity": severity, "lost": float((clean - values).mean())}
        for name, scores in (("accuracy", values), ("left", left)):
            point |= dict(zip((name, f"{name}_low", f"{name}_high"), interval(scores, shared), strict=True))
        found.append(point)
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

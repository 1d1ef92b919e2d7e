"""Where recognition by a network breaks: the severity of each change of the imprints at which half its lead is lost."""

import numpy as np
import pandas as pd

from stages.kit.breaking_point import breaking_point, lead_left
from stages.report.items import Table
from stages.report.networks import FINE, mean, measured
from stages.report.results import NotRun, Results
from stages.report.style import label, start

from .rows import breaking_text

NETWORK = "mobilenet_v2"
KINDS = (("imagenet", "finetuned"), ("imagenet", "frozen"), ("random", "finetuned"), ("random", "frozen"))
UNITS = {
    "noise": "sigma, share of full scale",
    "blur": "sigma in cells of 128",
    "dead_cells": "share of the cells",
    "occlusion": "share of the area",
    "rotation": "degrees",
    "resolution": "cells a side",
    "few_touches": "share of the touches trained on",
}
UNHARMED = {"resolution": 128.0, "few_touches": 1.0}  # 0 for the others
NOTES = [
    "Severity, interpolated, at which half of the lead over guessing is lost, and in brackets where the ends of the 95 "
    "% interval of the accuracy cross that level. `>` or `<`: not up to that, the harshest tried. MobileNetV2 on "
    "imprints of 128 x 128, touches at random, learned from clean ones; few touches are what is learned from.",
    "Tried severities and accuracies: figure transfer_stability and data/transfer/stability.csv.",
]


def build(results: Results) -> Table:
    rows = results.table("transfer", "stability.csv")
    rows = rows[(rows["method"] == NETWORK) & (rows["metric"] == "accuracy")]
    clean = measured(results)
    clean = clean[(clean["method"] == NETWORK) & (clean["data"] == FINE) & (clean["split"] == "random")]
    chance = results.measured("transfer", metric="chance", data=FINE, split="random")["value"].mean()
    lines = [
        _line(name, kind, *(_of(frame, kind) for frame in (rows[rows["perturbation"] == name], clean)), chance)
        for name in UNITS
        if name in set(rows["perturbation"])
        for kind in KINDS
    ]
    frame = pd.DataFrame([line for line in lines if line])
    if frame.empty:
        raise NotRun("no disturbed imprints", "transfer")
    return Table("Where recognition by networks breaks", frame, NOTES, _wide(frame))


def _of(rows, kind):
    return rows[(rows["weights"] == kind[0]) & (rows["mode"] == kind[1])]


def _line(name, kind, rows, clean, chance):
    """The tidy row of one perturbation and network, None where it was not measured or has no lead to lose."""
    if rows.empty or not clean["value"].mean() > chance:
        return None
    unharmed = UNHARMED.get(name, 0.0)
    severities = sorted(set(rows["severity"]), key=lambda one: abs(one - unharmed))
    curves = [mean(rows.loc[rows["severity"] == one, "value"], "random") for one in severities]
    ends = [lead_left(curve, clean["value"].mean(), chance) for curve in np.array(curves).T]
    at, low, high = (breaking_point(severities, list(end), unharmed) for end in ends)
    return {
        "perturbation": name, "unit": UNITS[name], "weights": kind[0], "mode": kind[1], "clean": clean["value"].mean(),
        "breaking_point": at, "low": low, "high": high, "harshest": severities[-1], "accuracy": curves[-1][0],
    }  # fmt: skip


def _wide(frame):
    lines = []
    for name, group in frame.groupby("perturbation", sort=False):
        line = {"perturbation": label(name), "unit": UNITS[name]}
        for row in group.itertuples():
            line[f"{start(row.weights)}, {label(row.mode)} ({100 * row.clean:.0f} % clean)"] = breaking_text(
                row, UNHARMED.get(name, 0.0)
            )
        lines.append(line)
    return pd.DataFrame(lines).fillna("–")

"""Where recognition by a network breaks: the severity of each change of the imprints at which half its lead is lost."""

import numpy as np
import pandas as pd

from stages.kit.breaking_point import breaking_point, lead_left
from stages.report.grid import grouped
from stages.report.items import Figure, Table
from stages.report.networks import FINE, NETWORK, mean, measured
from stages.report.results import NotRun, Results
from stages.report.style import GREY, label, start

from .panels import add_legend, breaking_text, draw_line, finish, panels

TINTS = {
    ("imagenet", "finetuned"): "#0072B2",
    ("imagenet", "frozen"): "#56B4E9",
    ("random", "finetuned"): "#767676",
    ("random", "frozen"): "#c4c4c4",
}  # of weights and what learns
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
ENDS = ["accuracy", "low", "high"]
COLUMNS = ["perturbation", "unit", "weights", "mode", "clean", "breaking_point", "low", "high", "harshest", "accuracy"]


def table(results: Results) -> Table:
    """Breaking points; of networks that were measured and have a lead to lose."""
    rows, clean, chance = _accuracies(results)
    found, shown = [], []
    for name in UNITS:
        unharmed, cells = UNHARMED.get(name, 0.0), {}
        for (weights, mode), (whole, *_) in clean.items():
            points = _curve(rows, name, weights, mode)
            if points.empty or not whole > chance:
                continue
            severities, (harshest, accuracy) = list(points["severity"]), points[["severity", "accuracy"]].iloc[-1]
            left = lead_left(points[ENDS].to_numpy().T, whole, chance)
            ends = [breaking_point(severities, list(end), unharmed) for end in left]
            found.append((name, UNITS[name], weights, mode, whole, *ends, harshest, accuracy))
            head = f"{start(weights)}, {label(mode)} ({100 * whole:.0f} % clean)"
            cells[head] = breaking_text(ends, harshest, unharmed)
        if cells:
            shown.append({"perturbation": label(name), "unit": UNITS[name]} | cells)
    if not found:
        raise NotRun("no disturbed imprints", "transfer")
    return Table(pd.DataFrame(found, columns=COLUMNS), pd.DataFrame(shown).fillna("–"))


def figure(results: Results) -> Figure:
    """Accuracy of MobileNetV2 on disturbed imprints, against severity: a panel a perturbation."""
    rows, clean, chance = _accuracies(results)
    found = [name for name in UNITS if name in set(rows["perturbation"])]
    drawing, grid, legend = panels(found, "accuracy, %", 10.2, 2.4)
    for name, axes in grid.items():
        steps = []
        for (weights, mode), tint in TINTS.items():
            points = _curve(rows, name, weights, mode)
            if (weights, mode) in clean and len(points):
                steps = max(steps, list(points["severity"]), key=len)
                draw_line(axes, np.vstack([clean[weights, mode], points[ENDS]]), tint, "o")
        finish(axes, name, UNITS[name], steps)
        axes.axhline(100 * chance, color=GREY, lw=1.2, ls=":")
    mark = {"marker": "o", "ms": 4, "lw": 1.4}
    lines = {f"{start(weights)}, {label(mode)}": mark | {"color": tint} for (weights, mode), tint in TINTS.items()}
    add_legend(drawing, legend, lines)
    return Figure(drawing, {"perturbations": len(found)})


def _accuracies(results: Results) -> tuple[pd.DataFrame, dict[tuple[str, str], tuple[float, float, float]], float]:
    """(rows of disturbed imprints, {(weights, mode): mean, low, high of clean ones}, accuracy of guessing)."""
    rows = results.measured("transfer", method=NETWORK, metric="disturbed_accuracy", perturbation=list(UNITS))
    clean = measured(results)
    clean = clean.loc[(clean["method"] == NETWORK) & (clean["data"] == FINE) & (clean["split"] == "random")]
    values = {kind: group["value"] for kind, group in grouped(clean, ["weights", "mode"]) if kind in TINTS}
    chance = results.measured("transfer", metric="chance", data=FINE, split="random")["value"].mean()
    return rows, {kind: mean(values[kind], "random") for kind in TINTS if kind in values}, chance


def _curve(rows: pd.DataFrame, name: str, weights: str, mode: str) -> pd.DataFrame:
    """severity and ENDS of one network under one perturbation, from mild to harsh."""
    mine = rows.loc[(rows["perturbation"] == name) & (rows["weights"] == weights) & (rows["mode"] == mode)]
    found = [(severity, *mean(group["value"], "random")) for (severity,), group in grouped(mine, ["severity"])]
    found.sort(key=lambda point: abs(point[0] - UNHARMED.get(name, 0.0)))
    return pd.DataFrame(found, columns=["severity", *ENDS])

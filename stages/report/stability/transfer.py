"""The breaking point of a network: the severity of each change of the imprints at which half its lead is lost."""

from itertools import product

import pandas as pd

from stages.engine.statistics import breaking_point, lead_left
from stages.report.drawing import label, start
from stages.report.items import Figure, Table
from stages.report.networks import FINE, MODES, NETWORK, STARTS, mean, measured
from stages.report.results import Results, some
from stages.report.tables import grouped, records

from .panels import ACCURACY, CLEAN, Curves, broken, degradation

TINTS = dict(zip(product(STARTS[:2], MODES), ("#0072B2", "#56B4E9", "#767676", "#c4c4c4"), strict=True))
UNITS = {
    "noise": "sigma, share of full scale",
    "blur": "sigma in cells of 128",
    "dead_cells": "share of the cells",
    "occlusion": "share of the area",
    "rotation": "degrees",
    "resolution": "cells a side",
    "few_touches": "share of the touches trained on",
}
UNHARMED = dict.fromkeys(UNITS, 0.0) | {"resolution": 128.0, "few_touches": 1.0}
COLUMNS = ["perturbation", "unit", "weights", "mode", "clean", "breaking_point", "low", "high", "harshest", "accuracy"]


def table(results: Results) -> Table:
    """Breaking points; of networks that were measured and have a lead to lose."""
    (curves, chance), entries = _curves(results), []
    for name, lines in curves.items():
        for kind, points in lines.items():
            whole, severities = points["clean"].iloc[0], list(points["severity"])
            if whole > chance:
                left = lead_left(points[ACCURACY].to_numpy().T, whole, chance)
                ends = [breaking_point(severities, list(end), UNHARMED[name]) for end in left]
                entries.append((name, UNITS[name], *kind, whole, *ends, severities[-1], points["accuracy"].iloc[-1]))
    frame = pd.DataFrame(some(entries, "no disturbed imprints", "transfer"), columns=COLUMNS)
    heads = [f"{start(row.weights)}, {label(row.mode)} ({100 * row.clean:.0f} % clean)" for row in records(frame)]
    return Table(frame, broken(frame, heads, UNHARMED))


def figure(results: Results) -> Figure:
    """Accuracy of MobileNetV2 on disturbed imprints, against severity: a panel a perturbation."""
    curves, chance = _curves(results)
    looks = {
        kind: {"label": f"{start(kind[0])}, {label(kind[1])}", "color": tint, "marker": "o"}
        for kind, tint in TINTS.items()
    }
    return Figure(degradation(curves, UNITS, looks, chance, 2.4)[0], {"perturbations": len(curves)})


def _curves(results: Results) -> tuple[Curves, float]:
    """(curves by weights and mode, accuracy of guessing)."""
    rows = results.measured("transfer", method=NETWORK, metric="disturbed_accuracy", perturbation=list(UNITS))
    undisturbed = grouped(measured(results, method=NETWORK, data=FINE, split="random"), ["weights", "mode"])
    clean = {kind: mean(group["value"], "random") for kind, group in undisturbed}
    groups, curves = dict(grouped(rows, ["perturbation", "weights", "mode"])), {}
    for name, kind in product(UNITS, TINTS):
        if (name, *kind) in groups:
            severities = grouped(groups[name, *kind], ["severity"])
            points = [(severity, *mean(group["value"], "random"), *clean[kind]) for (severity,), group in severities]
            points.sort(key=lambda point: abs(point[0] - UNHARMED[name]))
            curves.setdefault(name, {})[kind] = pd.DataFrame(points, columns=["severity", *ACCURACY, *CLEAN])
    return curves, results.measured("transfer", metric="chance", data=FINE, split="random")["value"].mean()

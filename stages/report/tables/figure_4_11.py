"""T figure 4.11: accuracy of four classifiers on unseen objects, for each size of the pressure array."""

import contextlib

import pandas as pd

from stages.report.intervals import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import NotRun
from stages.report.style import label

THESIS = (32, 0.01)  # the array of T figure 4.11 whose accuracies the text gives
SPLITS = {"accuracy": "unseen", "accuracy_holdout": "known, other touches"}
NOTES = [
    "Each cell: accuracy in per cent of single touches, [95 % interval] over the objects; then the thesis's, of four "
    "classes, for the one array of which T4.3.2 gives figures. Unseen: never touched in training, as the thesis says "
    "of its own; known: a random quarter of the touches, the others of the same objects being trained on.",
    "Every object of a class is left out once; the thesis tests one of three. Ten principal components of the imprint, "
    "learned from the training touches; kNN with one neighbour, quadratic SVM, fifty bagged trees, a small network.",
    "The smallest array that is enough: fewest sensels, then least width, among those that lack at most the slack "
    "(sensor_size.slack, in accuracy) of the best mean. It is chosen on the same objects that it is judged by; in "
    "brackets how often the same array is chosen when the objects are drawn anew (bootstrap): where that "
    "is seldom, the choice is luck.",
]
SMALLEST = "the smallest array that is enough"


def build(results):
    """One row an array, data set and split; the run's own classes first, then those measured once on other data."""
    sets = [results.measured("sensor_size", metric=list(SPLITS))]
    with contextlib.suppress(NotRun):
        elsewhere = results.touch("sensor_size_princeton")
        sets.append(elsewhere[elsewhere["metric"].isin(SPLITS)])
    thesis = results.thesis("figure_4_11_sensor_32x32_sensel_0_01").set_index("classifier")["accuracy"]
    parts = [
        cells(own).assign(data=rows["object"].iloc[0], split=metric)
        for rows in sets
        for metric, own in rows.groupby("metric", sort=False)
    ]
    frame = pd.concat(parts, ignore_index=True)
    frame["thesis"] = [
        thesis.get(row.classifier) if (row.cells, row.pitch) == THESIS else None for row in frame.itertuples()
    ]
    classes = "; ".join(
        f"{rows['object'].iloc[0]}: {', '.join(sorted(set(rows['class'])))}, {rows['tested'].nunique()} objects, "
        f"{int(rows['touches'].iloc[0])} touches each, guessing {100 / rows['class'].nunique():.1f} %"
        for rows in (part[part["metric"] == "accuracy"].dropna(subset=["class"]) for part in sets)
    )
    return Table(
        "Figure 4.11: which pressure array tells classes of objects apart", frame,
        [*NOTES, f"Classes: {classes}.", *_smallest(results)], _shown(frame),
    )  # fmt: skip


def cells(rows):
    """Mean accuracy and interval over the left-out objects, a row for each array and classifier."""
    found = []
    for (count, pitch, name), group in rows.groupby(["cells", "pitch", "classifier"], sort=False):
        mean, low, high = interval(group.groupby("tested")["value"].mean())
        found.append({"cells": count, "pitch": pitch, "classifier": name, "accuracy": mean,
                      "low": max(low, 0.0), "high": min(high, 1.0), "seconds": group["seconds"].median()})  # fmt: skip
    return pd.DataFrame(found)


def _shown(frame):
    text = [
        with_interval(row.accuracy, row.low, row.high, 100, 0)
        + (f" · {100 * row.thesis:.0f}" if row.thesis == row.thesis and row.thesis is not None else "")
        for row in frame.itertuples()
    ]
    names = frame["classifier"].map(lambda name: f"{label(name)}, %")
    wide = frame.assign(text=text, classifier=names)
    order = list(dict.fromkeys(names))
    wide = wide.pivot(index=["data", "split", "cells", "pitch"], columns="classifier", values="text")[
        order
    ].reset_index()
    width = [f"{cells * pitch:.2f}" for cells, pitch in zip(wide["cells"], wide["pitch"], strict=True)]
    wide.insert(4, "width, units", width)
    wide = wide.assign(cells=[f"{count} x {count}" for count in wide["cells"]], split=wide["split"].map(SPLITS))
    return wide.rename(columns={"split": "objects", "pitch": "pitch, units"})


def _smallest(results):
    try:
        rows = results.table("sensor_size", "smallest.csv")
    except NotRun:
        return []
    said = [
        f"{label(row.classifier)} {row.cells} x {row.cells} at {row.pitch:g} ({100 * row.again:.0f} %)"
        for row in rows.itertuples()
    ]
    return [f"{SMALLEST.capitalize()}, in this run: {'; '.join(said)}."]

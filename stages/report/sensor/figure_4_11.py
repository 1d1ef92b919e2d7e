"""T figure 4.11: accuracy of four classifiers on unseen objects, for each size of the pressure array."""

import pandas as pd

from stages.kit.split import Split
from stages.report.grid import grid, means
from stages.report.items import Table
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.words import dataset_text

from .claims import STAGE

ARRAY = ["cells", "pitch", "classifier"]
THESIS = (32, 0.01)  # the array of T figure 4.11 whose accuracies the text gives
SPLITS = {Split.OBJECTS: "unseen", Split.RANDOM: "known, other touches"}
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


def build(results: Results) -> Table:
    """One row per array, data set and split; the sets that are switched on first."""
    sets = [results.measured(STAGE, name, metric="accuracy") for name in results.datasets(STAGE) or [None]]
    rows = pd.concat([rows.sort_values("split", kind="stable") for rows in sets])
    thesis = results.thesis("figure_4_11_sensor_32x32_sensel_0_01").set_index("classifier")["accuracy"]
    frame = cells(rows, ["dataset", "split", *ARRAY])
    own = [(row.cells, row.pitch) == THESIS for row in frame.itertuples()]
    frame["thesis"] = frame["classifier"].map(thesis).where(own)
    width = [f"{count * pitch:.2f}" for count, pitch in zip(frame["cells"], frame["pitch"], strict=True)]
    shown = grid(
        frame.assign(width=width), ["dataset", "split", "cells", "pitch", "width"], "classifier", gap=None,
        names={"dataset": dataset_text, "split": SPLITS.get, "cells": lambda count: f"{count} x {count}"},
        head=lambda name: f"{label(name)}, %",
    ).rename(columns={"split": "objects", "pitch": "pitch, units", "width": "width, units"})  # fmt: skip
    title = "Figure 4.11: which pressure array tells classes of objects apart"
    return Table(title, frame, [*NOTES, f"Classes: {_classes(rows)}.", *_smallest(results)], shown)


def cells(rows: pd.DataFrame, by: list[str] = ARRAY) -> pd.DataFrame:
    """Mean accuracy and interval over the tested objects, one row for each combination of the columns `by`."""
    seconds = rows.groupby(by, sort=False)["seconds"].median().to_numpy()
    objects = rows.groupby([*by, "item"], sort=False)[["value", "seconds"]].mean().reset_index()
    found = pd.DataFrame(means(objects, by, top=1.0)).rename(columns={"mean": "accuracy"}).drop(columns="values")
    return found.assign(seconds=seconds)


def _classes(rows: pd.DataFrame) -> str:
    """What each set holds, in words."""
    return "; ".join(
        f"{dataset_text(str(name))}: {', '.join(sorted(set(own['group'])))}, {own['item'].nunique()} objects, "
        f"{int(own['touches'].iloc[0])} touches each, guessing {100 / own['group'].nunique():.1f} %"
        for name, own in rows.groupby("dataset", sort=False)
    )


def _smallest(results: Results) -> list[str]:
    """The smallest array of each set whose folder is at hand."""
    lines = []
    for name in results.datasets(STAGE):
        try:
            rows = results.table(STAGE, "smallest.csv", name)
        except NotRun:
            continue
        arrays = [
            f"{label(row.classifier)} {row.cells} x {row.cells} at {row.pitch:g} ({100 * row.again:.0f} %)"
            for row in rows.itertuples()
        ]
        lines.append(f"The smallest array that is enough, {dataset_text(name)}: {'; '.join(arrays)}.")
    return lines

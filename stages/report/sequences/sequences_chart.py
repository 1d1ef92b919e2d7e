"""Recognition by contours: accuracy on unseen objects against seconds, over classifiers, frames and imprint sizes."""

import pandas as pd

from stages.kit.split import Split
from stages.report.items import Figure
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import CLASSIFIERS, METRICS, SIZE, STAGE, accuracy

REFERENCE = "knn"  # of whole sequences
SHOWN = ("cnn", "cnn_images", "cnn_normals", "knn", "svm", "svm_no_som")
TESTED = {Split.OBJECTS: "objects never touched", Split.RANDOM: "sequences drawn at random"}


def build(results: Results) -> Figure:
    """Accuracy against seconds for each classifier, number of frames and number of cells, of the strategy with most."""
    rows = results.measured(STAGE, metric=list(METRICS.values()), classifier=list(SHOWN))
    split = next(split for split in TESTED if split in set(rows["split"]))
    rows = rows[rows["split"] == split]
    strategy = rows.groupby("method")["frames"].nunique().idxmax()
    rows = rows[rows["method"] == strategy]
    frames, cells = rows[SIZE].max()
    rows = rows[(rows["classifier"] != "cnn_normals") | (rows["cells"] == cells)]  # normals have no cells
    found = [_choice(own, split, *key) for key, own in rows.groupby(["classifier", *SIZE])]
    frame = pd.DataFrame(found).sort_values(SIZE, ascending=False, ignore_index=True)
    reference = _name(REFERENCE, frames, cells)
    if reference not in set(frame["name"]):
        raise NotRun(f"the reference {reference} is not measured", STAGE)
    title = f"{rows['classes'].max()} classes by following contours, {label(strategy)}; frames x cells x cells"
    return pareto_chart(
        frame, "mean", title=title, reference=reference, quality_label=f"accuracy, {TESTED[split]}", cost="cost",
        colour="of", marker="film",
    )  # fmt: skip


def _choice(rows: pd.DataFrame, split: Split, classifier: str, frames: int, cells: int) -> dict[str, object]:
    mean, low, high, _ = accuracy(rows, split)
    return {
        "classifier": classifier, "of": CLASSIFIERS[classifier], "frames": frames, "cells": cells,
        "film": f"{frames} frames", "name": _name(classifier, frames, cells), "mean": mean, "low": low, "high": high,
        "cost": rows.loc[rows["metric"] == "accuracy", "seconds"].median(),
    }  # fmt: skip


def _name(classifier: str, frames: int, cells: int) -> str:
    return f"{CLASSIFIERS[classifier]}, {frames} x {cells} x {cells}"

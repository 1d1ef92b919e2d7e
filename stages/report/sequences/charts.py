"""T figure 4.19, which classes are taken for which; and accuracy on unseen objects against seconds."""

import pandas as pd

from haptic_glance.know.split import Split
from stages.report.confusion import draw_matrices
from stages.report.items import Figure
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.words import dataset_text

from .rows import BLIND, CLASSIFIERS, GUIDED, METRICS, PRINTED, SIZE, SPLITS, STAGE, accuracy

THESIS_CLASSES = "princeton_eight"
SHOWN = ("cnn", "cnn_images", "cnn_normals", "knn", "svm", "svm_no_som")
TESTED = {Split.OBJECTS: "objects never touched", Split.RANDOM: "sequences drawn at random"}


def figure_4_19(results: Results) -> Figure:
    """Confusion matrices: a row for each split and strategy, a column for each classifier of the thesis."""
    try:
        frame = results.measured(STAGE, THESIS_CLASSES, metric="confusion")
    except NotRun:
        frame = results.measured(STAGE, metric="confusion")
    here = set(zip(frame["split"], frame["method"], strict=True))
    lines = [(split, method) for split in SPLITS for method in (BLIND, GUIDED) if (split, method) in here]
    rows = {(split, method): f"{label(method)}\n{SPLITS[split]}" for split, method in lines}
    names = {name: CLASSIFIERS[name] for name in PRINTED if name in set(frame["classifier"])}
    figure, words = draw_matrices(frame, rows, names, ["split", "method"], "classifier")
    said = {"rows": "; ".join(rows.values()).replace("\n", ", "), "columns": ", ".join(names.values())}
    said["on"] = dataset_text(str(frame["dataset"].iloc[0]))
    return Figure(figure, words | said)


def chart(results: Results) -> Figure:
    """Accuracy against seconds for each classifier, number of frames and number of cells, of the strategy with most."""
    rows = results.measured(STAGE, metric=list(METRICS.values()), classifier=list(SHOWN))
    split = next(split for split in TESTED if split in set(rows["split"]))
    rows = rows[rows["split"] == split]
    strategy = rows.groupby("method")["frames"].nunique().idxmax()
    rows = rows[rows["method"] == strategy]
    rows = rows.astype(dict.fromkeys(SIZE, int))
    frames, cells = rows[SIZE].max()
    rows = rows[(rows["classifier"] != "cnn_normals") | (rows["cells"] == cells)]  # normals have no cells
    found = []
    for (classifier, number, side), own in rows.groupby(["classifier", *SIZE]):
        mean, low, high, _ = accuracy(own, split)
        found.append({
            "classifier": classifier, "of": CLASSIFIERS[classifier], "frames": number, "cells": side,
            "film": f"{number} frames", "name": f"{CLASSIFIERS[classifier]}, {number} x {side} x {side}",
            "mean": mean, "low": low, "high": high, "cost": own.loc[own["metric"] == "accuracy", "seconds"].median(),
        })  # fmt: skip
    frame = pd.DataFrame(found).sort_values(SIZE, ascending=False, ignore_index=True)
    reference = f"{CLASSIFIERS['knn']}, {frames} x {cells} x {cells}"
    title = f"{int(rows['classes'].max())} classes by following contours, {label(strategy)}, frames x cells x cells"
    return pareto_chart(
        frame, "mean", title=title, reference=reference, quality_label=f"accuracy, {TESTED[split]}", cost="cost",
        clock=results.clock(STAGE),
        colour="of", marker="film", legends={"of": "classifier", "film": "length of a contour"},
    )  # fmt: skip

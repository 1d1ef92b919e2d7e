"""Recognition by contours: accuracy on unseen objects against seconds, over classifiers, frames and imprint sizes."""

import pandas as pd

from stages.kit.split import Split
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label

from .rows import CLASSIFIERS, accuracy

REFERENCE = "knn"  # of whole sequences
SHOWN = ("cnn", "cnn_images", "cnn_normals", "knn", "svm", "svm_no_som")


def build(results):
    rows = results.measured("sequences", metric=["accuracy", "accuracy_object"], classifier=list(SHOWN))
    split = Split.OBJECTS if Split.OBJECTS in set(rows["split"]) else Split.RANDOM
    rows = rows[rows["split"] == split]
    strategy = rows.groupby("method")["frames"].nunique().idxmax()
    rows = rows[rows["method"] == strategy]
    whole = rows["cells"].max()
    rows = rows[(rows["classifier"] != "cnn_normals") | (rows["cells"] == whole)]  # normals have no cells
    found = [_choice(own, split, *key) for key, own in rows.groupby(["classifier", "frames", "cells"])]
    frame = pd.DataFrame(found).sort_values(["frames", "cells"], ascending=False, ignore_index=True)
    reference = _name(REFERENCE, rows["frames"].max(), whole)
    if reference not in set(frame["name"]):
        raise NotRun(f"the reference {reference} is not measured", "sequences")
    tested = "objects never touched" if split == Split.OBJECTS else "sequences drawn at random"
    classes = int(rows["classes"].max())
    return pareto_chart(
        frame, "cost", "mean", "name", name="sequences",
        title=f"{classes} classes by following contours, {label(strategy)}; frames x cells x cells",
        reference=reference, quality_label=f"accuracy, {tested}", folder=results.reports / "tradeoff",
        colour="of", marker="film",
    )  # fmt: skip


def _choice(rows, split, classifier, frames, cells):
    mean, low, high, _ = accuracy(rows, split)
    seconds = rows.loc[rows["metric"] == "accuracy", "seconds"].median()
    return {
        "classifier": classifier, "of": CLASSIFIERS[classifier], "frames": frames, "cells": cells,
        "film": f"{frames} frames", "name": _name(classifier, frames, cells),
        "mean": mean, "low": low, "high": high, "cost": seconds,
    }  # fmt: skip


def _name(classifier, frames, cells):
    return f"{CLASSIFIERS[classifier]}, {frames} x {cells} x {cells}"

"""What table 4.9, figure 4.19, their chart and their claims read: accuracies of whole sequences."""

import pandas as pd

from haptic_glance.know.split import Split
from stages.report.grid import within

STAGE = "sequences"
SPLITS = {Split.RANDOM: "sequences drawn at random", Split.OBJECTS: "unseen objects"}
METRICS = {Split.RANDOM: "accuracy", Split.OBJECTS: "accuracy_object"}
SHARED = {Split.RANDOM: 0.2 / 0.8, Split.OBJECTS: 0.0}  # test over training share; of the random splits T4.4.10
CLASSIFIERS = {
    "cnn": "CNNs", "cnn_images": "CNN, images alone", "cnn_normals": "CNN, normals alone", "knn": "kNN", "svm": "SVM",
    "knn_no_som": "kNN, without the map", "svm_no_som": "SVM, without the map",
}  # fmt: skip
PRINTED = ("cnn", "knn", "svm")  # those of T table 4.9
BLIND, GUIDED = "random", "thesis_ssim"  # the two columns of T table 4.9
SIZE = ["frames", "cells"]


def accuracy(rows: pd.DataFrame, split: Split) -> tuple[float, float, float, int]:
    """(mean, low, high, values) of one strategy, classifier and size: over random splits, or objects left out."""
    rows = rows[(rows["split"] == split) & (rows["metric"] == METRICS[split])]
    values = rows.groupby(["group", "repetition"], dropna=False)["value"].mean()  # several trainings for one object
    return *within(values, SHARED[split]), len(values)

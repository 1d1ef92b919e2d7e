"""Recognition by contours: layers of the networks, accuracies and claims (T4.4; T tables 4.7, 4.8 and 4.9).

`table_4_7` has the layers of both networks, of T tables 4.7 and 4.8. `accuracy` is shared by table 4.9 and the chart.
The claims compare guided with blind contours, and networks with conventional classifiers, on sequences with all frames
and cells.
"""

from itertools import product

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split
from stages.charts.datasets import dataset_text
from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import Results
from stages.charts.tables import Ranking, blocks, everywhere, grid, percent, records, within

KEYS = ["objects", "split", "classifier"]
THESIS_WORDS = {
    ("cnn_images", "conv1"): "kernel 5, 5, 5; padding 2, 2, 2; stride 2, 2, 5; 8 filters",
    ("cnn_images", "norm"): "batch normalisation",
    ("cnn_images", "conv2"): "kernel 5, 5, 3; padding 1, 1, 0; stride 1, 1, 1; tanh; 16 filters",
    ("cnn_images", "fc1"): "tanh; dropout 0.8",
    ("cnn_images", "fc2"): "tanh",
    ("cnn_images", "scores"): "softmax",
    ("cnn_normals", "conv1"): "kernel 1, 3, 5; ReLU; padding 0; stride 1; 32 filters",
    ("cnn_normals", "norm"): "batch normalisation",
    ("cnn_normals", "conv2"): "kernel 1, 3, 3; ReLU; padding 0; max pooling 1, 1, 0.2; dropout 0.5; 32 filters",
    ("cnn_normals", "fc1"): "ReLU; dropout 0.8",
    ("cnn_normals", "fc2"): "ReLU",
    ("cnn_normals", "scores"): "softmax",
}
PRINTED = "the thesis"
NETWORKS = {"cnn_images": "3D, images (4.7)", "cnn_normals": "1D, normals (4.8)"}


def table_4_7(results: Results) -> Table:
    """The layers of both networks, without dropout, beside what the thesis prints of each."""
    rows = results.measured(STAGE, metric="parameters").query("kind != 'Dropout'").reset_index(drop=True)
    frame = rows.rename(columns={"classifier": "network", "value": "parameters"}).astype({"parameters": int})
    frame["thesis"] = [THESIS_WORDS.get(key, "") for key in zip(frame["network"], frame["layer"], strict=True)]
    frame = frame[["network", "layer", "thesis", "kind", "output", "parameters"]]
    text_table = frame.assign(network=frame["network"].map(NETWORKS))
    text_table = text_table.rename(columns={"kind": "ours", "output": "output of ours"})
    totals = frame.groupby("network")["parameters"].sum()
    return Table(frame, text_table, {name: totals[name] for name in NETWORKS})  # no ranking: layers do not compete


def table_4_9(results: Results) -> Table:
    """Accuracy by data set, split, classifier and strategy, beside the thesis's two columns."""
    thesis = results.thesis("table_4_9_sequences").set_index("classifier")
    printed = thesis.rename(columns={"blind": BLIND, "guided": GUIDED}).stack().to_dict()
    by_set = everywhere(results, STAGE, metric=list(METRICS.values()))
    lines = []
    for source, rows in by_set.items():
        rows = rows[(rows[SIZE] == rows[SIZE].max()).all(axis=1)]  # with all their frames and cells
        splits = [split for split in SPLITS if split in set(rows["split"])]
        strategies = sorted(rows["method"].unique(), key=lambda method: (method != BLIND, method != GUIDED))
        for split, classifier, method in product(splits, CLASSIFIERS, strategies):
            runs = rows[(rows["method"] == method) & (rows["classifier"] == classifier)]
            lines.append({
                "objects": source, "split": split, "classifier": classifier, "strategy": method,
                **dict(zip(("accuracy", "low", "high", "values"), accuracy(runs, split), strict=True)),
                "thesis": printed.get((classifier, method), np.nan) if split == Split.RANDOM else np.nan,
                "chance": 1 / runs["classes"].max(), "sequences": runs["sequences"].max(),
                "seconds": runs.loc[(runs["split"] == split) & (runs["metric"] == "accuracy"), "seconds"].median(),
            })  # fmt: skip
    frame = pd.DataFrame(lines)
    names = {"objects": dataset_text, "split": SPLITS.get, "classifier": CLASSIFIERS.get}
    cells = blocks(frame, KEYS, "strategy", {"thesis": lambda objects: PRINTED})
    text_table = grid(cells, KEYS, "strategy", names, lambda name: f"{label(name)}, %", places=1, printed=PRINTED)
    sizes = frame.groupby("objects", sort=False)[["sequences", "chance"]].max()
    count_text = ", ".join(f"{int(row.sequences):,} ({dataset_text(row.Index)})" for row in records(sizes))
    chance = ", ".join(f"{dataset_text(row.Index)} {percent(row.chance, 1)} %" for row in records(sizes))
    words = {"not_run": results.left_out(STAGE), "counted": count_text, "chance": chance, "trained": trained(results)}
    best = Ranking(f"{label(GUIDED)}, %", among=["objects", "split"], exempt=[PRINTED])
    return Table(frame, text_table, words, best)


def trained(results: Results) -> str:
    """Passes of both networks and the share of training sequences that they know, of the sets that measured it."""
    texts = []
    for dataset in results.datasets(STAGE):
        rows = results.rows(STAGE, dataset)
        rows = rows[rows["metric"].isin(["passes", "train_accuracy"])]
        rows = rows[(rows[SIZE] == rows[SIZE].max()).all(axis=1)]
        if len(rows):
            median = rows.groupby(["classifier", "metric"])["value"].median()
            parts = (
                f"{median[name, 'passes']:.0f} of the {words[:2]} network ({percent(median[name, 'train_accuracy'])} %)"
                for name, words in NETWORKS.items()
            )
            texts.append(f"{dataset_text(dataset)} {', '.join(parts)}")
    return "; ".join(texts) or "not measured"


STAGE = "sequences"
SPLITS = {Split.RANDOM: "sequences drawn at random", Split.OBJECTS: "unseen objects"}
METRICS = {Split.RANDOM: "accuracy", Split.OBJECTS: "accuracy_object"}
SHARED = {Split.RANDOM: 0.2 / 0.8, Split.OBJECTS: 0.0}  # test over training share; of the random splits T4.4.10
CLASSIFIERS = {
    "cnn": "CNNs", "cnn_images": "CNN, images alone", "cnn_normals": "CNN, normals alone", "knn": "kNN", "svm": "SVM",
    "knn_no_som": "kNN, without the map", "svm_no_som": "SVM, without the map",
}  # fmt: skip
PRINTED_METHODS = ("cnn", "knn", "svm")  # those of T table 4.9
BLIND, GUIDED = "random", "thesis_ssim"  # the two columns of T table 4.9
SIZE = ["frames", "cells"]


def accuracy(rows: pd.DataFrame, split: Split) -> tuple[float, float, float, int]:
    """(mean, low, high, values) of one strategy, classifier and size: over random splits, or objects left out."""
    rows = rows[(rows["split"] == split) & (rows["metric"] == METRICS[split])]
    values = rows.groupby(["group", "repetition"], dropna=False)["value"].mean()  # several trainings for one object
    return *within(values, SHARED[split]), len(values)


RANDOM, UNSEEN = ({"split": split, "metric": METRICS[split]} for split in (Split.RANDOM, Split.OBJECTS))
WITH_MAP, NO_MAP = ("knn", "svm"), ("knn_no_som", "svm_no_som")
PHRASES = {
    **{("classifier", name): words for name, words in CLASSIFIERS.items()},
    **{("split", split): words for split, words in SPLITS.items()},
    **{("metric", metric): "" for metric in METRICS.values()},
    ("classifier", WITH_MAP): "mean of kNN and SVM with the map",
    ("classifier", NO_MAP): "mean of both without the map",
    ("classifier", (*WITH_MAP, *NO_MAP)): "kNN and SVM, with the map and without,",
    ("classifier", tuple(CLASSIFIERS)): "all classifiers",
}  # fmt: skip
OBJECTS = {  # the pairs: one of each class left out
    "over": ("group", "repetition"), "shared": SHARED[Split.OBJECTS],
    "phrases": PHRASES | {("over", "repetition"): "objects"},
}  # fmt: skip

"""T tables 4.7 and 4.8: the layers of the two networks; T table 4.9: which class of objects is it, by contours."""

from itertools import product

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split
from stages.report.grid import blocks, everywhere, grid, percent, records
from stages.report.items import Table
from stages.report.ranking import Ranking
from stages.report.results import Results
from stages.report.style import label
from stages.report.words import dataset_text

from .rows import BLIND, CLASSIFIERS, GUIDED, METRICS, SIZE, SPLITS, STAGE, accuracy

KEYS = ["objects", "split", "classifier"]
SAID = {
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
    frame["thesis"] = [SAID.get(key, "") for key in zip(frame["network"], frame["layer"], strict=True)]
    frame = frame[["network", "layer", "thesis", "kind", "output", "parameters"]]
    shown = frame.assign(network=frame["network"].map(NETWORKS))
    shown = shown.rename(columns={"kind": "ours", "output": "output of ours"})
    totals = frame.groupby("network")["parameters"].sum()
    return Table(frame, shown, {name: totals[name] for name in NETWORKS})  # no ranking: layers do not compete


def table_4_9(results: Results) -> Table:
    """Accuracy by data set, split, classifier and strategy, beside the thesis's two columns."""
    thesis = results.thesis("table_4_9_sequences").set_index("classifier")
    printed = thesis.rename(columns={"blind": BLIND, "guided": GUIDED}).stack().to_dict()
    found = everywhere(results, STAGE, metric=list(METRICS.values()))
    lines = []
    for source, rows in found.items():
        rows = rows[(rows[SIZE] == rows[SIZE].max()).all(axis=1)]  # with all their frames and cells
        splits = [split for split in SPLITS if split in set(rows["split"])]
        strategies = sorted(rows["method"].unique(), key=lambda method: (method != BLIND, method != GUIDED))
        for split, classifier, method in product(splits, CLASSIFIERS, strategies):
            mine = rows[(rows["method"] == method) & (rows["classifier"] == classifier)]
            lines.append({
                "objects": source, "split": split, "classifier": classifier, "strategy": method,
                **dict(zip(("accuracy", "low", "high", "values"), accuracy(mine, split), strict=True)),
                "thesis": printed.get((classifier, method), np.nan) if split == Split.RANDOM else np.nan,
                "chance": 1 / mine["classes"].max(), "sequences": mine["sequences"].max(),
                "seconds": mine.loc[(mine["split"] == split) & (mine["metric"] == "accuracy"), "seconds"].median(),
            })  # fmt: skip
    frame = pd.DataFrame(lines)
    names = {"objects": dataset_text, "split": SPLITS.get, "classifier": CLASSIFIERS.get}
    cells = blocks(frame, KEYS, "strategy", {"thesis": lambda objects: PRINTED})
    shown = grid(cells, KEYS, "strategy", names, lambda name: f"{label(name)}, %", places=1, printed=PRINTED)
    sizes = frame.groupby("objects", sort=False)[["sequences", "chance"]].max()
    counted = ", ".join(f"{int(row.sequences):,} ({dataset_text(row.Index)})" for row in records(sizes))
    chance = ", ".join(f"{dataset_text(row.Index)} {percent(row.chance, 1)} %" for row in records(sizes))
    words = {"not_run": results.left_out(STAGE), "counted": counted, "chance": chance}
    best = Ranking(shown.columns[-1], among=["objects", "split"], exempt=[PRINTED])
    return Table(frame, shown, words, best)

"""Recognition by contours: layers of the networks, accuracies and claims (T4.4; T tables 4.7, 4.8 and 4.9).

`table_4_7` has the layers of both networks, of T tables 4.7 and 4.8. `accuracy` is shared by table 4.9 and the chart.
The claims compare guided with blind contours, and networks with conventional classifiers, on sequences with all frames
and cells.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from itertools import combinations, product
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split
from stages.charts.datasets import dataset_text
from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import Results
from stages.charts.tables import Ranking, blocks, everywhere, grid, percent, records, within
from stages.report.claims import Claim, highest_of, reading
from stages.report.effects import difference, statistic

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
PRINTED_SET = "princeton_eight"  # 11,400 sequences a strategy, as many as the thesis has
MORE = "princeton_touched"  # fewer sequences of more objects: does it carry over?
OF_MORE: dict[str, Any] = {"dataset": MORE, "within": ("training",)}  # an untrained network spoils no other training
OF_GLANCE: dict[str, Any] = {"dataset": "furniture"}  # the one set on which contours through its points were run
claim = partial(Claim, section="T4.4.10", stage=STAGE, dataset=PRINTED_SET, statistic="whole_sequences",
                phrases=PHRASES)  # fmt: skip
guided = partial(claim, first={"method": GUIDED}, second={"method": BLIND})
cnn = partial(claim, where={"method": GUIDED}, first={"classifier": "cnn"})


@statistic("whole_sequences")
def whole_sequences(results: Results, claim: Claim) -> pd.Series:
    """First side minus second, of the sequences with all their frames and cells."""
    size = results.measured(STAGE, claim.sets[0])[SIZE].max()
    return difference(results, replace(claim, where={**claim.where, **size})).sort_index()


ONE_TOUCH = {"cells": 32, "pitch": 0.01, "metric": "accuracy", "split": Split.OBJECTS}  # the best array of T4.3.2


@statistic("over_one_touch")
def over_one_touch(results: Results, claim: Claim) -> pd.Series:
    """Accuracy of the first side minus that of the best classifier of single touches, by class of the same objects."""
    table = results.measured("sensor_size", claim.sets[0], **ONE_TOUCH)
    table = table.pivot_table(index="group", columns="classifier", values="value")
    return whole_sequences(results, replace(claim, second=0.0)) - table[table.mean().idxmax()]


CONVENTIONAL = (*WITH_MAP, *NO_MAP)
CLASSIFIED = "over ways to classify, not over objects; without the networks, which stopped before they were saturated"
ALIKE = (("bird", "airplane"), ("bust", "vase"))  # by touch, says T4.4.10; its cars are not among the classes


@statistic("alike_confused")
def alike_confused(results: Results, claim: Claim) -> pd.Series:
    """The share of sequences of ALIKE taken for each other, by classifier: the first side's minus the second's.

    Without a second side: minus the share of the mean other pair.
    """
    first = _confusions(results, claim, claim.first)
    if claim.second is None:
        return first[list(ALIKE)].mean(axis=1) - first.drop(columns=list(ALIKE)).mean(axis=1)
    return (first - _confusions(results, claim, claim.other))[list(ALIKE)].mean(axis=1).dropna()


def _confusions(results, claim, selection):
    """A row for each classifier, a column for each pair of classes: the share that is taken for the other class."""
    rows = results.measured(STAGE, claim.sets[0], **claim.where, **selection)
    counts = rows.pivot_table(index="classifier", columns=["group", "predicted"], values="value", fill_value=0.0)
    totals = counts.T.groupby(level="group").sum().T
    pairs = [*ALIKE, *(pair for pair in combinations(totals, 2) if not {pair, pair[::-1]} & {*ALIKE})]
    return pd.DataFrame({
        pair: (counts.get(pair, 0) + counts.get(pair[::-1], 0)) / (totals[pair[0]] + totals[pair[1]]) for pair in pairs
    })  # fmt: skip


def both(claims: Iterable[Claim]) -> Iterator[Claim]:
    """Each claim with sequences drawn at random, as in the thesis, and with unseen objects: does it carry over?"""
    for base in claims:
        words = f"{base.sentence[:-1]}, on objects never touched too."
        yield replace(base, key=f"{base.key}_random", where={**base.where, **RANDOM}, shared=SHARED[Split.RANDOM])
        of = "" if base.is_ours else f"{base.key}_random"
        yield replace(base, key=f"{base.key}_unseen", of=of, sentence=words, where={**base.where, **UNSEEN}, **OBJECTS)


BASES = [
    guided(key="contours_guided", where={"classifier": "cnn"},
           sentence="Contours through visually interesting points are better than blind ones."),
    guided(key="contours_guided_all", where={"classifier": PRINTED_METHODS},
           sentence="Guided contours are better, whichever the classifier.", note="mean of the classifiers",
           readings=tuple(reading(f"{CLASSIFIERS[way]} alone", where={"classifier": way}, note="")
                          for way in PRINTED_METHODS)),
    guided(key="contours_glance", section="ours", where={"classifier": "cnn"}, first={"method": "glance"},
           sentence="Contours through points of our glance are better than blind ones."),
    cnn(key="contours_cnn_best", sentence="Networks lead on sequences.", second={"classifier": highest_of(*WITH_MAP)},
        readings=(reading("beside classifiers without the map, too",
                          second={"classifier": highest_of(*WITH_MAP, *NO_MAP)}),)),
    *(
        cnn(key=f"contours_both_over_{alone}", section="ours", second={"classifier": f"cnn_{alone}"},
            sentence=f"Images and normals together beat the {alone} alone.")
        for alone in ("images", "normals")
    ),
    cnn(key="contours_map_helps", section="T4.4.9", first={"classifier": WITH_MAP}, second={"classifier": NO_MAP},
        sentence="Reducing the features by a self-organising map helps."),
]  # fmt: skip
PRIMARY = [entry for entry in both(BASES) if not entry.is_ours]
CLAIMS = [
    *PRIMARY,
    *(replace(entry, key=f"{entry.key}_more", of=entry.of or entry.key, **OF_MORE, printed=0) for entry in PRIMARY),
    *(
        replace(entry, **(OF_GLANCE if entry.first == {"method": "glance"} else OF_MORE))
        for entry in both(BASES) if entry.is_ours
    ),
    *(
        claim(key=key, sentence=sentence, first={"method": GUIDED if second is None else BLIND}, second=second,
              where={"metric": "confusion", "split": Split.RANDOM, "classifier": CONVENTIONAL}, over=("classifier",),
              statistic="alike_confused", unit="points of the share", shared=0.0, checked=False,
              note=f"{note}; {CLASSIFIED}",
              phrases=PHRASES | {("over", "classifier"): "classifiers of the same sequences"},
              readings=(reading("unseen objects", where={"split": Split.OBJECTS}),
                        reading("with the networks", where={"classifier": tuple(CLASSIFIERS)})))
        for key, sentence, second, note in (
            ("alike_confused", "Bird and plane, head and vase are confused more than the mean other pair.", None,
             "share that is taken for each other, minus that of the mean other pair"),
            ("guided_confuses_less", "Guided contours confuse classes that feel alike less.", {"method": GUIDED},
             "share of birds and planes, heads and vases that are taken for each other"),
        )
    ),
    claim(key="contours_over_one_touch", section="T4.4", dataset=("princeton_touched", "furniture"), printed=0,
          sentence="Sequences distinguish more objects than single touches do.", statistic="over_one_touch",
          where={"method": GUIDED} | UNSEEN, first={"classifier": "cnn"}, over=("group",), shared=0.0,
          note="minus the best of four classifiers of one touch, of the same objects",
          readings=tuple(reading(CLASSIFIERS[way], first={"classifier": way}) for way in (*WITH_MAP, *NO_MAP))),
    guided(key="contours_guided_gain", where={"classifier": "cnn"} | RANDOM, shared=SHARED[Split.RANDOM], margin=-15.68,
           sentence="Guided contours gain the printed 15.68 points of accuracy by networks, or more."),
    claim(key="contours_random_flatters", section="ours", **OF_MORE,
          sentence="Drawing test sequences at random flatters: the same objects are known.",
          where={"method": GUIDED, "classifier": "cnn"}, first=RANDOM, second=UNSEEN, mean_of="first", **OBJECTS),
]  # fmt: skip

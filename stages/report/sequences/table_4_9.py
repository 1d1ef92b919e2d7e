"""T table 4.9: which class of objects is it, by following contours."""

import pandas as pd

from stages.kit.split import Split
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label
from stages.report.words import dataset_text

from .rows import BLIND, CLASSIFIERS, GUIDED, PRINTED, SPLITS, accuracy, everywhere

COLUMNS = {BLIND: "blind", GUIDED: "guided"}  # of the thesis's table
NOTES = [
    "Accuracy in per cent [95 % interval], then the thesis's figure. Guided in the thesis is enhanced attention; our "
    "own model of gaze stands beside it.",
    "The thesis draws 20 % of all sequences at random for testing. Every object is then in training too, with planes "
    "that nearly coincide with those tested. `unseen objects` holds one object of every class out and trains on the "
    "others: what a class is worth on an object never touched before.",
    "Intervals: at random, over repeated splits of the same sequences, widened for what they share (Nadeau and Bengio "
    "2003); with unseen objects, over the objects held out.",
    "kNN and SVM: 16 directions of each imprint and 3 normals as 19 series, their db2 wavelets, the 20 most "
    "informative of 228 numbers, a self-organising map of 2 to 6 dimensions chosen on a part of the training data. "
    "`Without the map` feeds the 20 numbers themselves (the SVM's gamma is then one over their number, since 1 is for "
    "few).",
    "CNNs adds up the probabilities of the 3D network on the images and the 1D network on the normals (tables 4.7 and "
    "4.8).",
]
PRINTED_SEQUENCES = 22800  # T4.4.10


def build(results):
    thesis = results.thesis("table_4_9_sequences").set_index("classifier")
    frame = pd.DataFrame(
        [
            _line(rows, source, split, classifier, method, thesis)
            for source, rows in everywhere(results).items()
            for split in SPLITS
            for classifier in CLASSIFIERS
            for method in _order(rows)
            if split in set(rows["split"])
        ]
    )
    also = [f"Not run: {note}." for note in _notes(results)]
    counts = [
        f"{int(own['sequences'].max()):,} ({dataset_text(source)})"
        for source, own in frame.groupby("objects", sort=False)
    ]
    also.append(f"Sequences a strategy: {', '.join(counts)}; {PRINTED_SEQUENCES:,} in all in the thesis.")
    title = "Table 4.9: recognising classes of objects by following contours, beside the thesis"
    return Table(title, frame, NOTES + also, _wide(frame))


def _notes(results):
    return results.notes("sequences") if "sequences" in results.stages else []


def _order(rows):
    """The strategies: blind, the thesis's, the others."""
    found = list(dict.fromkeys(rows["method"]))
    return sorted(found, key=lambda method: list(COLUMNS).index(method) if method in COLUMNS else len(COLUMNS))


def _line(rows, source, split, classifier, method, thesis):
    mine = rows[(rows["method"] == method) & (rows["classifier"] == classifier)]
    mean, low, high, count = accuracy(mine, split)
    printed = float("nan")
    if split == Split.RANDOM and classifier in PRINTED and method in COLUMNS:
        printed = thesis.loc[classifier, COLUMNS[method]]
    timed = mine[(mine["split"] == split) & (mine["metric"] == "accuracy")]
    return {
        "objects": source, "split": split, "classifier": classifier, "strategy": method, "accuracy": mean,
        "low": low, "high": high, "values": count, "thesis": printed, "chance": 1 / mine["classes"].max(),
        "sequences": mine["sequences"].max(), "seconds": timed["seconds"].median(),
    }  # fmt: skip


def _wide(frame):
    text = [
        with_interval(row.accuracy, row.low, row.high, 100, 1)
        + (f" · {100 * row.thesis:.1f}" if row.thesis == row.thesis else "")
        for row in frame.itertuples()
    ]
    keys = ["objects", "split", "classifier"]
    shown = frame.assign(text=text).pivot(index=keys, columns="strategy", values="text")
    shown = shown.loc[list(dict.fromkeys(frame[keys].itertuples(index=False, name=None)))]
    shown = shown[list(dict.fromkeys(frame["strategy"]))].rename(columns=lambda name: f"{label(name)}, %")
    chance = frame.groupby(keys, sort=False)["chance"].first()
    shown = shown.assign(chance=[f"{100 * value:.1f}" for value in chance.loc[shown.index]]).reset_index()
    shown["objects"] = shown["objects"].map(dataset_text)
    return shown.assign(split=shown["split"].map(SPLITS), classifier=shown["classifier"].map(CLASSIFIERS))

"""What the tables of recorded touches read: rows of stage recorded_networks."""

import pandas as pd

from stages.kit.split import Split, shared_by
from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.networks import PRETRAINED, PRINTED, STARTS
from stages.report.results import NotRun
from stages.report.style import label, start

from .pairs import CLASSICAL, KEYS, accuracies, gain, guesses, measured_rows, shared

DATA = {
    "pressure": "pressure array, 22 objects",
    "grasps_object": "fingertips, which of 51 objects",
    "grasps_slip": "fingertips, slips or not",
    "vt60": "VT-60 (BathTip)",
    "vitac": "ViTac (GelSight)",
    "bigs": "BiGS (Barrett hand)",
}
SPLITS = {
    Split.RANDOM: "touches at random",
    Split.BLOCKS: "neighbouring touches together",
    Split.TEST_OBJECTS: "objects kept for the test",
    "groups": "objects or recordings together",
}
ABSENT = (
    "Not run: the data set is not at hand. Its reader is tested on files in its layout; "
    "`experiment=recorded_touches` says how to switch it on."
)
NOTE = (
    "Accuracy in per cent, a quarter of the touches held out. Recorded touches that are at hand: table real_networks."
)


def printed_table(results, data, printed, title):
    """The Table of one of the thesis's data sets: its figures, and ours where the data were at hand."""
    thesis = results.thesis(printed).set_index("network")
    rows = measured_rows(results, "accuracy")
    mine = rows[(rows["data"] == data) & (rows["split"] == Split.RANDOM)]
    frame = pd.DataFrame([_printed_line(mine, thesis, *pair) for pair in PRINTED.items()])
    return Table(title, frame, [NOTE] if len(mine) else [ABSENT, NOTE], _printed_shown(frame))


def _printed_line(mine, thesis, network, name):
    line = {"network": network}
    for mode in ("finetuned", "frozen"):
        own = mine[(mine["method"] == network) & (mine["mode"] == mode) & (mine["weights"] == "imagenet")]
        mean, low, high = interval(own["value"], shared_by("random"))
        line |= {
            mode: mean,
            f"{mode}_low": low,
            f"{mode}_high": high,
            f"{mode}_thesis": thesis.loc[name, f"acc_{mode}"],
        }
    return line


def _printed_shown(frame):
    shown = pd.DataFrame({"network": frame["network"].map(label)})
    for mode in ("finetuned", "frozen"):
        triples = zip(frame[mode], frame[f"{mode}_low"], frame[f"{mode}_high"], strict=True)
        shown[f"{label(mode)}: ours, %"] = [with_interval(*triple, 100, 1) for triple in triples]
        shown[f"{label(mode)}: thesis, %"] = [f"{100 * value:.1f}" for value in frame[f"{mode}_thesis"]]
    return shown


def measured_lines(results):
    """A frame with a row a data set, split, network, start, mode and size that was measured, the classical first.

    accuracy with low and high over so many values; guess; over_features and over_random: the gain over the classical
    features and over the same network untrained, each with _low, _high and the number of _pairs.
    """
    found = accuracies(results)
    pretrained = measured_rows(results, "accuracy").dropna(subset=["pretrained"]).groupby(KEYS)["pretrained"].first()
    guess = {pair: _guess(results, *pair) for pair in dict.fromkeys(key[:2] for key in found)}
    lines = [_line(found, key) | {"guess": guess[key[:2]], "pretrained": pretrained.get(key)} for key in found]
    order = {name: k for k, name in enumerate([*DATA, *SPLITS, CLASSICAL[0]])}
    by = {"by": ["data", "split", "method"], "key": lambda names: names.map(order).fillna(len(order))}
    return pd.DataFrame(lines).sort_values(**by, kind="stable", ignore_index=True)


def _line(found, key):
    data, split, method, _, mode, size = key
    mean, low, high = interval(found[key], shared(split))
    line = dict(zip(KEYS, key, strict=True)) | {"accuracy": mean, "low": max(low, 0.0), "high": min(high, 1.0)}
    line["values"] = len(found[key])
    controls = {"features": (data, split, *CLASSICAL), "random": (data, split, method, "random", mode, size)}
    for name, control in controls.items():
        differences = gain(found, key, control) if key != control else []
        mean, low, high = interval(differences, shared(split))
        over = f"over_{name}"
        line |= {over: mean, f"{over}_low": low, f"{over}_high": high, f"{over}_pairs": len(differences)}
    return line


def _guess(results, data, split):
    try:
        return guesses(results, data, split).mean()
    except NotRun:
        return float("nan")


def origin(weights, pretrained):
    """What a row starts from, and which of ImageNet's weights it pretrained."""
    if weights not in STARTS:
        return "–"
    said = PRETRAINED.get(pretrained, "") if weights == "imagenet" else ""
    return f"{start(weights)} ({said})" if said else start(weights)

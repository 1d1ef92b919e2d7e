"""The common shape of T tables 5.3 and 5.4: accuracies of all networks on one kind of imprints."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.networks import MODES, PRETRAINED, PRINTED, SPLITS, STARTS, accuracy, everywhere
from stages.report.results import NotRun
from stages.report.style import label, start
from stages.report.words import dataset_text

NOTES = [
    "Accuracy in per cent [95 % interval]. Touches at random: a quarter of all touches is tested, as in the thesis, so "
    "that every object is known; the interval runs over repeated splits, widened for what they share. Unseen objects: "
    "one object of each class is left out of training; the interval runs over such folds, widened for the objects that "
    "they share in training. Few folds make it wide, and say little of other objects.",
    "Every network ends in global average pooling and one new linear layer. The thesis keeps the two fully connected "
    "layers of AlexNet and VGG16 before the last; no registry of packages has their weights.",
    "Not run: the default run trains MobileNetV2 alone, for the cost of others, and no other network was fine-tuned on "
    "the thesis's classes; profile=paper trains all. No package has GoogLeNet's weights.",
    "Random weights are not in the thesis: they tell what sight adds from what the architecture alone does. How well "
    "they come to know their own training touches in the few epochs that fine-tuning has was not measured.",
]


def network_table(results, data, printed, title, notes):
    """The Table of all networks on one kind of imprints beside the thesis's, whose table is `printed`."""
    thesis = results.thesis(printed).set_index("network")
    lines = [
        _line(rows[rows["data"] == data], source, _chance(results, source, split), thesis, *setting, split)
        for source, rows in everywhere(results).items()
        for setting in _settings(rows)
        for split in SPLITS
    ]
    frame = pd.DataFrame(lines)
    ran = frame.groupby(["network", "weights", "mode"])["values"].transform("sum") > 0
    frame = frame[ran | ((frame["weights"] == "imagenet") & frame["network"].isin(PRINTED))]
    if not frame["values"].any():
        raise NotRun(f"no accuracies on {data}", "transfer")
    return Table(title, frame, notes + _missing(results), _wide(frame))


def _chance(results, dataset, split):
    """The share that guessing gets right on a split of a set; NaN where it was not written."""
    rows = results.rows("transfer", dataset)
    return rows.loc[(rows["metric"] == "chance") & (rows["split"] == split), "value"].mean()


def _settings(rows):
    networks = list(dict.fromkeys([*PRINTED, *rows["method"].dropna()]))
    return [(network, weights, mode) for network in networks for weights in STARTS for mode in MODES]


def _line(rows, source, chance, thesis, network, weights, mode, split):
    mine = rows[(rows["method"] == network) & (rows["weights"] == weights) & (rows["mode"] == mode)]
    mean, low, high, count = accuracy(mine, split)
    printed = float("nan")
    if weights == "imagenet" and split == "random" and network in PRINTED:
        printed = thesis.loc[PRINTED[network], f"acc_{mode}"]
    pretrained = next(iter(mine.loc[mine["split"] == split, "pretrained"].dropna()), None)
    return {
        "objects": source, "network": network, "weights": weights, "pretrained": pretrained, "mode": mode,
        "split": split,
        "accuracy": mean, "low": low, "high": high, "values": count, "chance": chance, "above_chance": mean - chance,
        "thesis": printed, "seconds": mine.loc[mine["split"] == split, "seconds"].median(),
    }  # fmt: skip


def _wide(frame):
    text = [with_interval(row.accuracy, row.low, row.high, 100, 1) for row in frame.itertuples()]
    head = [
        f"{dataset_text(row.objects)}, {SPLITS[row.split]} (chance {100 * row.chance:.1f}), %"
        for row in frame.itertuples()
    ]
    pretrained = frame.groupby("network")["pretrained"].transform(lambda values: next(iter(values.dropna()), ""))
    shown = pd.DataFrame(
        {
            "network": frame["network"].map(label),
            "starts from": [_starts(*pair) for pair in zip(frame["weights"], pretrained, strict=True)],
            "filters": frame["mode"].map(label),
            "thesis, %": [f"{100 * value:.1f}" if value == value else "" for value in frame["thesis"]],
        }
    ).assign(head=head, text=text)
    keys = ["network", "starts from", "filters"]
    wide = shown.pivot(index=keys, columns="head", values="text")
    wide = wide.loc[list(dict.fromkeys(shown[keys].itertuples(index=False, name=None)))][list(dict.fromkeys(head))]
    printed = shown.groupby(keys)["thesis, %"].max().loc[wide.index]
    return wide.assign(**{"thesis, %": printed.replace("", "–")}).reset_index()


def _starts(weights, pretrained):
    said = PRETRAINED.get(pretrained, "") if weights == "imagenet" else ""
    return f"{start(weights)} ({said})" if said else start(weights)


def _missing(results):
    return [f"Not run on {name}: {note}." for name in everywhere(results) for note in results.notes("transfer", name)]

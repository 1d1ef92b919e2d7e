"""What the tables, figures and claims of chapter 5 read: trainings of networks on simulated imprints."""

import pandas as pd

from stages.report.intervals import HOLD_OUT, interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import NotRun
from stages.report.style import label, start

PRINTED = {
    "alexnet": "AlexNet",
    "googlenet": "GoogLeNet",
    "vgg16": "VGG16",
    "resnet50": "ResNet50",
    "mobilenet_v2": "MobileNetV2",
}  # as the thesis calls them, in its order
FINE, COARSE = "imprints128", "imprints16"
SPLITS = {"random": "touches at random", "objects": "unseen objects"}
FOLD_OUT = 1 / 2  # test over training share of a fold: one object of three
PSB, PSB_OUT = "princeton", 1 / 4  # the thesis's classes: one object of five
STARTS, MODES = ("imagenet", "random"), ("finetuned", "frozen")
HAD = {"complete": "", "convolutions": "its convolutions", "converted": "converted from Keras"}
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


def measured(results):
    """Accuracies of this run; NotRun where there is none."""
    return results.measured("transfer", metric="accuracy")


def shared(split, source=None):
    """Test over training share of a split of a data set."""
    return HOLD_OUT if split == "random" else {PSB: PSB_OUT}.get(source, FOLD_OUT)


def on_psb(results):
    """The results with the rows on the thesis's own classes for this run's; NotRun where these were not measured."""
    return results.instead("transfer", psb(results))


def psb(results):
    """Rows on the thesis's own classes: MobileNetV2's, and other networks' where they were measured; NotRun without."""
    rows = results.transfer(PSB)
    try:
        return pd.concat([rows, results.transfer(f"{PSB}_networks")], ignore_index=True)
    except NotRun:
        return rows


def everywhere(results):
    """{where the objects come from: accuracies}: this run's, and those on the thesis's classes where they are there."""
    found = {}
    try:
        rows = measured(results)
        found[rows["object"].iloc[0]] = rows
    except NotRun as missing:
        absent = missing
    try:
        rows = psb(results).dropna(subset=["value"])
        found |= {f"{name}, the thesis's classes": own for name, own in rows.groupby("object")}
    except NotRun:
        if not found:
            raise absent from None
    return {name: rows[rows["metric"] == "accuracy"] for name, rows in found.items()}


def accuracy(rows, split):
    """(mean, low, high, values) of the rows of one setting."""
    mine = rows[rows["split"] == split]
    values = mine["value"]
    mean, low, high = interval(values, shared(split, next(iter(mine["object"]), None)))
    return mean, max(low, 0.0), min(high, 1.0), len(values)


def chances(results):
    """{(where the objects come from, split): the share that guessing gets right}."""
    found = {}
    for name in everywhere(results):
        source = name.partition(",")[0]
        try:
            rows = psb(results) if "," in name else results.measured("transfer")
        except NotRun:
            continue
        told = rows[(rows["metric"] == "chance") & (rows["object"] == source)].dropna(subset=["value"])
        found |= {(name, split): value for split, value in told.groupby("split")["value"].mean().items()}
    return found


def network_table(results, data, printed, title, notes):
    """The Table of all networks on one kind of imprints beside the thesis's, whose table is `printed`."""
    thesis = results.thesis(printed).set_index("network")
    chance = chances(results)
    lines = [
        _line(rows[rows["data"] == data], source, chance.get((source, split), float("nan")), thesis, *setting, split)
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


def _settings(rows):
    networks = list(dict.fromkeys([*PRINTED, *rows["method"].dropna()]))
    return [(network, weights, mode) for network in networks for weights in STARTS for mode in MODES]


def _line(rows, source, chance, thesis, network, weights, mode, split):
    mine = rows[(rows["method"] == network) & (rows["weights"] == weights) & (rows["mode"] == mode)]
    mean, low, high, count = accuracy(mine, split)
    printed = float("nan")
    if weights == "imagenet" and split == "random" and network in PRINTED:
        printed = thesis.loc[PRINTED[network], f"acc_{mode}"]
    had = next(iter(mine.loc[mine["split"] == split, "had"].dropna()), None)
    return {
        "objects": source, "network": network, "weights": weights, "had": had, "mode": mode, "split": split,
        "accuracy": mean, "low": low, "high": high, "values": count, "chance": chance, "above_chance": mean - chance,
        "thesis": printed, "seconds": mine.loc[mine["split"] == split, "seconds"].median(),
    }  # fmt: skip


def _wide(frame):
    text = [with_interval(row.accuracy, row.low, row.high, 100, 1) for row in frame.itertuples()]
    head = [f"{row.objects}, {SPLITS[row.split]} (chance {100 * row.chance:.1f}), %" for row in frame.itertuples()]
    had = frame.groupby("network")["had"].transform(lambda values: next(iter(values.dropna()), ""))
    shown = pd.DataFrame(
        {
            "network": frame["network"].map(label),
            "starts from": [_starts(*pair) for pair in zip(frame["weights"], had, strict=True)],
            "filters": frame["mode"].map(label),
            "thesis, %": [f"{100 * value:.1f}" if value == value else "" for value in frame["thesis"]],
        }
    ).assign(head=head, text=text)
    keys = ["network", "starts from", "filters"]
    wide = shown.pivot(index=keys, columns="head", values="text")
    wide = wide.loc[list(dict.fromkeys(shown[keys].itertuples(index=False, name=None)))][list(dict.fromkeys(head))]
    printed = shown.groupby(keys)["thesis, %"].max().loc[wide.index]
    return wide.assign(**{"thesis, %": printed.replace("", "–")}).reset_index()


def _starts(weights, had):
    said = HAD.get(had, "") if weights == "imagenet" else ""
    return f"{start(weights)} ({said})" if said else start(weights)


def _missing(results):
    notes = results.notes("transfer") if "transfer" in results.measured_stages else []
    return [f"Not run here: {note}." for note in notes]

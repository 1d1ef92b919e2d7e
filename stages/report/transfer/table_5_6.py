"""T table 5.6: which layers of MobileNetV2 may stay as sight left them."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.networks import FINE, SPLITS, accuracy, everywhere
from stages.report.results import NotRun
from stages.report.words import dataset_text

ALL, NONE = "all", "none"  # as the thesis's table calls them
NOTES = [
    "Accuracy of MobileNetV2 on imprints of 128 x 128 in per cent [95 % interval], ImageNet's weights, all layers "
    "learning but those named. Layers are numbered as in Matlab: 1 to 17 the first three blocks, 18 to 139 the middle, "
    "140 to 154 the last block, the last convolution and the classification. A frozen layer keeps its weights and the "
    "statistics of its normalisation.",
    "The hybrid network shares layers 18 to 139.",
]


def build(results):
    thesis = results.thesis("table_5_6_frozen_layers_mobilenetv2").set_index("frozen_layers")["accuracy"]
    lines = [
        _line(rows, source, layers, split, printed)
        for source, rows in everywhere(results).items()
        for layers, printed in thesis.items()
        for split in SPLITS
    ]
    frame = pd.DataFrame(lines)
    if not frame["values"].any():
        raise NotRun("no accuracies of MobileNetV2 with frozen layers", "transfer")
    return Table("Table 5.6: frozen layers of MobileNetV2", frame, NOTES, _wide(frame))


def mode_of(layers):
    """What the stage transfer calls a row of the thesis's table."""
    return {ALL: "frozen", NONE: "finetuned"}.get(layers, layers)


def _line(rows, source, layers, split, printed):
    mine = rows[(rows["method"] == "mobilenet_v2") & (rows["weights"] == "imagenet") & (rows["data"] == FINE)]
    mean, low, high, count = accuracy(mine[mine["mode"] == mode_of(layers)], split)
    known = {"objects": source, "frozen_layers": layers, "split": split, "values": count}
    return known | {"accuracy": mean, "low": low, "high": high, "thesis": printed}


def _wide(frame):
    text = [with_interval(row.accuracy, row.low, row.high, 100, 1) for row in frame.itertuples()]
    head = [f"{dataset_text(row.objects)}, {SPLITS[row.split]}, %" for row in frame.itertuples()]
    wide = frame.assign(head=head, text=text).pivot(index="frozen_layers", columns="head", values="text")
    wide = wide.loc[list(dict.fromkeys(frame["frozen_layers"]))][list(dict.fromkeys(head))].reset_index()
    thesis = frame.groupby("frozen_layers")["thesis"].first().loc[wide["frozen_layers"]]
    wide["thesis, %"] = [f"{100 * value:.1f}" for value in thesis]
    return wide.rename(columns={"frozen_layers": "frozen layers"})

"""T table 5.4: what networks that learned by sight make of simulated imprints."""

import numpy as np
import pandas as pd

from stages.report.intervals import HOLD_OUT, interval
from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.style import label, start

OURS = {
    "AlexNet": "alexnet",
    "GoogLeNet": "googlenet",
    "VGG16": "vgg16",
    "ResNet50": "resnet50",
    "MobileNetV2": "mobilenet_v2",
}
STARTS, MODES = ("imagenet", "random"), ("finetuned", "frozen")
NOTES = [
    "Accuracy in per cent [95 % interval]. The thesis trained on 128 x 128 simulated imprints of its own six toys in "
    "Matlab, for ten epochs; ours are imprints of everyday meshes, with torchvision's ImageNet weights. Compare the "
    "order, not the digits.",
    "Random weights are not in the thesis: they tell what sight adds from what the architecture alone does.",
    "The interval runs over repetitions on the same imprints, widened for what they share; it does not carry to other "
    "objects.",
]


def build(results):
    rows = results.measured("transfer", metric="accuracy")
    chance = results.measured("transfer", metric="chance")["value"].mean()
    thesis = results.thesis("table_5_4_simulated_fsr_128x128").set_index("network")
    settings = [(name, weights, mode) for name in thesis.index for weights in STARTS for mode in MODES]
    lines = [_line(rows, *setting) for setting in settings]
    for line in lines:
        line["chance"] = chance
        line["thesis"] = float("nan")
        if line["weights"] == "imagenet":
            line["thesis"] = thesis.loc[line["network"], f"acc_{line['mode']}"]
    kept = [line for line in lines if line["repetitions"] or line["weights"] == "imagenet"]
    frame = pd.DataFrame(kept)
    return Table("Table 5.4: what was learned by sight, used for touch", frame, NOTES, _shown(frame))


def _line(rows, network, weights, mode):
    mine = rows[(rows["method"] == OURS[network]) & (rows["weights"] == weights) & (rows["mode"] == mode)]
    mean, low, high = interval(mine["value"], HOLD_OUT)
    found = {"accuracy": mean, "low": np.maximum(low, 0.0), "high": np.minimum(high, 1.0)}
    found |= {"repetitions": len(mine), "seconds": mine["seconds"].median()}
    return {"network": network, "weights": weights, "mode": mode} | found


def _shown(frame):
    return pd.DataFrame(
        {
            "network": frame["network"],
            "starts from": frame["weights"].map(start),
            "filters": frame["mode"].map(label),
            "ours, %": [with_interval(row.accuracy, row.low, row.high, 100, 1) for row in frame.itertuples()],
            "thesis, %": [f"{100 * value:.1f}" if value == value else "–" for value in frame["thesis"]],
            "chance, %": [f"{100 * value:.1f}" for value in frame["chance"]],
            "seconds": frame["seconds"].map(number),
            "repetitions": frame["repetitions"],
        }
    )

"""T figure 5.4: how far training on touch moves the weights of each network, and of each layer of MobileNetV2."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.report.drawing import CYCLE, GREY, INK, MARKERS, label, plt, start
from stages.report.items import Figure
from stages.report.networks import COARSE, FINE, NETWORK, of_passes
from stages.report.results import Results
from stages.report.tables import everywhere, grouped, records
from stages.report.words import dataset_text

from .figure_5_3 import CELLS

TINTS = {(FINE, "imagenet"): "#0072B2", (COARSE, "imagenet"): "#D55E00", (FINE, "random"): "#767676"}
SHORT = {"Conv1": "c1", "expanded_conv": "b0", "Conv_1": "c2"}  # of the first and the last parts
WHERE = {"split": "random", "mode": "finetuned"}
SHARED = ("block_2", "block_15")  # the ends of the middle that the hybrid network shares


def build(results: Results) -> Figure:
    """As printed, the mean change of each network on each data set; below, that of each layer of MobileNetV2."""
    found = everywhere(results, "transfer", metric="weight_change", **WHERE)
    printed = pd.DataFrame([
        {"on": f"{dataset_text(dataset)}, {CELLS[data]}, from {start(weights)}", "network": network,
         "mean": own["value"].mean(), "low": own["value"].min(), "high": own["value"].max(), "trainings": len(own)}
        for dataset, rows in found.items()
        for (network, data, weights), own in grouped(of_passes(rows), ["method", "data", "weights"])
    ])  # fmt: skip
    figure, (above, below) = plt.subplots(2, 1, figsize=(9.2, 7.4), height_ratios=[3, 3.8])
    figure.subplots_adjust(hspace=0.4)
    _draw_networks(above, printed)
    _draw_layers(below, results)
    for axes, columns in ((above, 2), (below, 3)):
        axes.legend(fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), ncols=columns)
    for axes in (above, below):
        axes.set_yscale("log")
        axes.set_ylabel("mean squared change of weights,\neach layer's scaled to 0..1")
        axes.grid(axis="y")
    means = [f"{label(row.network)} {row.mean:.2g} ({row.on}, {row.trainings} trainings)" for row in records(printed)]
    return Figure(figure, {"means": "; ".join(means)}, printed)


def _draw_networks(axes: Axes, frame: pd.DataFrame) -> None:
    """A group of dots a network, a colour a data set; lines from the least to the greatest of the trainings."""
    networks, sets = list(dict.fromkeys(frame["network"])), list(dict.fromkeys(frame["on"]))
    for k, (name, tint) in enumerate(zip(sets, CYCLE, strict=False)):
        own = frame[frame["on"] == name]
        x = own["network"].map(networks.index) + 0.12 * (k - (len(sets) - 1) / 2)
        axes.vlines(x, own["low"], own["high"], color=tint, lw=1.2, alpha=0.6)
        axes.plot(x, own["mean"], MARKERS[k], color=tint, ms=6, mec="white", label=name)
    axes.set_xticks(range(len(networks)), [label(name) for name in networks])


def _draw_layers(axes: Axes, results: Results) -> None:
    """Change of each convolution of MobileNetV2, by the array and the weights that it started from."""
    mine = of_passes(results.measured("transfer", metric="layer_weight_change", method=NETWORK, **WHERE))
    parts = mine.groupby("layer", sort=False)["part"].first()
    for (data, weights), tint in TINTS.items():
        one = mine[(mine["data"] == data) & (mine["weights"] == weights)]
        if len(one):
            spread = one.groupby("layer")["value"].agg(["mean", "min", "max"]).loc[parts.index]
            axes.fill_between(range(len(parts)), spread["min"], spread["max"], color=tint, alpha=0.18, lw=0)
            words = f"{CELLS[data]}, from {start(weights)}"
            axes.plot(spread["mean"].to_numpy(), color=tint, marker="o", ms=3, lw=1.2, label=words)
    starts, middle = np.flatnonzero(parts != parts.shift()), np.flatnonzero(parts.isin(SHARED))
    names = [SHORT.get(part, part.replace("block_", "b")) for part in map(str, parts.iloc[starts])]
    axes.set_xticks(starts, names, fontsize=7.5)
    axes.tick_params(axis="x", colors=GREY)
    for end in (middle[0] - 0.5, middle[-1] + 0.5):
        axes.axvline(end, color=INK, lw=0.9, ls="--")
    axes.set_xlabel(
        f"convolutions of MobileNetV2 on {dataset_text(mine['dataset'].iloc[0])}, from the image to the classes"
    )

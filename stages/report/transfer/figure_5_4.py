"""T figure 5.4: how far training on touch moves the weights, layer by layer of MobileNetV2."""

import numpy as np

from stages.report.items import Figure
from stages.report.networks import COARSE, FINE, NETWORK, of_passes
from stages.report.results import Results
from stages.report.style import GREY, INK, label, plt, start

from .figure_5_3 import CELLS

TINTS = {(FINE, "imagenet"): "#0072B2", (COARSE, "imagenet"): "#D55E00", (FINE, "random"): "#767676"}
SHORT = {"Conv1": "c1", "expanded_conv": "b0", "Conv_1": "c2"}  # of the first and the last parts
SHARED = ("block_2", "block_15")  # the ends of the middle that the hybrid network shares


def build(results: Results) -> Figure:
    """Change of each convolution of MobileNetV2, by the array and the weights that it started from."""
    where = {"metric": "layer_weight_change", "split": "random", "mode": "finetuned"}
    mine = of_passes(results.measured("transfer", **where, method=NETWORK))
    parts = mine.groupby("layer", sort=False)["part"].first()
    figure, axes = plt.subplots(figsize=(9.2, 3.8))
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
    axes.set_yscale("log")
    axes.set_ylabel("mean squared change of weights,\neach layer's scaled to 0..1")
    axes.set_xlabel("convolutions of MobileNetV2, from the image to the classes")
    axes.grid(axis="y")
    axes.legend(fontsize=8.5, loc="lower left", bbox_to_anchor=(0, 1), ncols=3)
    every = of_passes(results.measured("transfer", **where, data=FINE))
    kinds = every.groupby(["method", "weights"], sort=False)["value"]
    said = [f"{label(network)} from {start(str(weights))} {one.mean():.2g}" for (network, weights), one in kinds]
    return Figure(figure, {"means": "; ".join(said)})

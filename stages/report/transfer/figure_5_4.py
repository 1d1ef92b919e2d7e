"""T figure 5.4: how far training on touch moves the weights, layer by layer of MobileNetV2."""

import pandas as pd

from stages.report.items import Figure
from stages.report.networks import COARSE, FINE
from stages.report.results import NotRun
from stages.report.style import GREY, INK, label, plt, save

LINES = {
    (FINE, "imagenet"): ("128 x 128, from ImageNet", "#0072B2"),
    (COARSE, "imagenet"): ("16 x 16, from ImageNet", "#D55E00"),
    (FINE, "random"): ("128 x 128, from random weights", "#767676"),
}
SHORT = {"Conv1": "c1", "expanded_conv": "b0", "Conv_1": "c2"}  # of the first and the last parts
SHARED = ("block_2", "block_15")  # the middle that the hybrid network shares


def build(results):
    changes = layer_changes(results)
    changes = changes[changes["split"] == "random"]
    mine = changes[(changes["network"] == "mobilenet_v2") & (changes["mode"] == "finetuned")]
    if mine.empty:
        raise NotRun("MobileNetV2 was not fine-tuned", "transfer")
    order = list(dict.fromkeys(mine["layer"]))
    parts = mine.drop_duplicates("layer").set_index("layer")["part"]
    figure, axes = plt.subplots(figsize=(9.2, 3.8))
    for (data, weights), (words, tint) in LINES.items():
        one = mine[(mine["data"] == data) & (mine["weights"] == weights)]
        if len(one):
            spread = one.groupby("layer")["value"].agg(["mean", "min", "max"]).loc[order]
            axes.fill_between(range(len(order)), spread["min"], spread["max"], color=tint, alpha=0.18, lw=0)
            axes.plot(spread["mean"].to_numpy(), color=tint, marker="o", ms=3, lw=1.2, label=words)
    _blocks(axes, list(parts.loc[order]))
    axes.set_yscale("log")
    axes.set_ylabel("mean squared change of weights,\neach layer's scaled to 0..1")
    axes.set_xlabel("convolutions of MobileNetV2, from the image to the classes")
    axes.grid(axis="y")
    axes.legend(fontsize=8.5, loc="lower left", bbox_to_anchor=(0, 1), ncols=3)
    means = "; ".join(_means(changes))
    return Figure(
        "Figure 5.4: which filters change for touch",
        "Mean squared change of each convolution of MobileNetV2 in fine-tuning, on a logarithmic axis, by depth.",
        "Touches at random. Band: from the least to the greatest of the trainings. Between the dashed "
        f"lines: what the hybrid network shares. Mean over the convolutions of a network: {means}.",
        [save(figure, results.reports / "figures/figure_5_4.png")],
    )


def layer_changes(results):
    """Rows of data/transfer/weight_change.csv with what each trial was: data, network, weights, mode, split."""
    frame = results.table("transfer", "weight_change.csv")
    names = ["data", "network", "weights", "mode", "split", "repetition"]
    if frame.empty:
        raise NotRun("no network was fine-tuned", "transfer")
    parts = pd.DataFrame(frame["trial"].str.split(".").tolist(), columns=names, index=frame.index)
    return frame.join(parts)


def _means(changes):
    tuned = changes[(changes["mode"] == "finetuned") & (changes["data"] == FINE)]
    for (network, weights), one in tuned.groupby(["network", "weights"], sort=False):
        origin = "ImageNet" if weights == "imagenet" else "random weights"
        yield f"{label(network)} from {origin} {one['value'].mean():.2g}"


def _blocks(axes, parts):
    """Names the blocks below the axis, and marks the ends of the shared middle."""
    starts = [k for k, part in enumerate(parts) if k == 0 or part != parts[k - 1]]
    names = [SHORT.get(parts[k], parts[k].replace("block_", "b")) for k in starts]
    axes.set_xticks(starts, names, fontsize=7.5)
    if set(SHARED) <= set(parts):
        first, last = parts.index(SHARED[0]), len(parts) - 1 - parts[::-1].index(SHARED[1])
        for x in (first - 0.5, last + 0.5):
            axes.axvline(x, color=INK, lw=0.9, ls="--")
    axes.tick_params(axis="x", colors=GREY)

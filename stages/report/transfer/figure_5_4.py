"""T figure 5.4: how far training on touch moves the weights, layer by layer of MobileNetV2."""

from matplotlib.axes import Axes

from stages.report.items import Figure
from stages.report.networks import COARSE, FINE, NETWORK
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, label, plt, start

LINES = {
    (FINE, "imagenet"): ("128 x 128, from ImageNet", "#0072B2"),
    (COARSE, "imagenet"): ("16 x 16, from ImageNet", "#D55E00"),
    (FINE, "random"): ("128 x 128, from random weights", "#767676"),
}
SHORT = {"Conv1": "c1", "expanded_conv": "b0", "Conv_1": "c2"}  # of the first and the last parts
SHARED = ("block_2", "block_15")  # the middle that the hybrid network shares


def build(results: Results) -> Figure:
    """Change of each convolution of MobileNetV2, by the array and the weights that it started from."""
    tuned = results.measured("transfer", metric="layer_weight_change", split="random", mode="finetuned")
    mine = tuned[tuned["method"] == NETWORK]
    if mine.empty:
        raise NotRun("MobileNetV2 was not fine-tuned", "transfer")
    layers = mine.groupby("layer", sort=False)["part"].first()
    figure, axes = plt.subplots(figsize=(9.2, 3.8))
    for (data, weights), (words, tint) in LINES.items():
        one = mine[(mine["data"] == data) & (mine["weights"] == weights)]
        if len(one):
            spread = one.groupby("layer")["value"].agg(["mean", "min", "max"]).loc[layers.index]
            axes.fill_between(range(len(layers)), spread["min"], spread["max"], color=tint, alpha=0.18, lw=0)
            axes.plot(spread["mean"].to_numpy(), color=tint, marker="o", ms=3, lw=1.2, label=words)
    _blocks(axes, list(layers))
    axes.set_yscale("log")
    axes.set_ylabel("mean squared change of weights,\neach layer's scaled to 0..1")
    axes.set_xlabel("convolutions of MobileNetV2, from the image to the classes")
    axes.grid(axis="y")
    axes.legend(fontsize=8.5, loc="lower left", bbox_to_anchor=(0, 1), ncols=3)
    kinds = tuned[tuned["data"] == FINE].groupby(["method", "weights"], sort=False)["value"]
    said = [f"{label(network)} from {start(str(weights))} {one.mean():.2g}" for (network, weights), one in kinds]
    return Figure(figure, {"means": "; ".join(said)})


def _blocks(axes: Axes, parts: list[str]) -> None:
    """Names the blocks below the axis, and marks the ends of the shared middle."""
    starts = [k for k, part in enumerate(parts) if k == 0 or part != parts[k - 1]]
    names = [SHORT.get(parts[k], parts[k].replace("block_", "b")) for k in starts]
    axes.set_xticks(starts, names, fontsize=7.5)
    if set(SHARED) <= set(parts):
        first, last = parts.index(SHARED[0]), len(parts) - 1 - parts[::-1].index(SHARED[1])
        for x in (first - 0.5, last + 0.5):
            axes.axvline(x, color=INK, lw=0.9, ls="--")
    axes.tick_params(axis="x", colors=GREY)

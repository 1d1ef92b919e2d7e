"""Gains by fine-tuning (T figure 5.3), changed weights (T figure 5.4), the costs and the course of training."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.base.timing import CLOCK
from haptic_glance.know.split import shared_by
from stages.charts.datasets import dataset_text
from stages.charts.drawing import CYCLE, GREY, INK, MARKERS, PALE, label, plt, start
from stages.charts.items import Figure
from stages.charts.pareto import pareto_chart
from stages.charts.results import Results, require_rows
from stages.charts.tables import grouped, means
from stages.engine.statistics import interval
from stages.transfer.network_rows import (
    COARSE,
    FINE,
    MODES,
    NETWORK,
    PASSES,
    PRINTED,
    SPLITS,
    THEIRS,
    THESIS,
    everywhere,
    of_passes,
    shared,
)

GAIN_TINTS = {("random", FINE): "#0072B2", ("objects", FINE): "#56B4E9", ("random", COARSE): "#D55E00",
         ("objects", COARSE): "#E69F00"}  # fmt: skip
CELLS = {FINE: "128 x 128", COARSE: "16 x 16"}
MARKS = {"printed": "o", "converged": "s", "printed_rate": "^"}


def figure_5_3(results: Results) -> Figure:
    """Accuracy of fine-tuned minus frozen networks, a panel for each set."""
    by_set = {source: frame for source, rows in everywhere(results, *PASSES).items() if len(frame := gains(rows))}
    require_rows(by_set, "no network was both fine-tuned and frozen", "transfer")
    networks = list(pd.concat(by_set)["network"].unique())
    size = (4.6 * len(by_set) + 2.2, len(networks) + 1.9)
    figure, [panels] = plt.subplots(1, len(by_set), figsize=size, squeeze=False, sharey=True)
    for axes, (source, frame) in zip(panels, by_set.items(), strict=True):
        _draw_gains(axes, frame, networks, results)
        axes.set_title(dataset_text(source))
    panels[0].set_yticks(range(len(networks)), map(label, networks))
    panels[0].set_ylim(len(networks) - 0.4, -0.6)
    for (split, data), tint in GAIN_TINTS.items():
        panels[-1].plot([], [], "o", color=tint, ms=5, label=f"{CELLS[data]}, {SPLITS[split]}")
    for passes, mark in MARKS.items():
        panels[-1].plot([], [], mark, color=GREY, ms=5, label=f"passes: {PASSES[passes]}")
    panels[-1].plot([], [], "D", color="white", mec=GREY, ms=5, mew=1.2, label="the thesis's figure")
    panels[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    figure.tight_layout()
    return Figure(figure)


def gains(rows: pd.DataFrame) -> pd.DataFrame:
    """Points that fine-tuning adds, with mean, low and high, by network, split, data and passes with pairs of both."""
    lines = []
    pretrained = rows[(rows["weights"] == "imagenet") & rows["data"].isin(CELLS)]
    for (network, split, data, passes), group in grouped(pretrained, ["method", "split", "data", "passes"]):
        sides = group.pivot_table(index="repetition", columns="mode", values="value").reindex(columns=MODES).dropna()
        if len(sides):
            ends = interval(100 * (sides["finetuned"] - sides["frozen"]), shared(split, group["dataset"].iloc[0]))
            lines.append((network, split, data, passes, *ends))
    return pd.DataFrame(lines, columns=["network", "split", "data", "passes", "mean", "low", "high"])


def _draw_gains(axes: Axes, frame: pd.DataFrame, networks: list[str], results: Results) -> None:
    for network, split, data, passes, mean, low, high in frame.itertuples(index=False):
        tint = GAIN_TINTS[split, data]
        place = networks.index(network) + 0.17 * (list(GAIN_TINTS).index((split, data)) - 1.5)
        place += 0.05 * list(MARKS).index(passes)
        axes.plot([low, high], [place] * 2, color=tint, lw=1.6, alpha=0.5)
        axes.plot(mean, place, MARKS[passes], color=tint, ms=5, mec="white", mew=0.5)
        if passes == "printed" and split == "random" and network in PRINTED:
            row = results.thesis(THESIS[data]).set_index("network").loc[PRINTED[network]]
            gap = 100 * (row["acc_finetuned"] - row["acc_frozen"])
            axes.plot(gap, place, "D", color="white", mec=tint, ms=5, mew=1.2)
    axes.axvline(0, color=INK, lw=0.8)
    axes.hlines(np.arange(len(networks) - 1) + 0.5, 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.5)
    axes.set_xlabel("fine-tuned minus frozen, points of accuracy")
    axes.grid(axis="x")
    axes.tick_params(axis="y", length=0)


TINTS = {(FINE, "imagenet"): "#0072B2", (COARSE, "imagenet"): "#D55E00", (FINE, "random"): "#767676"}
SHORT = {"Conv1": "c1", "expanded_conv": "b0", "Conv_1": "c2"}  # of the first and the last parts
WHERE = {"split": "random", "mode": "finetuned"}
SHARED = ("block_2", "block_15")  # the ends of the middle that the hybrid network shares


def figure_5_4(results: Results) -> Figure:
    """As printed, the mean change of each network on each data set; below, that of each layer of MobileNetV2."""
    by_set = everywhere(results, metric="weight_change", **WHERE)
    printed = pd.DataFrame([
        {"on": f"{dataset_text(dataset)}, {CELLS[data]}, from {start(weights)}", "network": network,
         "mean": runs["value"].mean(), "low": runs["value"].min(), "high": runs["value"].max(), "trainings": len(runs)}
        for dataset, rows in by_set.items()
        for (network, data, weights), runs in grouped(rows, ["method", "data", "weights"])
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
    return Figure(figure, frame=printed)


def _draw_networks(axes: Axes, frame: pd.DataFrame) -> None:
    """A group of dots a network, a colour a data set; lines from the least to the greatest of the trainings."""
    networks, sets = list(dict.fromkeys(frame["network"])), list(dict.fromkeys(frame["on"]))
    for k, (name, tint) in enumerate(zip(sets, CYCLE, strict=False)):
        dots = frame[frame["on"] == name]
        x = dots["network"].map(networks.index) + 0.12 * (k - (len(sets) - 1) / 2)
        axes.vlines(x, dots["low"], dots["high"], color=tint, lw=1.2, alpha=0.6)
        axes.plot(x, dots["mean"], MARKERS[k], color=tint, ms=6, mec="white", label=name)
    axes.set_xticks(range(len(networks)), [label(name) for name in networks])


def _draw_layers(axes: Axes, results: Results) -> None:
    """Change of each convolution of MobileNetV2, by the array and the weights that it started from."""
    changes = of_passes(results.measured("transfer", metric="layer_weight_change", method=NETWORK, **WHERE))
    parts = changes.groupby("layer", sort=False)["part"].first()
    for (data, weights), tint in TINTS.items():
        group = changes[(changes["data"] == data) & (changes["weights"] == weights)]
        if len(group):
            spread = group.groupby("layer")["value"].agg(["mean", "min", "max"]).loc[parts.index]
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
        f"convolutions of MobileNetV2 on {dataset_text(changes['dataset'].iloc[0])}, from the image to the classes"
    )


REFERENCE = "MobileNetV2, ImageNet, frozen"


def networks_chart(results: Results) -> Figure:
    """Accuracy of each network, start, mode and number of passes against the time of one imprint, on touches at random.

    The time is that of the size next to what the networks saw, among those of `benchmarks.networks`.
    """
    dataset = results.printed(THEIRS, "transfer")
    where = {"metric": "accuracy", "data": FINE, "split": "random"}
    rows = of_passes(results.measured("transfer", dataset, **where), *PASSES)
    times = results.bench("networks").rename(columns={"network": "method", "size": "timed"})
    rows["timed"] = [times["timed"].iloc[(times["timed"] - size).abs().argmin()] for size in rows["size"]]
    rows = rows.merge(times, on=["method", "timed"])
    rows["seconds"] = rows["milliseconds"] / 1000
    frame = pd.DataFrame(means(rows, ["method", "weights", "mode", "passes"], shared_by("random"), top=1.0))
    frame["network"] = frame["method"].map(label) + frame["weights"].map(_beside)
    frame["way"] = frame["mode"].map(label).str.replace(r"^\d+:\d+$", "part of the layers frozen", regex=True)
    mode = frame["mode"].map(label).str.replace(r"^(\d+):(\d+)$", r"layers \1 to \2 frozen", regex=True)
    frame["name"] = frame["method"].map(label) + ", " + frame["weights"].map(start) + ", " + mode
    frame["name"] += frame["passes"].map(
        {"printed": ""} | {name: f", {PASSES[name]}" for name in ("converged", "printed_rate")}
    )
    chart = pareto_chart(
        frame, "mean", title="From sight to touch: what an imprint costs", reference=REFERENCE,
        quality_label="test accuracy, touches at random", colour="network", marker="way",
        legends={"way": "trained"}, clock=CLOCK,
    )  # fmt: skip
    chart.words |= {
        "on": dataset_text(str(rows["dataset"].iloc[0])),
        "size": " and ".join(f"{size:.0f}" for size in sorted(rows["size"].unique())),
        "timed": " and ".join(f"{size:.0f}" for size in sorted(rows["timed"].unique())),
        "splits": frame["values"].max(),
    }
    return chart


def _beside(weights: str) -> str:
    return "" if weights == "imagenet" else f", {start(weights)}"

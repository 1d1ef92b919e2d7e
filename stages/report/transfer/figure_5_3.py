"""T figure 5.3: what fine-tuning adds to frozen filters, network by network."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.engine.statistics import interval
from stages.report.drawing import GREY, INK, PALE, label, plt
from stages.report.items import Figure
from stages.report.networks import COARSE, FINE, MODES, PASSES, PRINTED, SPLITS, THESIS, everywhere, shared
from stages.report.results import Results, dataset_text, some
from stages.report.tables import grouped

TINTS = {("random", FINE): "#0072B2", ("objects", FINE): "#56B4E9", ("random", COARSE): "#D55E00",
         ("objects", COARSE): "#E69F00"}  # fmt: skip
CELLS = {FINE: "128 x 128", COARSE: "16 x 16"}
MARKS = {"printed": "o", "converged": "s", "printed_rate": "^"}


def build(results: Results) -> Figure:
    """Accuracy of fine-tuned minus frozen networks, a panel for each set."""
    by_set = {source: frame for source, rows in everywhere(results, *PASSES).items() if len(frame := gains(rows))}
    some(by_set, "no network was both fine-tuned and frozen", "transfer")
    networks = list(pd.concat(by_set)["network"].unique())
    size = (4.6 * len(by_set) + 2.2, len(networks) + 1.9)
    figure, [panels] = plt.subplots(1, len(by_set), figsize=size, squeeze=False, sharey=True)
    for axes, (source, frame) in zip(panels, by_set.items(), strict=True):
        _draw(axes, frame, networks, results)
        axes.set_title(dataset_text(source))
    panels[0].set_yticks(range(len(networks)), map(label, networks))
    panels[0].set_ylim(len(networks) - 0.4, -0.6)
    for (split, data), tint in TINTS.items():
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


def _draw(axes: Axes, frame: pd.DataFrame, networks: list[str], results: Results) -> None:
    for network, split, data, passes, mean, low, high in frame.itertuples(index=False):
        tint = TINTS[split, data]
        place = networks.index(network) + 0.17 * (list(TINTS).index((split, data)) - 1.5)
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

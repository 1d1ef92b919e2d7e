"""The hybrid network and its smaller kinds: accuracy against the size of the file."""

import pandas as pd
from matplotlib.axes import Axes

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import INK, plt

from .section_5_5 import ITEMS, METHODS
from .section_5_5 import build as table

SHOWN = {"vision": ("by sight", "#0072B2"), "touch": ("by touch", "#D55E00")}
HOLLOW = " Hollow: layers {others} shared instead of {first}, as far from the hybrid as on the same items."


def build(results: Results) -> Figure:
    """Accuracy by each sense against megabytes, a panel for each split."""
    frame = table(results).frame
    frame = frame[frame["objects"] == frame["objects"].iloc[0]]  # not those of another data set in one picture
    first = frame["shared_layers"].iloc[0]
    frame = frame[(frame["shared_layers"] == first) | (frame["network"] == "hybrid")]
    splits = list(dict.fromkeys(frame["split"]))
    figure, panels = plt.subplots(1, len(splits), figsize=(4.6 * len(splits), 3.8), squeeze=False, sharey=True)
    for axes, split in zip(panels[0], splits, strict=True):
        mine = frame[frame["split"] == split]
        _draw(axes, mine[mine["shared_layers"] == first].sort_values("megabytes"))
        _draw_others(axes, mine[mine["network"] == "hybrid"])
        axes.set_xticks(mine["megabytes"], [f"{value:.1f}" for value in mine["megabytes"]], fontsize=8)
        axes.minorticks_off()
        axes.set_title(ITEMS[split])
    panels[0, 0].set_ylabel("accuracy, %")
    panels[0, -1].legend(fontsize=8.5, loc="upper right")
    figure.tight_layout()
    others = ", ".join(layers for layers in dict.fromkeys(frame["shared_layers"]) if layers != first)
    words = {
        "smallest": METHODS[frame.loc[frame["megabytes"].idxmin(), "network"]],
        "megabytes": frame["megabytes"].min(),
        "ratio": frame["size_ratio"].max(),
        "hollow": HOLLOW.format(others=others, first=first) if others else "",
    }
    return Figure(figure, words, frame)


def _draw(axes: Axes, frame: pd.DataFrame) -> None:
    """Networks that share the first layers, from the smallest on."""
    for sense, (words, tint) in SHOWN.items():
        axes.plot(frame["megabytes"], 100 * frame[sense], "o-", color=tint, ms=6, lw=1, mec="white", label=words)
        ends = 100 * frame[[f"{sense}_low", f"{sense}_high"]].to_numpy().T
        axes.plot(frame[["megabytes"] * 2].to_numpy().T, ends, color=tint, lw=1.2, alpha=0.5)
    axes.set_xscale("log")
    for size, network in zip(frame["megabytes"], frame["network"], strict=True):
        _name(axes, size, METHODS[network].replace("hybrid, weights of ", ""))
    axes.set_ylim(0, 102)
    axes.set_xlabel("size of the file, MB")
    axes.grid(axis="y")


def _draw_others(axes: Axes, frame: pd.DataFrame) -> None:
    """Hybrids that share other layers than the first, by their gain over it on the items that both were tested on."""
    for _, row in frame[1:].iterrows():
        for sense, (_, tint) in SHOWN.items():
            place = 100 * frame[sense].iloc[0] + row[f"{sense}_gain"]
            axes.plot(row["megabytes"], place, "o", mfc="white", mec=tint, ms=6)
        _name(axes, row["megabytes"], row["shared_layers"])


def _name(axes: Axes, size: float, name: str) -> None:
    axes.annotate(name, (size, 2), rotation=90, fontsize=8, color=INK, ha="center", va="bottom")

"""Accuracy against the number of touches, and against the stated belief."""

from itertools import product

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.kit.split import Split, shared_by
from stages.report.grid import grouped, within
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import GREY, colours, label, plt

from .exploration import GROUP, HEADLINE, HELD_OUT, LIKELIHOODS, STAGE, WAYS

METHODS = ("thesis_ssim", "enhanced", "random")
PANELS = ((Split.RANDOM, "imprint"), (Split.RANDOM, "imprint_place"), (Split.REGIONS, "imprint"))
TINTS = {"gain": "#0072B2", "saliency": "#009E73", "random": "#E69F00"}
TICKS = (1, 2, 3, 5, 8, 12)
LINES = {"imprint": ("-", "o"), "imprint_product": (":", "^")}


def exploration(results: Results) -> Figure:
    """Accuracy against the mean number of touches, by split, belief and who chose the points."""
    rows = results.measured(STAGE, group=GROUP, metric="accuracy")
    methods = [method for method in METHODS if method in set(rows["method"])] or list(dict.fromkeys(rows["method"]))
    frame = _points(rows, ["split", "likelihood", "method", "way", "stop", "level"])
    figure, grid = plt.subplots(
        len(PANELS), len(methods), figsize=(3.15 * len(methods) + 0.6, 2.5 * len(PANELS) + 0.8), squeeze=False,
        sharex=True, sharey=True,
    )  # fmt: skip
    for row, (split, likelihood) in zip(grid, PANELS, strict=True):
        panel = frame[(frame["split"] == split) & (frame["likelihood"] == likelihood)]
        for axes, method in zip(row, methods, strict=True):
            _draw_touches(axes, panel[panel["method"] == method])
        row[0].set_ylabel(f"accuracy\n{LIKELIHOODS[likelihood]}, {HELD_OUT[split]}")
    for above, below, method in zip(grid[0], grid[-1], methods, strict=True):
        above.set_title(label(method), fontsize=10)
        below.set_xlabel("mean number of touches")
    handles, names = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="lower center", ncol=3, bbox_to_anchor=(0.5, -0.06), fontsize=9)
    figure.tight_layout()
    levels = sorted(frame.loc[frame["stop"] == "confidence", "level"].unique())
    words = {"group": results.group_text(GROUP), "levels": ", ".join(f"{100 * level:.0f} %" for level in levels)}
    return Figure(figure, words, frame)


def _points(rows: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """Accuracy with its interval, mean touches and stated belief, one row for each combination of columns `by`."""
    found = []
    for key, group in grouped(rows, by):
        accuracy = within(group["value"], shared_by(group["split"].iloc[0]))
        found.append((*key, group["touches"].mean(), group["belief"].mean(), *accuracy))
    return pd.DataFrame(found, columns=[*by, "touches", "stated", "accuracy", "low", "high"])


def _draw_touches(axes: Axes, panel: pd.DataFrame) -> None:
    for way, words in WAYS.items():
        own, tint = panel[panel["way"] == way].sort_values("level"), TINTS[way]
        sure, fixed = own[own["stop"] == "confidence"], own[own["stop"] == "fixed"]
        told = sure[np.isclose(sure["level"], HEADLINE)]
        axes.plot([told["touches"]] * 2, [told["low"], told["high"]], color=tint, lw=1, alpha=0.55)
        dots, dashes = {"marker": "o", "ms": 4, "lw": 1.5, "zorder": 3}, {"ls": "--", "lw": 1.0}
        axes.plot(sure["touches"], sure["accuracy"], color=tint, label=f"{words}, stops when sure", **dots)
        axes.plot(fixed["touches"], fixed["accuracy"], color=tint, label=f"{words}, a fixed number", **dashes)
    axes.grid()
    axes.set(xscale="log", ylim=(0.3, 1.02))
    axes.set_xticks(TICKS, map(str, TICKS))
    axes.minorticks_off()


def calibration(results: Results) -> Figure:
    """Accuracy against stated belief, for a fixed number of touches in random order."""
    rows = results.measured(STAGE, group=GROUP, way="random", stop="fixed", metric="accuracy")
    frame = _points(rows, ["split", "likelihood", "method", "level"]).sort_values("level")
    tints = colours(list(dict.fromkeys(rows["method"])))
    figure, panels = plt.subplots(1, len(HELD_OUT), figsize=(8.4, 4.0), sharex=True, sharey=True)
    for axes, split in zip(panels, HELD_OUT, strict=True):
        axes.plot([0, 1], [0, 1], color=GREY, lw=0.8)
        for (likelihood, (dash, mark)), (method, tint) in product(LINES.items(), tints.items()):
            line = frame[(frame[["split", "likelihood", "method"]] == (split, likelihood, method)).all(axis=1)]
            name = f"{label(method)},\n{LIKELIHOODS[likelihood]}"
            axes.plot(line["stated"], line["accuracy"], dash, marker=mark, ms=3.5, lw=1.3, color=tint, label=name)
            axes.vlines(line["stated"], line["low"], line["high"], color=tint, lw=0.8, alpha=0.35)
        axes.set(xlabel="stated belief in the likeliest object", xlim=(0.3, 1.0), ylim=(0.3, 1.0), aspect="equal")
        axes.set_title(split.words)
        axes.grid()
    panels[0].set_ylabel("rate of right answers")
    panels[-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9)
    figure.tight_layout()
    return Figure(figure, {"most": int(rows["level"].max()), "group": results.group_text(GROUP)})

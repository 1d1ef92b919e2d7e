"""Accuracy against the number of touches: stopping when sure, beside a fixed number."""

import numpy as np

from stages.kit.split import Split
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import label, plt

from .rows import GROUP, HEADLINE, HELD_OUT, LIKELIHOODS, STAGE, TINTS, WAYS, points

METHODS = ("thesis_ssim", "enhanced", "random")
PANELS = ((Split.RANDOM, "imprint"), (Split.RANDOM, "imprint_place"), (Split.REGIONS, "imprint"))
TICKS = (1, 2, 3, 5, 8, 12)
KEYS = ["split", "likelihood", "method", "way", "stop", "level"]


def build(results: Results) -> Figure:
    """Accuracy against the mean number of touches, by split, belief and who chose the points."""
    rows = results.measured(STAGE, group=GROUP, metric="accuracy")
    methods = [method for method in METHODS if method in set(rows["method"])] or list(dict.fromkeys(rows["method"]))
    frame = points(rows, KEYS)
    figure, grid = plt.subplots(
        len(PANELS), len(methods), figsize=(3.15 * len(methods) + 0.6, 2.5 * len(PANELS) + 0.8), squeeze=False,
        sharex=True, sharey=True,
    )  # fmt: skip
    for down, (split, likelihood) in enumerate(PANELS):
        for across, method in enumerate(methods):
            axes = grid[down, across]
            _draw(axes, frame[(frame["split"] == split) & (frame["likelihood"] == likelihood)], method)
            if down == 0:
                axes.set_title(label(method), fontsize=10)
        grid[down, 0].set_ylabel(f"accuracy\n{LIKELIHOODS[likelihood]}, {HELD_OUT[split]}")
    for axes in grid[-1]:
        axes.set_xlabel("mean number of touches")
    handles, names = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="lower center", ncol=3, bbox_to_anchor=(0.5, -0.06), fontsize=9)
    figure.tight_layout()
    levels = sorted(frame.loc[frame["stop"] == "confidence", "level"].unique())
    words = {"group": results.group_text(GROUP), "levels": ", ".join(f"{100 * level:.0f} %" for level in levels)}
    return Figure(figure, words, frame)


def _draw(axes, panel, method):
    panel = panel[panel["method"] == method]
    for way, words in WAYS.items():
        for stop, dash, mark in (("confidence", "-", "o"), ("fixed", "--", None)):
            line = panel[(panel["way"] == way) & (panel["stop"] == stop)].sort_values("level")
            how = "stops when sure" if stop == "confidence" else "a fixed number"
            axes.plot(
                line["touches"], line["accuracy"], dash, marker=mark, ms=4, lw=1.5 if mark else 1.0, color=TINTS[way],
                label=f"{words}, {how}", zorder=3 if mark else 2,
            )  # fmt: skip
            for row in line[np.isclose(line["level"], HEADLINE)].itertuples() if mark else ():
                axes.plot([row.touches] * 2, [row.low, row.high], color=TINTS[way], lw=1, alpha=0.55)
    axes.grid()
    axes.set_xscale("log")
    axes.set_xticks(TICKS, [str(tick) for tick in TICKS])
    axes.minorticks_off()
    axes.set_ylim(0.3, 1.02)

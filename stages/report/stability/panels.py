"""The frame of the charts of accuracy against severity: one panel per perturbation, and one for the legend."""

import numpy as np

from stages.report.style import label, plt

COLUMNS = 4


def panels(names, words, width, height):
    """(figure, {name: axes}, axes of the legend): words say what all panels measure."""
    down = -(-(len(names) + 1) // COLUMNS)
    figure, grid = plt.subplots(down, COLUMNS, figsize=(width, height * down), squeeze=False, sharey=True)
    for axes in grid[:, 0]:
        axes.set_ylabel(words)
    for axes in grid.flat[len(names) :]:
        axes.set_axis_off()
    return figure, dict(zip(names, grid.flat, strict=False)), grid.flat[len(names)]


def finish(axes, name, unit, severities):
    """Axes of a panel: no change on the left, then the severities at equal distances."""
    axes.set_xticks(range(len(severities) + 1), ["none", *(f"{one:g}" for one in severities)], fontsize=8)
    axes.set_ylim(0, 100)
    axes.set_xlabel(unit, fontsize=8)
    axes.set_title(label(name), fontsize=10)
    axes.grid(axis="y")


def bars(axes, ends, tint):
    """Intervals (low, high) as upright lines, cut to 0..100 %."""
    for place, (low, high) in ends:
        axes.plot([place, place], 100 * np.clip([low, high], 0, 1), color=tint, lw=0.9, alpha=0.4)

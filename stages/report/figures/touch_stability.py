"""Accuracy of recognition by touch against severity: a panel a perturbation, a line a classifier."""

import numpy as np

from stages.report.items import Figure
from stages.report.style import GREY, MARKERS, label, plt, save
from stages.report.tables._touch_stability import LINES, breaking, curve
from stages.touch_stability import NONE, PERTURBATIONS

COLUMNS = 4
TINTS = ("#0072B2", "#56B4E9", "#D55E00", "#009E73")


def build(results):
    rows = results.measured("touch_stability", metric="accuracy")
    found = [one for one in PERTURBATIONS if one in set(rows["perturbation"])]
    down = -(-(len(found) + 1) // COLUMNS)  # one panel more, for the legend
    figure, grid = plt.subplots(down, COLUMNS, figsize=(10.2, 2.3 * down), squeeze=False, sharey=True)
    for axes, perturbation in zip(grid.flat, found, strict=False):
        _draw(axes, rows, perturbation)
    for axes in grid[:, 0]:
        axes.set_ylabel("accuracy, %")
    for axes in grid.flat[len(found) :]:
        axes.set_axis_off()
    legend = grid.flat[len(found)]
    for words, tint, mark in zip(LINES.values(), TINTS, MARKERS, strict=False):
        legend.plot([], [], color=tint, marker=mark, ms=4, lw=1.4, label=words)
    legend.plot([], [], "x", color=GREY, ms=7, label="half of the lead lost")
    legend.plot([], [], ":", color=GREY, lw=1.2, label="guessing")
    legend.legend(loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    return Figure(
        "How recognition by touch degrades",
        f"Line charts of accuracy against the severity of {len(found)} perturbations, for {', '.join(LINES.values())}.",
        f"{results.set_text(rows['object'].iloc[0])}, touched at points of {label(rows['method'].iloc[0])}. Each panel "
        "goes from no change (left) to the harshest; its steps stand at equal distances. Bars: 95 % intervals over "
        "repeated splits. Crosses: half of the lead over guessing (dotted) is lost. Unseen regions: known touches are "
        "a sensor's width from those asked about; with places: positions are features too.",
        [save(figure, results.reports / "figures/touch_stability.png")],
    )


def _draw(axes, rows, perturbation):
    known, ticks = PERTURBATIONS[perturbation], []
    for line, tint, mark in zip(LINES, TINTS, MARKERS, strict=False):
        points = curve(rows, perturbation, line)
        if points is None:
            continue
        ticks = list(points["severity"]) if len(points) > len(ticks) else ticks
        places = np.arange(len(points) + 1)
        clean = _clean(rows, line)
        values = 100 * np.array([clean, *points["accuracy"]])
        axes.plot(places, values, color=tint, marker=mark, ms=3.5, lw=1.4)
        for place, low, high in zip(places[1:], points["accuracy_low"], points["accuracy_high"], strict=True):
            axes.plot([place, place], [100 * max(low, 0), 100 * min(high, 1)], color=tint, lw=0.9, alpha=0.4)
        at = breaking(points, perturbation)[0]
        if np.isfinite(at):
            steps = [known.unharmed, *points["severity"]]
            rising = steps if steps[-1] > steps[0] else [-step for step in steps]
            where = np.interp(at if rising is steps else -at, rising, places)
            axes.plot(where, np.interp(where, places, values), "x", color=tint, ms=7, mew=1.8, zorder=4)
    axes.axhline(100 * rows["chance"].iloc[0], color=GREY, lw=1.2, ls=":")
    axes.set_xticks(range(len(ticks) + 1), ["none", *(f"{tick:g}" for tick in ticks)], fontsize=8)
    axes.set_ylim(0, 100)
    axes.set_xlabel(known.unit, fontsize=8)
    axes.set_title(label(perturbation), fontsize=10)
    axes.grid(axis="y")


def _clean(rows, line):
    split, features, classifier = line
    mine = rows[(rows["split"] == split) & (rows["features"] == features) & (rows["classifier"] == classifier)]
    return mine.loc[mine["perturbation"] == NONE, "value"].mean()

"""Accuracy of recognition by touch against severity: a panel a perturbation, a line a classifier."""

import numpy as np

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import GREY, MARKERS, label, save
from stages.touch_stability import CLEAN, PERTURBATIONS

from .panels import bars, finish, panels
from .rows import LINES, breaking, curve, of_line

TINTS = ("#0072B2", "#56B4E9", "#D55E00", "#009E73")


def build(results: Results) -> Figure:
    rows = results.measured("touch_stability", metric="accuracy")
    found = [one for one in PERTURBATIONS if one in set(rows["perturbation"])]
    figure, grid, legend = panels(found, "accuracy, %", 10.2, 2.3)
    for perturbation, axes in grid.items():
        _draw(axes, rows, perturbation)
    for words, tint, mark in zip(LINES.values(), TINTS, MARKERS, strict=False):
        legend.plot([], [], color=tint, marker=mark, ms=4, lw=1.4, label=words)
    legend.plot([], [], "x", color=GREY, ms=7, label="half of the lead lost")
    legend.plot([], [], ":", color=GREY, lw=1.2, label="guessing")
    legend.legend(loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    return Figure(
        "How recognition by touch degrades",
        f"Line charts of accuracy against the severity of {len(found)} perturbations, for {', '.join(LINES.values())}.",
        f"{results.group_text(rows['group'].iloc[0])}, touched at points of {label(rows['method'].iloc[0])}. Each "
        "panel goes from no change (left) to the harshest; its steps stand at equal distances. Bars: 95 % intervals "
        "over repeated splits. Crosses: half of the lead over guessing (dotted) is lost. Unseen regions: known touches "
        "are a sensor's width from those asked about; with places: positions are features too.",
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
        clean = of_line(rows[rows["perturbation"] == CLEAN], line)["value"].mean()
        values = 100 * np.array([clean, *points["accuracy"]])
        axes.plot(places, values, color=tint, marker=mark, ms=3.5, lw=1.4)
        bars(axes, zip(places[1:], points[["accuracy_low", "accuracy_high"]].to_numpy(), strict=True), tint)
        at = breaking(points, perturbation)[0]
        if np.isfinite(at):
            steps = [known.unharmed, *points["severity"]]
            rising = steps if steps[-1] > steps[0] else [-step for step in steps]
            where = np.interp(at if rising is steps else -at, rising, places)
            axes.plot(where, np.interp(where, places, values), "x", color=tint, ms=7, mew=1.8, zorder=4)
    axes.axhline(100 * rows["chance"].iloc[0], color=GREY, lw=1.2, ls=":")
    finish(axes, perturbation, known.unit, ticks)

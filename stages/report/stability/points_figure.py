"""Repeatability against severity: a panel a perturbation, a line a method."""

import numpy as np

from stages.kit.breaking_point import BROKEN
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import GREY, INK, MARKERS, colours, label, save
from stages.stability import PERTURBATIONS
from stages.stability.summary import mean_repeatability

from .panels import finish, panels

CHANCE = "random"


def build(results: Results) -> Figure:
    rows = results.measured("stability", metric=["repeatability", "chance"])
    means = mean_repeatability(rows[rows["method"] != CHANCE].to_dict("records"))
    chance = rows[rows["metric"] == "chance"].groupby(["perturbation", "severity"])["value"].mean()
    methods, perturbations = (list(dict.fromkeys(means[key])) for key in ("method", "perturbation"))
    figure, grid, legend = panels(perturbations, "points found again, %", 9.6, 2.25)
    for perturbation, axes in grid.items():
        panel = means[means["perturbation"] == perturbation]
        _draw(axes, perturbation, panel, chance[perturbation], methods)
    legend.legend(*grid[perturbations[0]].get_legend_handles_labels(), loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    path = save(figure, results.reports / "figures/stability.png")
    objects = ", ".join(dict.fromkeys(rows["item"]))
    return Figure(
        "What is found again, and where each method breaks",
        f"Line charts of the share of points found again against the severity of {len(perturbations)} perturbations, "
        f"for {', '.join(map(label, methods))}.",
        f"Mean over {objects}; within 2 % of the diagonal. Each panel goes from no change (left) to the harshest; its "
        "steps stand at equal distances. A method breaks where its line falls below one half (thin line). Dotted: as "
        "many random points.",
        [path],
    )


def _draw(axes, perturbation, panel, chance, methods):
    severities = list(dict.fromkeys(panel["severity"]))
    places, paint = np.arange(len(severities) + 1), colours(methods)
    for k, method in enumerate(methods):
        values = panel[panel["method"] == method].set_index("severity")["value"].reindex(severities)
        axes.plot(
            places, [100, *(100 * values)], color=paint[method], marker=MARKERS[k % len(MARKERS)], ms=4, lw=1.4,
            label=label(method), clip_on=False,
        )  # fmt: skip
    axes.plot(places[1:], 100 * chance.reindex(severities), ":", color=INK, marker=".", ms=3, lw=1.2, label="chance")
    axes.axhline(100 * BROKEN, color=GREY, lw=0.6)
    axes.set_xlim(-0.15, len(severities) + 0.15)
    finish(axes, perturbation, PERTURBATIONS[perturbation].unit, severities)

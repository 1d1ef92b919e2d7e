"""Repeatability against severity: a panel a perturbation, a line a method."""

import numpy as np

from stages.report.items import Figure
from stages.report.style import GREY, INK, MARKERS, colours, label, plt, save
from stages.stability import PERTURBATIONS
from stages.stability.measures import BROKEN
from stages.stability.summary import mean_repeatability

CHANCE = "random"
COLUMNS = 4


def build(results):
    rows = results.measured("stability", metric=["repeatability", "chance"])
    means = mean_repeatability(rows[rows["method"] != CHANCE].to_dict("records"))
    chance = rows[rows["metric"] == "chance"].groupby(["perturbation", "severity"])["value"].mean()
    methods, perturbations = (list(dict.fromkeys(means[key])) for key in ("method", "perturbation"))
    down = -(-(len(perturbations) + 1) // COLUMNS)  # one panel more, for the legend
    figure, grid = plt.subplots(down, COLUMNS, figsize=(9.6, 2.25 * down), squeeze=False, sharey=True)
    for axes, perturbation in zip(grid.flat, perturbations, strict=False):
        panel = means[means["perturbation"] == perturbation]
        _draw(axes, perturbation, panel, chance[perturbation], methods)
    for axes in grid[:, 0]:
        axes.set_ylabel("points found again, %")
    for axes in grid.flat[len(perturbations) :]:
        axes.set_axis_off()
    handles, names = grid[0, 0].get_legend_handles_labels()
    grid.flat[len(perturbations)].legend(handles, names, loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    path = save(figure, results.reports / "figures/stability.png")
    objects = ", ".join(dict.fromkeys(rows["object"]))
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
    known = PERTURBATIONS[perturbation]
    axes.set_xticks(places, ["none", *(f"{severity:g}" for severity in severities)], fontsize=8)
    axes.set_xlim(-0.15, len(severities) + 0.15)
    axes.set_ylim(0, 100)
    axes.set_xlabel(known.unit, fontsize=8)
    axes.set_title(label(perturbation), fontsize=10)
    axes.grid(axis="y")

"""The stability of methods: the disturbance and severity at which each breaks."""

import numpy as np
import pandas as pd

from haptic_glance.disturb.objects import PERTURBATIONS
from stages.charts.breaking import broken, finish, panels
from stages.charts.drawing import GREY, INK, MARKERS, colours, label
from stages.charts.items import Figure, Table
from stages.charts.results import Results
from stages.charts.tables import interval_columns, percent, within
from stages.engine.statistics import BROKEN
from stages.stability.breaking import breaking_points, mean_repeatability, middle_severity

STAGE = "stability"
CHANCE = "random"  # it looks at nothing, so that it cannot break; its level is a column


def points_table(results: Results) -> Table:
    """The severity of each perturbation at which half of a method's points are lost."""
    rows = results.measured(STAGE, metric=["repeatability", "chance", "drift"])
    points = rows.loc[(rows["metric"] == "repeatability") & (rows["method"] != CHANCE)]
    lines = []
    for (perturbation, method), ends in breaking_points(points).items():
        group = rows.loc[rows["perturbation"] == perturbation]
        severities = list(group["severity"].unique())
        middle = middle_severity(severities)
        trials = group.loc[(group["method"] == method) & (group["severity"] == middle)]
        lines.append({
            "perturbation": perturbation, "unit": PERTURBATIONS[perturbation].unit, "method": method,
            "severity": middle,
            **interval_columns("repeatability", within(trials.loc[trials["metric"] == "repeatability", "value"])),
            "drift": trials.loc[trials["metric"] == "drift", "value"].mean(),
            "chance": group.loc[group["metric"] == "chance", "value"].mean(), "harshest": severities[-1],
            **interval_columns("breaking_point", ends, prefix=""),
        })  # fmt: skip
    frame = pd.DataFrame(lines)
    unharmed = {name: entry.unharmed for name, entry in PERTURBATIONS.items()}
    text_table = broken(frame, frame["method"].map(label), unharmed)
    text_table["chance, %"] = [percent(share) for share in frame.drop_duplicates("perturbation")["chance"]]
    names = list(dict.fromkeys(points["item"]))
    words = {"objects": ", ".join(names), "count": len(names), "not_run": results.left_out(STAGE)}
    answer = [name for name in map(str, text_table) if name != "chance, %"]
    return Table(frame, text_table, words, answer=answer)


def points_figure(results: Results) -> Figure:
    """Repeatability against severity: a panel a perturbation, a line a method."""
    rows = results.measured(STAGE, metric=["repeatability", "chance"])
    means = mean_repeatability(rows.loc[rows["method"] != CHANCE])
    chance = 100 * rows.loc[rows["metric"] == "chance"].groupby(["perturbation", "severity"])["value"].mean()
    methods, perturbations = (list(dict.fromkeys(means[key])) for key in ("method", "perturbation"))
    drawing, grid, legend = panels(perturbations, "points found again, %", 9.6, 2.25)
    for perturbation, axes in grid.items():
        panel = means.loc[means["perturbation"] == perturbation]
        severities = list(dict.fromkeys(panel["severity"]))
        wide = panel.pivot(index="severity", columns="method", values="value").reindex(severities, columns=methods)
        for k, (method, tint) in enumerate(colours(methods).items()):
            axes.plot(
                [100, *(100 * wide[method])], color=tint, marker=MARKERS[k % len(MARKERS)], ms=4, lw=1.4,
                label=label(method), clip_on=False,
            )  # fmt: skip
        guessed = [np.nan, *chance[perturbation].reindex(severities)]
        axes.plot(guessed, ":", color=INK, marker=".", ms=3, lw=1.2, label="chance")
        axes.axhline(100 * BROKEN, color=GREY, lw=0.6)
        axes.set_xlim(-0.15, len(severities) + 0.15)
        finish(axes, perturbation, PERTURBATIONS[perturbation].unit, severities)
    legend.legend(*grid[perturbations[0]].get_legend_handles_labels(), loc="center left", fontsize=9)
    drawing.tight_layout(h_pad=1.2, w_pad=0.6)
    words = {"perturbations": len(perturbations), "methods": ", ".join(map(label, methods))}
    return Figure(drawing, words | {"objects": ", ".join(dict.fromkeys(rows["item"]))})


PAGE = "stability"
TABLES = {
    "stability": points_table,
}
FIGURES = {
    "stability": points_figure,
}
CHARTS = {}

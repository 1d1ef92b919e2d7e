"""Where each method of finding salient points breaks: table, chart and the worst cases."""

from typing import Any

import numpy as np
import pandas as pd

from stages.kit import Mesh
from stages.kit.breaking_point import BROKEN
from stages.kit.files import read_arrays
from stages.report.drawing import show, square_grid
from stages.report.grid import grouped, percent, within
from stages.report.items import Figure, Table
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, MARKERS, colours, label
from stages.stability import PERTURBATIONS
from stages.stability.summary import breaking_points, mean_repeatability, middle_severity

from .panels import breaking_text, finish, panels

STAGE = "stability"
CHANCE = "random"  # it looks at nothing, so that it cannot break; its level is a column


def table(results: Results) -> Table:
    """The severity of each perturbation at which half of a method's points are lost."""
    rows = results.measured(STAGE, metric=["repeatability", "chance", "drift"])
    points = rows.loc[(rows["metric"] == "repeatability") & (rows["method"] != CHANCE)]
    found = []
    for (perturbation, method), breaking in breaking_points(points).items():
        own = rows.loc[rows["perturbation"] == perturbation]
        severities = list(dict.fromkeys(own["severity"]))
        middle = middle_severity(severities)
        here = own.loc[(own["method"] == method) & (own["severity"] == middle)]
        values = {metric: here.loc[here["metric"] == metric, "value"] for metric in ("repeatability", "drift")}
        mean, low, high = within(list(values["repeatability"]))
        found.append({
            "perturbation": perturbation, "unit": PERTURBATIONS[perturbation].unit, "method": method,
            "severity": middle, "repeatability": mean, "low": low, "high": high, "drift": values["drift"].mean(),
            "chance": own.loc[own["metric"] == "chance", "value"].mean(), "harshest": severities[-1],
            "breaking_point": breaking,
        })  # fmt: skip
    frame = pd.DataFrame(found)
    shown = [
        {"perturbation": label(name), "unit": unit}
        | {
            label(row["method"]): breaking_text([row["breaking_point"]], row["harshest"], PERTURBATIONS[name].unharmed)
            for row in group.to_dict("records")
        }
        | {"chance, %": percent(group["chance"].iloc[0])}
        for (name, unit), group in grouped(frame, ["perturbation", "unit"])
    ]
    words = {"objects": ", ".join(dict.fromkeys(points["item"])), "not_run": results.left_out(STAGE)}
    return Table(frame, pd.DataFrame(shown), words)


def figure(results: Results) -> Figure:
    """Repeatability against severity: a panel a perturbation, a line a method."""
    rows = results.measured(STAGE, metric=["repeatability", "chance"])
    means = mean_repeatability(rows.loc[rows["method"] != CHANCE])
    chances = grouped(rows.loc[rows["metric"] == "chance"], ["perturbation", "severity"])
    chance = {key: 100 * group["value"].mean() for key, group in chances}
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
        guessed = [np.nan, *(chance.get((perturbation, one), np.nan) for one in severities)]
        axes.plot(guessed, ":", color=INK, marker=".", ms=3, lw=1.2, label="chance")
        axes.axhline(100 * BROKEN, color=GREY, lw=0.6)
        axes.set_xlim(-0.15, len(severities) + 0.15)
        finish(axes, perturbation, PERTURBATIONS[perturbation].unit, severities)
    legend.legend(*grid[perturbations[0]].get_legend_handles_labels(), loc="center left", fontsize=9)
    drawing.tight_layout(h_pad=1.2, w_pad=0.6)
    words = {"perturbations": len(perturbations), "methods": ", ".join(map(label, methods))}
    return Figure(drawing, words | {"objects": ", ".join(dict.fromkeys(rows["item"]))})


def failures(results: Results) -> Figure:
    """Each method's worst case: before and after."""
    worst = _worst(results)
    drawing, grid = square_grid(2, len(worst), side=1.9, right=0.2, gap=0.5)
    for (before, after), (method, case) in zip(grid.T, worst.items(), strict=True):
        show(before, results.mesh(case["item"]), case["before_saliency"], points=case["before_points"])
        show(after, Mesh(case["vertices"], case["faces"]), case["after_saliency"], points=case["after_points"])
        what = f"{label(case['perturbation'])} {float(case['severity']):g}"
        again = f"{100 * float(case['repeatability']):.0f} % found again"
        for axes, title in ((before, f"{label(method)}\n{case['item']}"), (after, f"{what}\n{again}")):
            axes.set_title(title, fontsize=9, fontweight="normal", loc="center")
    for axes, text in zip(grid[:, 0], ("before", "after"), strict=True):
        axes.text(-0.04, 0.5, text, rotation=90, va="center", ha="right", transform=axes.transAxes)
    units = {label(case["perturbation"]): PERTURBATIONS[case["perturbation"]].unit for case in worst.values()}
    said = "; ".join(f"{name}: {unit}" for name, unit in units.items())
    return Figure(drawing, {"methods": ", ".join(map(label, worst)), "units": said})


def _worst(results: Results) -> dict[str, dict[str, Any]]:
    """{method: its arrays on the object where the fewest points were found again}."""
    found: dict[str, dict[str, Any]] = {}
    for path in sorted(results.folder(STAGE).glob("*.npz")):
        stored = read_arrays(path)
        for method in dict.fromkeys(key.rpartition(".")[0] for key in stored):
            start = f"{method}."
            case = {key.removeprefix(start): values for key, values in stored.items() if key.startswith(start)}
            case |= {"item": path.stem, "perturbation": str(case["perturbation"])}
            share = np.nan_to_num(case["repeatability"])
            if method not in found or share < np.nan_to_num(found[method]["repeatability"]):
                found[method] = case
    if not found:
        raise NotRun("no data/stability", STAGE)
    return found

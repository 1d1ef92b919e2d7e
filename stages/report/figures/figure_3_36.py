"""T figure 3.36: how far the centres of what a detector finds lie from those of people's fixations."""

import numpy as np
import pandas as pd
from matplotlib.ticker import FuncFormatter, NullFormatter

from stages.report.items import Figure
from stages.report.style import INK, save
from stages.report.tables._fixation import (
    ALL_VIEWS,
    KINDS,
    NO_PEOPLE,
    PERCENT,
    TINTS,
    detectors,
    kind,
    sources,
)

from .figure_3_35 import panels

FLOOR = 0.1  # %: a centre nearer than this is on the spot, and the axis begins there


def build(results):
    found = sources(results, "distance")
    names = ranked([_views(rows) for rows in found.values()])
    figure, grid = panels(len(found), names)
    for axes, (source, rows) in zip(grid, found.items(), strict=True):
        _draw(axes, rows[rows["view"].astype(str) != ALL_VIEWS], names)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel("distance, % of the diameter\nof the bounding sphere")
    for key, tint in TINTS.items():
        grid[-1].barh([np.nan], [1], color=tint, alpha=0.45, label=KINDS[key])
    grid[-1].plot([], [], "D", color="white", mec=INK, ms=4.5, label="median of the mean\nover all pairs")
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    figure.tight_layout()
    people = f" {NO_PEOPLE}" if any(source.startswith("marks") for source in found) else ""
    return Figure(
        "Figure 3.36: distance between fixation centres",
        f"Box plots on a logarithmic axis of the distance between the centres of fixation of each detector and of "
        f"{' and of '.join(found)}, least median first.",
        "Boxes: quartiles of the least distance of a view over the three views of all objects, the thesis's number; "
        "line: median; whiskers: 5 to 95 %; what is under 0.1 % counts as that. The least distance shrinks with the "
        "number of centres, so that noise, which has many, does well: diamonds tell the mean over all pairs of centres "
        f"of a view.{people}",
        [save(figure, results.reports / "figures/figure_3_36.png")],
    )


def _views(rows):
    """Frame (object, view) x (method, task) of the distance."""
    own = rows[rows["metric"] == "distance"]
    return own.pivot_table(index=["object", "view"], columns=["method", "task"], values="value", sort=False)


def ranked(tables):
    """The detectors of all tables, least median of the first table first."""
    order = pd.concat([table[detectors(table)].median() for table in tables])
    return list(order[~order.index.duplicated()].sort_values(kind="stable").index)


def _draw(axes, rows, names):
    for y, (method, task) in enumerate(names):
        own = rows[(rows["method"] == method) & (rows["task"] == task)]
        values = PERCENT * own.loc[own["metric"] == "distance", "value"].to_numpy()
        if not len(values):
            continue
        low, left, middle, right, high = np.maximum(np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95]), FLOOR)
        tint = TINTS[kind((method, task))]
        axes.plot([low, high], [y, y], color=tint, lw=0.9)
        axes.barh(y, right - left, 0.6, left, color=tint, alpha=0.45)
        axes.plot([middle] * 2, [y - 0.3, y + 0.3], color=INK, lw=1.3)
        pairs = PERCENT * own.loc[own["metric"] == "distance_mean", "value"].median()
        if pairs == pairs:
            axes.plot(max(pairs, FLOOR), y, "D", color="white", mec=tint, ms=4.5, mew=1.1)
    axes.set_xscale("log")
    axes.set_xlim(left=FLOOR)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())

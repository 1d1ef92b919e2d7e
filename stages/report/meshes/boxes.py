"""T figures 3.23 to 3.26: Metro and SSIM errors at 1,500 and 3,000 faces, as boxes over the objects."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, METHOD_COLOURS, PALE, plt
from stages.report.words import dataset_text

from .dots import name_rows
from .methods import FIXED_ADAPTIVE, HKS, OURS, PLAIN, RIVALS, short
from .rows import ERRORS, FEWEST, data_sets, paired_cells, said

METHODS = [*FIXED_ADAPTIVE, OURS, f"{OURS}-adaptive", f"{OURS}-soft", "VisAttAll", HKS, *RIVALS, PLAIN]
TINTS = dict.fromkeys(METHODS, GREY) | dict.fromkeys(FIXED_ADAPTIVE, "#D55E00")  # the others, the methods of T3.2,
TINTS |= {method: METHOD_COLOURS[OURS] for method in METHODS if method.startswith(OURS)}  # and ours
PANELS = [(metric, target) for metric in ("metro_mean", "ssim_error") for target in ("1500", "3000")]
ROW = 0.17  # inches a method
FLOOR = 1e-3  # of plain QEM's median: an axis begins there, since some meshes are exact


def build(results: Results) -> Figure:
    """A row of panels for each data set, a panel for each error and face count, a box for each method."""
    shown = {name: rows for name, rows in _rows(results).items() if len(rows)}
    if not shown:
        raise NotRun("no data set with enough objects that all methods take to 1,500 or 3,000 faces", "lod", False)
    methods = [method for method in METHODS if any((rows["method"] == method).any() for rows in shown.values())]
    height = 0.5 + ROW * len(methods)
    drawing, grid = plt.subplots(len(shown), 4, figsize=(10.4, 0.4 + height * len(shown)), squeeze=False, sharey=True)
    for row, (name, rows) in zip(grid, shown.items(), strict=True):
        for axes, (metric, target) in zip(row, PANELS, strict=True):
            here = rows[(rows["metric"] == metric) & (rows["target"] == target)]
            _boxes(axes, here.assign(value=ERRORS[metric][1] * here["value"]), methods)
            title = f"{ERRORS[metric][0]}, {said(target)}\n{name}, {here['item'].nunique()} objects"
            axes.set_title(title, fontsize=8.5, fontweight="normal", pad=4)
        name_rows(row[0], methods, [TINTS[method] for method in methods], 8)
    drawing.subplots_adjust(wspace=0.08, hspace=0.34)
    return Figure(drawing, {"methods": ", ".join(map(short, methods)), "sets": " and ".join(shown)}, dpi=95)


def _rows(results: Results) -> dict[str, pd.DataFrame]:
    """dict data set -> rows of the panels' errors and face counts with enough objects."""
    found = {}
    for dataset in data_sets(results):
        rows = paired_cells(results, ["metro_mean", "ssim_error"], METHODS, dataset)
        enough = rows.groupby("target")["item"].transform("nunique") >= FEWEST
        found[dataset_text(dataset)] = rows[rows["target"].isin([target for _, target in PANELS]) & enough]
    return found


def _boxes(axes: Axes, rows: pd.DataFrame, methods: list[str]) -> None:
    floor = FLOOR * rows.loc[rows["method"] == PLAIN, "value"].median()
    for y, method in enumerate(methods):
        values = np.maximum(rows.loc[rows["method"] == method, "value"].to_numpy(), floor)
        if len(values) == 0 or not floor > 0:
            continue
        low, left, middle, right, high = np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95])
        axes.plot([low, high], [y, y], color=TINTS[method], lw=0.9)
        axes.barh(y, right - left, 0.62, left, color=TINTS[method], alpha=0.45)
        axes.plot([middle] * 2, [y - 0.31, y + 0.31], color=INK, lw=1.3)
        if method == PLAIN:
            axes.axvline(middle, color=GREY, lw=0.9, ls="--", zorder=0)
    axes.set_xscale("log")
    axes.set_xlim(left=floor if floor > 0 else None)
    axes.xaxis.set_major_locator(LogLocator(numticks=6))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="x", labelsize=8, which="both")
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=PALE, lw=0.5)

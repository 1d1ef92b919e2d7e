"""T figures 3.23 to 3.26: Metro and SSIM errors at 1,500 and 3,000 faces, as boxes over the objects."""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, METHOD_COLOURS, PALE, plt, save
from stages.report.words import dataset_text

from .lod_detectors import short
from .rows import ERRORS, FEWEST, PLAIN, data_sets, paired_cells, said
from .table_3_2 import PROPOSED

THESIS = [each for name in PROPOSED[:3] for each in (name, f"{name}-adaptive")]
RIVALS = ["VisAttAll", "heat_kernel", "salient_points", "mesh_saliency", "sift", "harris", "corners"]
METHODS = [*THESIS, "enhanced", "enhanced-adaptive", "enhanced-soft", *RIVALS, PLAIN]
PANELS = [("metro_mean", "1500"), ("metro_mean", "3000"), ("ssim_error", "1500"), ("ssim_error", "3000")]
TINTS = {"thesis": "#D55E00", "ours": METHOD_COLOURS["enhanced"], "others": GREY}
ROW = 0.17  # inches a method
FLOOR = 1e-3  # of plain QEM's median: an axis begins there, since some meshes are exact


def build(results: Results) -> Figure:
    shown = {name: rows for name, rows in _rows(results).items() if len(rows)}
    if not shown:
        raise NotRun("no data set with enough objects that all methods take to 1,500 or 3,000 faces", "lod", False)
    methods = [method for method in METHODS if any((rows["method"] == method).any() for rows in shown.values())]
    height = 0.5 + ROW * len(methods)
    figure, grid = plt.subplots(len(shown), 4, figsize=(10.4, 0.4 + height * len(shown)), squeeze=False, sharey=True)
    for row, (name, rows) in zip(grid, shown.items(), strict=True):
        for axes, (metric, target) in zip(row, PANELS, strict=True):
            here = rows[(rows["metric"] == metric) & (rows["target"] == target)]
            _boxes(axes, here.assign(value=ERRORS[metric][1] * here["value"]), methods)
            title = f"{ERRORS[metric][0]}, {said(target)}\n{name}, {here['item'].nunique()} objects"
            axes.set_title(title, fontsize=8.5, fontweight="normal", pad=4)
        _names(row[0], methods)
    figure.subplots_adjust(wspace=0.08, hspace=0.34)
    path = save(figure, results.reports / "figures/figure_3_23.png", dpi=95)
    return Figure(
        "Figures 3.23 to 3.26: errors by method, over the objects",
        f"Box plots of Metro mean and SSIM error at 1,500 and 3,000 faces for {', '.join(map(short, methods))}, on "
        f"{' and '.join(shown)}.",
        "Logarithmic axes, from a thousandth of plain QEM's median on: below it a mesh is as good as exact. Box: "
        "quartiles over the objects that all methods take to that count; whiskers: 5 to 95 %. "
        "Orange: the methods of T3.2; blue: ours; dashed: the median of plain QEM. Objects differ far more than "
        "methods do, so the boxes overlap: paired differences are in the claims and in table 3.2.",
        [path],
    )


def _rows(results):
    """dict data set -> rows of the panels' errors and face counts with enough objects."""
    found = {}
    for dataset in data_sets(results):
        rows = paired_cells(results, ["metro_mean", "ssim_error"], METHODS, dataset)
        objects = rows.groupby("target")["item"].transform("nunique")
        found[dataset_text(dataset)] = rows[rows["target"].isin({target for _, target in PANELS}) & (objects >= FEWEST)]
    return found


def _boxes(axes, rows, methods):
    floor = FLOOR * rows.loc[rows["method"] == PLAIN, "value"].median()
    for y, method in enumerate(methods):
        values = np.maximum(rows.loc[rows["method"] == method, "value"].to_numpy(), floor)
        if len(values) == 0 or not floor > 0:
            continue
        low, left, middle, right, high = np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95])
        tint = _tint(method)
        axes.plot([low, high], [y, y], color=tint, lw=0.9)
        axes.barh(y, right - left, 0.62, left, color=tint, alpha=0.45)
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


def _tint(method):
    if method.startswith("enhanced"):
        return TINTS["ours"]
    return TINTS["thesis" if method in THESIS else "others"]


def _names(axes, methods):
    axes.set_yticks(range(len(methods)), [short(method) for method in methods], fontsize=8)
    axes.set_ylim(len(methods) - 0.4, -0.6)
    for text, method in zip(axes.get_yticklabels(), methods, strict=True):
        text.set_color(_tint(method))

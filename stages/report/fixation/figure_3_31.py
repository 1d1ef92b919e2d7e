"""T figure 3.31: how alike the maps of two tasks are, a matrix a network."""

import numpy as np

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.style import INK, MAP, label, plt, save

from .rows import TASKS, best_source, network_text, networks

ACROSS = 4  # matrices a row
LIGHT = 0.62  # from this correlation on the cell is bright and its number dark


def build(results: Results) -> Figure:
    source, rows = best_source(results, "pcc_tasks")
    methods = networks(rows)
    across = min(ACROSS, len(methods))
    down = -(-len(methods) // across)
    figure, grid = plt.subplots(down, across, figsize=(3.6 * across + 0.5, 3.3 * down), squeeze=False)
    for axes, method in zip(grid.flat, methods, strict=False):
        pairs = likeness(rows, method)
        shown = _draw(axes, pairs.mean())
        axes.set_title(f"{network_text(method)}\nmean {with_interval(*span(pairs.mean(axis=1)), places=2)}",
                       fontsize=9.5, fontweight="normal", loc="center")  # fmt: skip
    for axes in list(grid.flat)[len(methods) :]:
        axes.set_axis_off()
    figure.tight_layout(w_pad=2)
    figure.colorbar(shown, ax=grid, shrink=0.7, pad=0.015, aspect=22).set_label("PCC")
    return Figure(
        "Figure 3.31: how alike the tasks' maps are",
        f"Matrices of the mean correlation between the attention of each two tasks, on {source}, for "
        f"{'; '.join(map(network_text, methods))}.",
        f"Pearson's correlation over the vertices that a view sees, the mean of all views and of {source}. Brackets: "
        "95 % interval of the mean over all pairs, over the objects. Random weights: the control.",
        [save(figure, results.reports / "figures/figure_3_31.png")],
    )


def likeness(rows, method):
    """Frame objects x pairs `TASK~TASK` of the correlation of two tasks' maps by a method."""
    own = rows[(rows["metric"] == "pcc_tasks") & (rows["method"] == method)]
    return own.pivot_table(index="item", columns="task", values="value", sort=False)


def span(values):
    """(mean, low, high) of correlations, cut at -1 and 1."""
    return np.clip(interval(values), -1, 1)


def _draw(axes, means):
    """The lower triangle of the matrix, with its numbers."""
    tasks = [task for task in TASKS if any(task in pair.split("~") for pair in means.index)]
    matrix = np.full((len(tasks), len(tasks)), np.nan)
    for pair, value in means.items():
        low, high = sorted(tasks.index(task) for task in pair.split("~"))
        matrix[high, low] = value
    shown = axes.imshow(matrix[1:, :-1], cmap=MAP, vmin=0, vmax=1)
    for (down, across), value in np.ndenumerate(matrix[1:, :-1]):
        if value == value:
            tint = INK if value > LIGHT else "white"
            axes.text(across, down, f"{value:.2f}", ha="center", va="center", color=tint, fontsize=8)
    names = list(map(label, tasks))
    axes.set_xticks(range(len(tasks) - 1), names[:-1], rotation=40, ha="right", fontsize=8)
    axes.set_yticks(range(len(tasks) - 1), names[1:], fontsize=8)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    return shown

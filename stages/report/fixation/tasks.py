"""T figures 3.28 and 3.31: into how many classes the objects fall by shape, and how alike the tasks' maps are."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from stages.fixation.tasks import SHAPE_MEASURES
from stages.report.grid import everywhere, grouped, records, within
from stages.report.items import Figure
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.style import CYCLE, INK, MAP, label, plt
from stages.report.words import dataset_text

from .detectors import TASKS, network_text
from .rows import networks, sources

# A set's colour, and where its chosen number stands, in points.
LINES = ((CYCLE[0], (-14, -7)), (CYCLE[1], (7, 6)), (CYCLE[2], (-16, -9)))


def figure_3_28(results: Results) -> Figure:
    """The elbow of k-means in the sums of squares, by task of shape and data set."""
    found = everywhere(results, "fixation", "no sums of squares: the objects do not differ in shape", metric="ssd")
    rows = pd.concat(found.values())
    rows["chosen"] = rows["chosen"].astype(str) == "True"
    curves = dict(grouped(rows, ["task", "dataset"]))
    tasks = [task for task in SHAPE_MEASURES if task in set(rows["task"])]
    figure, (grid,) = plt.subplots(1, len(tasks), figsize=(3.5 * len(tasks), 3.0), squeeze=False)
    for axes, task in zip(grid, tasks, strict=True):
        for (tint, beside), dataset in zip(LINES, found, strict=False):
            if (task, dataset) in curves:
                _elbow(axes, curves[task, dataset].sort_values("clusters"), dataset_text(dataset), tint, beside)
        axes.plot([], [], "o", mfc="none", mec=INK, mew=1.8, ms=10, label="chosen")
        axes.set(title=label(task), xlabel="clusters", ylim=(0, 1.15))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.grid(axis="y")
    grid[0].set_ylabel("sum of squared distances,\nover that of the fewest clusters")
    grid[-1].legend(fontsize=8.5)
    figure.tight_layout()
    said = [f"{dataset_text(dataset)}: {', '.join(f'{label(row.task)} {row.clusters:g}' for row in records(chosen))}"
            for (dataset,), chosen in grouped(rows[rows["chosen"]], ["dataset"])]  # fmt: skip
    return Figure(figure, {"chosen": "; ".join(said)})


def _elbow(axes: Axes, rows: pd.DataFrame, source: str, tint: str, beside: tuple[int, int]) -> None:
    share = rows["value"] / rows["value"].iloc[0]
    axes.plot(rows["clusters"], share, "-o", color=tint, ms=4, lw=1.3, label=source)
    for spot in zip(rows["clusters"][rows["chosen"]], share[rows["chosen"]], strict=True):
        axes.plot(*spot, "o", mfc="none", mec=INK, mew=1.8, ms=10)
        axes.annotate(f"{spot[0]:g}", spot, beside, textcoords="offset points", color=INK, fontsize=9)


def figure_3_31(results: Results) -> Figure:
    """A matrix a network: the correlation of the maps of each two tasks."""
    source, rows = next(iter(sources(results, "pcc_tasks").items()))
    methods, rows = networks(rows), rows[rows["metric"] == "pcc_tasks"]
    across = min(4, len(methods))
    down = -(-len(methods) // across)
    figure, grid = plt.subplots(down, across, figsize=(3.6 * across + 0.5, 3.3 * down), squeeze=False)
    for axes, method in zip(grid.flat, methods, strict=False):
        pairs = rows[rows["method"] == method].pivot_table(index="item", columns="task", values="value", sort=False)
        _matrix(axes, pairs.mean())
        mean = with_interval(*within(pairs.mean(axis=1), least=-1), places=2)
        axes.set_title(f"{network_text(method)}\nmean {mean}", fontsize=9.5, fontweight="normal", loc="center")
    for axes in grid.flat[len(methods) :]:
        axes.set_axis_off()
    figure.tight_layout(w_pad=2)
    figure.colorbar(grid[0, 0].images[0], ax=grid, shrink=0.7, pad=0.015, aspect=22).set_label("PCC")
    return Figure(figure, {"source": source, "networks": "; ".join(map(network_text, methods))})


def _matrix(axes: Axes, means: pd.Series) -> None:
    """The lower triangle of the matrix, with its numbers; means: by `TASK~TASK`."""
    named = set("~".join(means.index).split("~"))
    tasks = [task for task in TASKS if task in named]
    matrix = np.full((len(tasks) - 1, len(tasks) - 1), np.nan)
    for pair, value in means.items():
        across, down = sorted(map(tasks.index, str(pair).split("~")))
        matrix[down - 1, across] = value
        tint = INK if value > 0.62 else "white"  # from there on the cell is bright
        axes.text(across, down - 1, f"{value:.2f}", ha="center", va="center", color=tint, fontsize=8)
    names = list(map(label, tasks))
    axes.set_xticks(range(len(tasks) - 1), names[:-1], rotation=40, ha="right", fontsize=8)
    axes.set_yticks(range(len(tasks) - 1), names[1:], fontsize=8)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.imshow(matrix, cmap=MAP, vmin=0, vmax=1)

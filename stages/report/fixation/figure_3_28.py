"""T figure 3.28: into how many classes the objects fall by shape, at the elbow of k-means."""

from contextlib import suppress

from matplotlib.ticker import MaxNLocator

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, INK, label, plt, save
from stages.report.words import dataset_text

from .rows import SHAPE

LINES = ((CYCLE[0], (-14, -7)), (CYCLE[1], (7, 6)))  # colour, and where the chosen number stands, in points


def build(results: Results) -> Figure:
    found = curves(results)
    tasks = [task for task in SHAPE if any((rows["task"] == task).any() for rows in found.values())]
    figure, grid = plt.subplots(1, len(tasks), figsize=(3.5 * len(tasks), 3.0), squeeze=False)
    for axes, task in zip(grid[0], tasks, strict=True):
        for (tint, beside), (source, rows) in zip(LINES, found.items(), strict=False):
            _draw(axes, rows[rows["task"] == task], source, tint, beside)
        axes.plot([], [], "o", mfc="none", mec=INK, mew=1.8, ms=10, label="chosen")
        axes.set_title(label(task))
        axes.set_xlabel("clusters")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_ylim(0, 1.15)
        axes.grid(axis="y")
    grid[0, 0].set_ylabel("sum of squared distances,\nover that of the fewest clusters")
    grid[0, -1].legend(fontsize=8.5)
    figure.tight_layout()
    said = "; ".join(f"{source}: {_said(rows)}" for source, rows in found.items())
    return Figure(
        "Figure 3.28: how many classes the objects have by shape",
        "Sums of squared distances over the number of k-means clusters, for convexity, curvature and eccentricity.",
        f"Chosen: the point farthest below the line from the first to the last, both axes scaled to 0..1. {said}.",
        [save(figure, results.reports / "figures/figure_3_28.png")],
    )


def curves(results):
    """{data set in words: rows of task, clusters, value (the sum of squares), chosen}; NotRun where none is known."""
    found = {}
    for dataset in results.datasets("fixation"):
        with suppress(NotRun):
            found[dataset_text(dataset)] = results.measured("fixation", dataset, metric="ssd")
    if not found:
        raise NotRun("no sums of squares: the objects do not differ in shape", "fixation")
    return found


def _draw(axes, rows, source, tint, beside):
    if rows.empty:
        return
    rows = rows.sort_values("clusters")
    share = rows["value"] / rows["value"].iloc[0]
    axes.plot(rows["clusters"], share, "-o", color=tint, ms=4, lw=1.3, label=source)
    best = rows["chosen"].astype(str) == "True"
    axes.plot(rows["clusters"][best], share[best], "o", mfc="none", mec=INK, mew=1.8, ms=10)
    for k, y in zip(rows["clusters"][best], share[best], strict=True):
        axes.annotate(f"{k:g}", (k, y), beside, textcoords="offset points", color=INK, fontsize=9)


def _said(rows):
    best = rows[rows["chosen"].astype(str) == "True"]
    return ", ".join(f"{label(row.task)} {row.clusters:g}" for row in best.itertuples())

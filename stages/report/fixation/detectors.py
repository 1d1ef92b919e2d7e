"""T figures 3.35 and 3.36: how much each detector agrees with people, and how far its centres lie from theirs."""

import numpy as np
import pandas as pd
from matplotlib.ticker import FuncFormatter, NullFormatter

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import INK, PALE, plt, save

from .rows import ALL_VIEWS, KINDS, PERCENT, TINTS, detector_text, detectors, kind, people, scores, sources

ROW = 0.26  # inches a detector
FLOOR = 0.1  # %: a centre nearer than this is on the spot, and the axis begins there


def figure_3_35(results: Results) -> Figure:
    """Correlation with people, best mean first."""
    found = sources(results)
    tables = [(scores(rows, "pcc"), scores(rows, "pcc_masked")) for rows in found.values()]
    names = ranked([own[detectors(own)].mean() for own, _ in tables], best_first=True)
    figure, grid = _panels(found, names, "Pearson's correlation with people")
    for axes, (own, masked) in zip(grid, tables, strict=True):
        for y, name in enumerate(names):
            tint = TINTS[kind(name)]
            if name in masked:
                axes.plot(masked[name].mean(), y, "D", color="white", mec=tint, ms=4.5, mew=1.1)
            if name in own:
                mean, low, high = interval(own[name].dropna())
                axes.plot([low, high], [y, y], color=tint, lw=1.6, alpha=0.5)
                axes.plot(mean, y, "o", color=tint, ms=5, mec="white", mew=0.5)
        axes.axvline(0, color=INK, lw=0.8)
    for key, tint in TINTS.items():
        grid[-1].plot([], [], "o", color=tint, ms=5, label=KINDS[key])
    _legend(figure, grid, "hidden vertices as zeros\n(the thesis's way)")
    return Figure(
        "Figure 3.35: detectors against people, by correlation",
        f"Pearson's correlation of each detector with {' and with '.join(found)}, with intervals, best first.",
        "Dots: over the vertices that a view sees, mean of three views; lines: 95 % intervals over objects. Diamonds: "
        "over all vertices with the hidden ones set to zero in both, which even the controls gain from. Paired "
        f"differences are in the table and in the claims.{people(found)}",
        [save(figure, results.reports / "figures/figure_3_35.png")],
    )


def figure_3_36(results: Results) -> Figure:
    """Distance between centres of fixation, least median first."""
    found = sources(results, "distance")
    tables = [_views(rows) for rows in found.values()]
    names = ranked([table[detectors(table)].median() for table in tables], best_first=False)
    figure, grid = _panels(found, names, "distance, % of the diameter\nof the bounding sphere")
    for axes, rows in zip(grid, found.values(), strict=True):
        _boxes(axes, rows[rows["view"].astype(str) != ALL_VIEWS], names)
    for key, tint in TINTS.items():
        grid[-1].barh([np.nan], [1], color=tint, alpha=0.45, label=KINDS[key])
    _legend(figure, grid, "median of the mean\nover all pairs")
    return Figure(
        "Figure 3.36: distance between fixation centres",
        f"Box plots on a logarithmic axis of the distance between the centres of fixation of each detector and of "
        f"{' and of '.join(found)}, least median first.",
        "Boxes: quartiles of the least distance of a view over the three views of all objects, the thesis's number; "
        "line: median; whiskers: 5 to 95 %; what is under 0.1 % counts as that. The least distance shrinks with the "
        "number of centres, so that noise, which has many, does well: diamonds tell the mean over all pairs of centres "
        f"of a view.{people(found)}",
        [save(figure, results.reports / "figures/figure_3_36.png")],
    )


def ranked(columns, best_first):
    """The detectors of Series by detector, in the order of the first that has each; best_first: the highest first."""
    order = pd.concat(columns)
    return list(order[~order.index.duplicated()].sort_values(ascending=not best_first, kind="stable").index)


def _views(rows):
    """Frame (object, view) x (method, task) of the distance."""
    own = rows[rows["metric"] == "distance"]
    return own.pivot_table(index=["item", "view"], columns=["method", "task"], values="value", sort=False)


def _panels(found, names, words):
    """(figure, axes): a panel for each truth, one row per detector."""
    size = (3.9 * len(found) + 3.6, 1.0 + ROW * len(names))
    figure, grid = plt.subplots(1, len(found), figsize=size, squeeze=False, sharey=True, sharex=True)
    grid[0, 0].set_yticks(range(len(names)), list(map(detector_text, names)), fontsize=8.5)
    grid[0, 0].set_ylim(len(names) - 0.4, -0.6)
    for axes, source in zip(grid[0], found, strict=True):
        axes.grid(axis="x")
        axes.hlines(range(len(names)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        axes.tick_params(axis="y", length=0)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel(words)
    return figure, grid[0]


def _legend(figure, grid, diamond):
    grid[-1].plot([], [], "D", color="white", mec=INK, ms=4.5, label=diamond)
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    figure.tight_layout()


def _boxes(axes, rows, names):
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

"""T figure 3.35: how much each detector of saliency agrees with where people look."""

import pandas as pd

from stages.report.intervals import interval
from stages.report.items import Figure
from stages.report.style import INK, PALE, plt, save
from stages.report.tables._fixation import KINDS, NO_PEOPLE, TINTS, detectors, kind, scores, sources, spoken

ROW = 0.26  # inches a detector


def build(results):
    found = sources(results)
    tables = {source: (scores(rows, "pcc"), scores(rows, "pcc_masked")) for source, rows in found.items()}
    names = ranked([table for table, _ in tables.values()])
    figure, grid = panels(len(found), names)
    for axes, (source, (own, masked)) in zip(grid, tables.items(), strict=True):
        _draw(axes, own, masked, names)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel("Pearson's correlation with people")
        axes.axvline(0, color=INK, lw=0.8)
    for key, tint in TINTS.items():
        grid[-1].plot([], [], "o", color=tint, ms=5, label=KINDS[key])
    grid[-1].plot([], [], "D", color="white", mec=INK, ms=4.5, label="hidden vertices as zeros\n(the thesis's way)")
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    figure.tight_layout()
    people = f" {NO_PEOPLE}" if any(source.startswith("marks") for source in found) else ""
    return Figure(
        "Figure 3.35: detectors against people, by correlation",
        f"Pearson's correlation of each detector with {' and with '.join(found)}, with intervals, best first.",
        "Dots: over the vertices that a view sees, mean of three views; lines: 95 % intervals over objects. Diamonds: "
        "over all vertices with the hidden ones set to zero in both, which even the controls gain from. Paired "
        f"differences are in the table and in the claims.{people}",
        [save(figure, results.reports / "figures/figure_3_35.png")],
    )


def ranked(tables):
    """The detectors of all tables (the frames of scores), best mean of the first table first."""
    order = pd.concat([table[detectors(table)].mean() for table in tables])
    return list(order[~order.index.duplicated()].sort_values(ascending=False, kind="stable").index)


def panels(count, names):
    """(figure, axes (count,)): panels side by side, one row a detector."""
    figure, grid = plt.subplots(
        1, count, figsize=(3.9 * count + 3.6, 1.0 + ROW * len(names)), squeeze=False, sharey=True, sharex=True
    )
    grid[0, 0].set_yticks(range(len(names)), list(map(spoken, names)), fontsize=8.5)
    grid[0, 0].set_ylim(len(names) - 0.4, -0.6)
    for axes in grid[0]:
        axes.grid(axis="x")
        axes.hlines(range(len(names)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        axes.tick_params(axis="y", length=0)
    return figure, grid[0]


def _draw(axes, own, masked, names):
    for y, name in enumerate(names):
        tint = TINTS[kind(name)]
        if name in masked:
            axes.plot(masked[name].mean(), y, "D", color="white", mec=tint, ms=4.5, mew=1.1)
        if name in own:
            mean, low, high = interval(own[name].dropna())
            axes.plot([low, high], [y, y], color=tint, lw=1.6, alpha=0.5)
            axes.plot(mean, y, "o", color=tint, ms=5, mec="white", mew=0.5)

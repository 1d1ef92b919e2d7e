"""Comparison of detectors and tasks' maps with people, by correlation and by distance (T figures 3.32, 3.35, 3.36).

The distance is between centres of fixation. The thesis compares distances by a box plot over all views (T figure 3.36),
so the claims compare quantiles: `lower_quartile_below`, `median_below` and `upper_quartile_below`.
"""

from collections.abc import Callable, Collection
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.engine.statistics import interval
from stages.report.claims import Claim
from stages.report.drawing import GREY, INK, PALE, colours, plain_logarithm, plt
from stages.report.effects import side, statistic
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.tables import number

from .rows import (
    FUSED,
    KINDS,
    NOISE,
    TASKS,
    Detector,
    detectors,
    network_text,
    networks,
    no_people,
    scores,
    sources,
    task_text,
    untrained,
)

LINES = (*TASKS, FUSED)
FLOOR = 0.1  # %: a centre nearer than this is on the spot, and the axis begins there
Tables = dict[str, tuple[pd.DataFrame, pd.DataFrame]]
DOT: dict[str, Any] = {"marker": "o", "ls": "", "ms": 5}
LOOKS = {"finetuned": {"marker": "s"}, "last_block": {"marker": "^"}, "random": {"mfc": "white"}}
DIAMOND = DOT | {"marker": "D", "color": "white", "ms": 4.5}


def figure_3_32(results: Results) -> Figure:
    """Correlation of each task's map with people as T3.3.6 prints it, a row a task, a colour a network."""
    truths = sources(results)
    methods = sorted(dict.fromkeys(method for rows in truths.values() for method in networks(rows)), key=untrained)
    parts = {method: method.rpartition("-") for method in methods}
    paint = colours(list(dict.fromkeys(base for base, *_ in parts.values())))
    marks = {method: DOT | {"color": paint[base]} | LOOKS.get(mode, {}) for method, (base, _, mode) in parts.items()}
    places = (np.arange(len(methods)) - (len(methods) - 1) / 2) * 0.72 / max(len(methods), 3)
    size = (4.0 * len(truths) + 2.6, 1.2 + len(LINES) * max(0.42, 0.14 * len(methods)))
    grid = _panels(truths, list(map(task_text, LINES)), "Pearson's correlation with people", size, 10)
    for axes, rows in zip(grid, truths.values(), strict=True):
        table = scores(rows, "pcc_masked")
        for (y, task), (down, method) in product(enumerate(LINES), zip(places, methods, strict=True)):
            if (method, task) in table:
                _span(axes, table[method, task], y + down, lw=1.5, **marks[method])
        axes.axvline(0, color=INK, lw=0.8)
        axes.axhline(len(TASKS) - 0.5, color=GREY, lw=0.6)
        axes.hlines(np.arange(len(TASKS) - 1) + 0.5, 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.5)
    for method, mark in marks.items():
        grid[-1].plot([], [], label=network_text(method), **mark)
    return _with_noise(_with_legend(grid, truths), truths)


def figure_3_35(results: Results) -> Figure:
    """Correlation of detectors with people as T3.3.6 prints it, best mean first."""
    tables = {source: (scores(rows, "pcc_masked"), scores(rows, "pcc")) for source, rows in sources(results).items()}
    draw, zero = partial(_span, lw=1.6, mec="white", mew=0.5, **DOT), partial(Axes.axvline, color=INK, lw=0.8)
    grid = _ranked(tables, "mean", "Pearson's correlation with people", draw, zero, zorder=1.9)
    for words, tint in KINDS.values():
        grid[-1].plot([], [], color=tint, label=words, **DOT)
    return _with_noise(_with_legend(grid, tables, "over visible vertices alone"), sources(results))


def _with_noise(figure: Figure, truths: dict[str, pd.DataFrame]) -> Figure:
    """The figure, with what noise has by its correlation on the first truth among its words."""
    source, rows = next(iter(truths.items()))
    figure.words["noise"] = f"{number(scores(rows, 'pcc_masked')[NOISE].mean())} on {source}"
    return figure


def figure_3_36(results: Results) -> Figure:
    """Distance between centres of fixation of detectors and of people, least median first."""
    tables: Tables = {}
    for source, rows in sources(results, "distance").items():
        nearest, pairs = (scores(rows, metric, ("item", "view")) for metric in ("distance", "distance_mean"))
        tables[source] = nearest, pairs.clip(lower=FLOOR)
    axis = "distance, % of the diameter\nof the bounding sphere"
    grid = _ranked(tables, "median", axis, _box, _logarithmic)
    for words, tint in KINDS.values():
        grid[-1].barh([np.nan], [1], color=tint, alpha=0.45, label=words)
    figure = _with_legend(grid, tables, "median of the mean\nover all pairs", "of")
    nearest, _ = next(iter(tables.values()))
    praised = nearest.columns[nearest.columns.get_level_values("task").isin([FUSED, "leifman"])]
    figure.words["near"] = number(100 * (nearest[praised].stack([0, 1]) < FLOOR).mean())
    return figure


def _panels(truths: Collection[str], names: list[str], axis: str, size: tuple[float, float], font: float) -> np.ndarray:
    """Axes: a panel for each truth, one row per name."""
    _, (grid,) = plt.subplots(1, len(truths), figsize=size, squeeze=False, sharey=True, sharex=True)
    grid[0].set_yticks(range(len(names)), names, fontsize=font)
    grid[0].set_ylim(len(names) - 0.4, -0.6)
    for axes, source in zip(grid, truths, strict=True):
        axes.grid(axis="x")
        axes.tick_params(axis="y", length=0)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel(axis)
    return grid


def _ranked(
    tables: Tables, middle: str, axis: str, draw: Callable, finish: Callable[[Axes], object], zorder: float = 2
) -> np.ndarray:
    """Axes: a row a detector, in the order of the first truth that has it; diamonds: middles of its second scores."""
    order = pd.concat([table[detectors(table)].agg(middle) for table, _ in tables.values()])
    order = order[~order.index.duplicated()].sort_values(ascending=middle == "median", kind="stable")
    names = [Detector(*name) for name in order.index]
    size = (3.9 * len(tables) + 3.6, 1.0 + 0.26 * len(names))
    grid = _panels(tables, [name.text for name in names], axis, size, 8.5)
    for axes, (table, beside) in zip(grid, tables.values(), strict=True):
        axes.hlines(range(len(names)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        for y, name in enumerate(names):
            tint = KINDS[name.kind][1]
            if name in table:
                draw(axes, table[name], y, tint)
            if name in beside:
                axes.plot(beside[name].agg(middle), y, mec=tint, mew=1.1, zorder=zorder, **DIAMOND)
        finish(axes)
    return grid


def _with_legend(grid: np.ndarray, truths: Collection[str], diamond: str = "", joint: str = "with") -> Figure:
    if diamond:
        grid[-1].plot([], [], mec=INK, label=diamond, **DIAMOND)
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    drawing = grid[-1].figure
    drawing.tight_layout()
    return Figure(drawing, {"sources": f" and {joint} ".join(truths), "no_people": no_people(truths), "floor": FLOOR})


def _span(axes: Axes, values: pd.Series, y: float, color: str, lw: float, **mark: Any) -> None:
    """The mean of values as a mark, and its interval as a line."""
    mean, low, high = interval(values)
    axes.plot([low, high], [y, y], color=color, lw=lw, alpha=0.5)
    axes.plot(mean, y, color=color, **mark)


def _logarithmic(axes: Axes) -> None:
    axes.set(xscale="log", xlim=(FLOOR, None))
    plain_logarithm(axes.xaxis, (1.0,))


def _box(axes: Axes, values: pd.Series, y: int, tint: str) -> None:
    """Quartiles as a box, the median as a line in it, and 5 to 95 % as whiskers."""
    low, left, middle, right, high = np.maximum(values.quantile([0.05, 0.25, 0.5, 0.75, 0.95]), FLOOR)
    axes.plot([low, high], [y, y], color=tint, lw=0.9)
    axes.barh(y, right - left, 0.6, left, color=tint, alpha=0.45)
    axes.plot([middle] * 2, [y - 0.3, y + 0.3], color=INK, lw=1.3)


LOWER_QUARTILE, MEDIAN, UPPER_QUARTILE = "lower_quartile_below", "median_below", "upper_quartile_below"  # statistics


def below(results: Results, claim: Claim, share: float) -> pd.Series:
    """How many more of the first side's values than of the second's lie below a quantile of both, as a share by unit.

    It is above zero where the first side's own quantile is the lower one. Values at the quantile count half.
    """
    sides = (claim.first, claim.other), (claim.other, claim.first)
    side_values = pd.concat(
        [side(results, claim, selection, other) for selection, other in sides], axis=1, keys=["first", "second"]
    )
    side_values = side_values.dropna()
    if side_values.empty:
        return side_values["first"]
    edge = side_values.stack().quantile(share)  # pyright: ignore[reportAttributeAccessIssue]
    shares = (side_values < edge) + (side_values == edge) / 2
    return (shares["first"] - shares["second"]).groupby(level=list(range(len(claim.over))), sort=False).mean()


@statistic(LOWER_QUARTILE)
def lower_quartile_below(results: Results, claim: Claim) -> pd.Series:
    """The share of views below the 25th percentile of both."""
    return below(results, claim, 0.25)


@statistic(MEDIAN)
def median_below(results: Results, claim: Claim) -> pd.Series:
    """The share of views below the median of both."""
    return below(results, claim, 0.5)


@statistic(UPPER_QUARTILE)
def upper_quartile_below(results: Results, claim: Claim) -> pd.Series:
    """The share of views below the 75th percentile of both."""
    return below(results, claim, 0.75)

"""T figures 3.32, 3.35 and 3.36: how much tasks' maps and detectors agree with people, and how far centres lie."""

from collections.abc import Callable, Collection
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import GREY, INK, PALE, colours, label, plain_logarithm, plt

from .detectors import FUSED, KINDS, MODELS, TASKS, Detector, network_text, untrained
from .rows import detectors, networks, no_people, scores, sources

LINES = (*TASKS, FUSED)
SPREAD = 0.72  # of a row that its networks fill
FLOOR = 0.1  # %: a centre nearer than this is on the spot, and the axis begins there
Pair = tuple[pd.DataFrame, pd.DataFrame]
Draw = Callable[[Axes, pd.Series, int, str], None]  # (axes, values, y, colour)
DIAMOND: dict[str, Any] = {"marker": "D", "ls": "", "color": "white", "ms": 4.5}


def figure_3_32(results: Results) -> Figure:
    """Correlation of each task's map with people, a row a task, a colour a network."""
    found = sources(results)
    methods = sorted(dict.fromkeys(method for rows in found.values() for method in networks(rows)), key=untrained)
    bases = {method: method.rpartition("-")[0] for method in methods}
    paint = colours(list(dict.fromkeys(bases.values())))
    places = (np.arange(len(methods)) - (len(methods) - 1) / 2) * SPREAD / max(len(methods), 3)
    size = (4.0 * len(found) + 2.6, 1.2 + len(LINES) * max(0.42, 0.14 * len(methods)))
    names = [MODELS.get(task, label(task)) for task in LINES]
    figure, grid = _panels(found, names, "Pearson's correlation with people", size, 10)
    for axes, rows in zip(grid, found.values(), strict=True):
        table = scores(rows, "pcc")
        for (y, task), (down, method) in product(enumerate(LINES), zip(places, methods, strict=True)):
            if (method, task) in table:
                _span(axes, table[method, task], y + down, paint[bases[method]], 1.5, **_mark(method))
        _zero(axes)
        axes.axhline(len(TASKS) - 0.5, color=GREY, lw=0.6)
        axes.hlines(np.arange(len(TASKS) - 1) + 0.5, 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.5)
    for method in methods:
        grid[-1].plot([], [], color=paint[bases[method]], label=network_text(method), **_mark(method))
    _legend(figure, grid)
    return Figure(figure, {"sources": " and with ".join(found), "no_people": no_people(found)})


def figure_3_35(results: Results) -> Figure:
    """Correlation of detectors with people, best mean first."""
    found = sources(results)
    tables = [(scores(rows, "pcc"), scores(rows, "pcc_masked")) for rows in found.values()]
    figure, grid = _ranked(found, tables, "mean", "Pearson's correlation with people", _dot, _zero, zorder=1.9)
    for words, tint in KINDS.values():
        grid[-1].plot([], [], "o", color=tint, ms=5, label=words)
    _legend(figure, grid, "hidden vertices as zeros\n(the thesis's way)")
    return Figure(figure, {"sources": " and with ".join(found), "no_people": no_people(found)})


def figure_3_36(results: Results) -> Figure:
    """Distance between centres of fixation of detectors and of people, least median first."""
    found, views = sources(results, "distance"), ("item", "view")
    tables = [(scores(rows, "distance", views), scores(rows, "distance_mean", views)) for rows in found.values()]
    tables = [(nearest, pairs.clip(lower=FLOOR)) for nearest, pairs in tables]
    axis = "distance, % of the diameter\nof the bounding sphere"
    figure, grid = _ranked(found, tables, "median", axis, _box, _logarithmic)
    for words, tint in KINDS.values():
        grid[-1].barh([np.nan], [1], color=tint, alpha=0.45, label=words)
    _legend(figure, grid, "median of the mean\nover all pairs")
    return Figure(figure, {"sources": " and of ".join(found), "floor": FLOOR, "no_people": no_people(found)})


def _panels(
    found: Collection[str], names: list[str], axis: str, size: tuple[float, float], letters: float
) -> tuple[Drawing, np.ndarray]:
    """(figure, axes): a panel for each truth, one row per name."""
    figure, grid = plt.subplots(1, len(found), figsize=size, squeeze=False, sharey=True, sharex=True)
    grid[0, 0].set_yticks(range(len(names)), names, fontsize=letters)
    grid[0, 0].set_ylim(len(names) - 0.4, -0.6)
    for axes, source in zip(grid[0], found, strict=True):
        axes.grid(axis="x")
        axes.tick_params(axis="y", length=0)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel(axis)
    return figure, grid[0]


def _ranked(
    found: Collection[str], tables: list[Pair], middle: str, axis: str, draw: Draw, finish: Callable, zorder: float = 2
) -> tuple[Drawing, np.ndarray]:
    """(figure, axes): panels with a row a detector, in the order of the first truth that has it.

    tables: for each truth the scores that are drawn, and those whose middle, "mean" or "median", is a diamond. finish:
    draws what further is in a panel.
    """
    order = pd.concat([own[detectors(own)].agg(middle) for own, _ in tables])
    order = order[~order.index.duplicated()].sort_values(ascending=middle == "median", kind="stable")
    names = [Detector(*name) for name in order.index]
    size = (3.9 * len(found) + 3.6, 1.0 + 0.26 * len(names))
    figure, grid = _panels(found, [name.text for name in names], axis, size, 8.5)
    for axes, (own, beside) in zip(grid, tables, strict=True):
        axes.hlines(range(len(names)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        for y, name in enumerate(names):
            if name in own:
                draw(axes, own[name], y, name.tint)
            if name in beside:
                axes.plot(beside[name].agg(middle), y, mec=name.tint, mew=1.1, zorder=zorder, **DIAMOND)
        finish(axes)
    return figure, grid


def _legend(figure: Drawing, grid: np.ndarray, diamond: str = "") -> None:
    if diamond:
        grid[-1].plot([], [], mec=INK, label=diamond, **DIAMOND)
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    figure.tight_layout()


def _mark(method: str) -> dict[str, Any]:
    """How the mark of a method looks: hollow for random weights, square where every layer learned."""
    hollow = {"mfc": "white"} if untrained(method) else {}
    return {"marker": "s" if method.endswith("-finetuned") else "o", "ms": 5, "ls": "", **hollow}


def _span(axes: Axes, values: pd.Series, y: float, tint: str, width: float, **mark: Any) -> None:
    """The mean of values as a mark, and its interval as a line."""
    mean, low, high = interval(values)
    axes.plot([low, high], [y, y], color=tint, lw=width, alpha=0.5)
    axes.plot(mean, y, color=tint, **mark)


def _zero(axes: Axes) -> None:
    axes.axvline(0, color=INK, lw=0.8)


def _logarithmic(axes: Axes) -> None:
    axes.set(xscale="log", xlim=(FLOOR, None))
    plain_logarithm(axes.xaxis, (1.0,))


_dot = partial(_span, width=1.6, marker="o", ls="", ms=5, mec="white", mew=0.5)


def _box(axes: Axes, values: pd.Series, y: int, tint: str) -> None:
    """Quartiles as a box, the median as a line in it, and 5 to 95 % as whiskers."""
    low, left, middle, right, high = np.maximum(values.quantile([0.05, 0.25, 0.5, 0.75, 0.95]), FLOOR)
    axes.plot([low, high], [y, y], color=tint, lw=0.9)
    axes.barh(y, right - left, 0.6, left, color=tint, alpha=0.45)
    axes.plot([middle] * 2, [y - 0.3, y + 0.3], color=INK, lw=1.3)

"""Confusion matrices, in per cent of the true class."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .drawing import plt

DARK = 55  # per cent from which a number is written in white


def draw_matrices(
    frame: pd.DataFrame, rows: Mapping[Any, str], columns: Mapping[Any, str], down: list[str], across: str
) -> tuple[Figure, dict[str, Any]]:
    """(figure, its words count and classes): a grid of matrices of `value` items of `group` taken for `predicted`.

    rows, columns: {values of the columns `down`, or value of the column `across`: how they are said}.
    """
    classes = list(dict.fromkeys(frame["group"]))
    count, side = len(classes), 0.3 * len(classes) + 0.5
    size = (side * len(columns) + 1.4, side * len(rows) + 0.8)
    figure, grid = plt.subplots(len(rows), len(columns), figsize=size, squeeze=False)
    for panels, (key, words) in zip(grid, rows.items(), strict=True):
        matrices = frame[(frame[down] == key).all(axis=1)]
        for axes, value in zip(panels, columns, strict=True):
            _draw(axes, matrices[matrices[across] == value], classes)
        panels[0].set_yticks(range(count), [f"{name} {k}" for k, name in enumerate(classes, start=1)], fontsize=7.5)
        panels[0].set_ylabel(words, fontsize=9)
    for top, bottom, words in zip(grid[0], grid[-1], columns.values(), strict=True):
        top.set_title(words, pad=6)
        bottom.set_xticks(range(count), range(1, count + 1), fontsize=7.5)
    figure.subplots_adjust(wspace=0.06, hspace=0.08)
    return figure, {"count": count, "classes": ", ".join(classes)}


def _draw(axes: Axes, rows: pd.DataFrame, classes: list[str]) -> None:
    counts = rows.pivot_table(index="group", columns="predicted", values="value", aggfunc="sum", fill_value=0)
    counts = counts.reindex(index=classes, columns=classes, fill_value=0).to_numpy(dtype=float)
    shares = 100 * counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    axes.imshow(shares, cmap="Blues", vmin=0, vmax=100)
    for i, j in np.argwhere(shares >= 1):
        tint = "white" if shares[i, j] >= DARK else "black"
        axes.text(j, i, f"{shares[i, j]:.0f}", ha="center", va="center", fontsize=6.5, color=tint)
    axes.set(xticks=[], yticks=[])
    axes.tick_params(length=0)
    axes.spines[:].set(visible=True, linewidth=0.6)

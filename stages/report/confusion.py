"""Confusion matrices, in per cent of the true class."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

DARK = 55  # per cent from which a number is written in white


def draw_matrix(axes: Axes, rows: pd.DataFrame, classes: list[str]) -> None:
    """Draws one matrix in per cent of its rows. rows: `value` items of the class `group`, taken for `predicted`."""
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

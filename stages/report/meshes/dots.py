"""Methods as rows of dots: the mean over objects, with the interval of the paired difference from one of them."""

from collections.abc import Iterable, Sequence

import pandas as pd
from matplotlib.axes import Axes

from stages.kit.stats import interval
from stages.report.style import GREY, INK, METHOD_COLOURS, PALE

from .methods import OURS, PLAIN, short

HELD = {OURS: METHOD_COLOURS[OURS], PLAIN: GREY}  # colours of names


def draw_dots(
    axes: Axes,
    table: pd.DataFrame,
    methods: Sequence[str],
    tint: str,
    base: str | None = None,
    name: str = "",
    down: float = 0.0,
) -> None:
    """Draws the means of a frame objects x methods as dots, the first method on top.

    base: the method that the others are compared with: a line about each dot is the 95 % interval of the paired
    difference from it, and a dashed line its own mean; None: the line is the interval of the mean itself. down: how
    far below the middle of its row a dot is drawn, where a panel has several a row.
    """
    zero, middle = (table[base], table[base].mean()) if base else (0.0, 0.0)
    for y, method in enumerate(methods):
        mean, low, high = interval(table[method] - zero)
        axes.plot([middle + low, middle + high], [y + down] * 2, color=tint, lw=1.6, alpha=0.5)
        axes.plot(middle + mean, y + down, "o", color=tint, ms=4.2, mec="white", mew=0.5)
    if base:
        axes.axvline(middle, color=tint, lw=0.9, ls="--", zorder=0)
    if name:
        axes.plot([], [], "o", color=tint, ms=4, label=name)


def dress(panels: Sequence[Axes], titles: Iterable[str], methods: Sequence[str], pad: float = 6) -> None:
    """Titles above the panels of one row, names of the methods at the left, ours and plain QEM in their colours."""
    for axes, title in zip(panels, titles, strict=True):
        axes.set_title(title, fontsize=9.5, fontweight="normal", pad=pad)
        axes.grid(axis="x")
        axes.hlines(range(len(methods)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        axes.tick_params(axis="y", length=0)
        axes.tick_params(axis="x", labelsize=8)
        axes.spines["left"].set_visible(False)
    name_rows(panels[0], methods, [HELD.get(method, INK) for method in methods], 8.5)
    panels[0].get_figure().subplots_adjust(wspace=0.12)


def name_rows(axes: Axes, methods: Sequence[str], tints: Sequence[str], size: float) -> None:
    """Short names of the methods at the left of their rows, the first on top, each in its colour."""
    axes.set_yticks(range(len(methods)), [short(method) for method in methods], fontsize=size)
    axes.set_ylim(len(methods) - 0.4, -0.6)
    for text, tint in zip(axes.get_yticklabels(), tints, strict=True):
        text.set_color(tint)

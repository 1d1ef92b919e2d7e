"""The charts of accuracy against severity, one panel per perturbation and one for the legend, and their words."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from stages.report.markdown import number
from stages.report.style import GREY, label, plt

COLUMNS = 4


def panels(names: Sequence[str], words: str, width: float, height: float) -> tuple[Drawing, dict[str, Axes], Axes]:
    """(figure, {name: axes}, axes of the legend): words say what all panels measure."""
    down = -(-(len(names) + 1) // COLUMNS)
    figure, grid = plt.subplots(down, COLUMNS, figsize=(width, height * down), squeeze=False, sharey=True)
    for axes in grid[:, 0]:
        axes.set_ylabel(words)
    for axes in grid.flat[len(names) :]:
        axes.set_axis_off()
    return figure, dict(zip(names, grid.flat, strict=False)), grid.flat[len(names)]


def finish(axes: Axes, name: str, unit: str, severities: Sequence[float]) -> None:
    """Axes of a panel: no change on the left, then the severities at equal distances."""
    axes.set_xticks(range(len(severities) + 1), ["none", *(f"{one:g}" for one in severities)], fontsize=8)
    axes.set_ylim(0, 100)
    axes.set_xlabel(unit, fontsize=8)
    axes.set_title(label(name), fontsize=10)
    axes.grid(axis="y")


def draw_line(axes: Axes, values: np.ndarray, tint: str, mark: str) -> None:
    """Accuracies, low and high ends (severities + 1, 3) as a line with upright bars, which are cut to 0..100 %."""
    axes.plot(100 * values[:, 0], color=tint, marker=mark, ms=3.5, lw=1.4)
    for place, ends in enumerate(values[:, 1:]):
        axes.plot([place, place], 100 * np.clip(ends, 0, 1), color=tint, lw=0.9, alpha=0.4)


def add_legend(figure: Drawing, axes: Axes, lines: Mapping[str, Mapping[str, Any]]) -> None:
    """Explains lines, {words: matplotlib's properties}, and that of guessing, in the axes of the legend."""
    for words, style in {**lines, "guessing": {"ls": ":", "color": GREY, "lw": 1.2}}.items():
        axes.plot([], [], label=words, **style)
    axes.legend(loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)


def breaking_text(ends: Sequence[float], harshest: float, unharmed: float) -> str:
    """`0.2 [0.1, > 0.3]`: a breaking point, and those of the interval; NaN is beyond the harshest severity: `> 0.3`."""
    beyond = f"{'<' if harshest < unharmed else '>'} {harshest:g}"
    at, *interval = (beyond if np.isnan(one) else number(one, 2) for one in ends)
    return f"{at} [{', '.join(interval)}]" if {at, *interval} != {beyond} and interval else at

"""Breaking points: cells of tables, and panels of curves against severity, one for each disturbance."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from .drawing import GREY, label, plt
from .tables import number, records

ACROSS = 4
ENDS = ("breaking_point", "low", "high")
CLEAN, ACCURACY = ([name, f"{name}_low", f"{name}_high"] for name in ("clean", "accuracy"))
# {perturbation: {line: frame of severity, from mild to harsh, ACCURACY and CLEAN, of which intervals may be absent}}
Curves = dict[str, dict[tuple[str, ...], pd.DataFrame]]


def panels(names: Sequence[str], words: str, width: float, height: float) -> tuple[Drawing, dict[str, Axes], Axes]:
    """(figure, {name: axes}, axes of the legend): words say what all panels measure."""
    down = -(-(len(names) + 1) // ACROSS)
    figure, grid = plt.subplots(down, ACROSS, figsize=(width, height * down), squeeze=False, sharey=True)
    for axes in grid[:, 0]:
        axes.set_ylabel(words)
    for axes in grid.flat[len(names) :]:
        axes.set_axis_off()
    return figure, dict(zip(names, grid.flat, strict=False)), grid.flat[len(names)]


def finish(axes: Axes, name: str, unit: str, severities: Sequence[float]) -> None:
    """Axes of a panel: no change on the left, then the severities at equal distances."""
    axes.set_xticks(range(len(severities) + 1), ["none", *(f"{severity:g}" for severity in severities)], fontsize=8)
    axes.set_ylim(0, 100)
    axes.set_xlabel(unit, fontsize=8)
    axes.set_title(label(name), fontsize=10)
    axes.grid(axis="y")


def degradation(
    curves: Curves, units: Mapping[str, str], looks: Mapping[Any, Mapping[str, Any]], chance: float, height: float
) -> tuple[Drawing, dict[str, Axes]]:
    """(figure, {perturbation: axes}): accuracies against severity as lines with upright bars, cut to 0..100 %.

    units: {perturbation: words}; looks: {line: matplotlib's properties}, also of what else the legend explains.
    """
    figure, grid, legend = panels(list(curves), "accuracy, %", 10.2, height)
    for name, axes in grid.items():
        for line, points in curves[name].items():
            values = np.vstack([points.reindex(columns=CLEAN)[:1], points.reindex(columns=ACCURACY)])
            axes.plot(100 * values[:, 0], **looks[line], ms=3.5, lw=1.4)
            for place, ends in enumerate(values[:, 1:]):
                axes.plot([place, place], 100 * np.clip(ends, 0, 1), color=looks[line]["color"], lw=0.9, alpha=0.4)
        axes.axhline(100 * chance, color=GREY, lw=1.2, ls=":")
        finish(axes, name, units[name], list(max(curves[name].values(), key=len)["severity"]))
    for look in [*looks.values(), {"label": "guessing", "ls": ":", "color": GREY, "lw": 1.2}]:
        legend.plot([], [], **{"ms": 4, "lw": 1.4, **look})
    legend.legend(loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    return figure, grid


def cell(row: Any, unharmed: float) -> str:
    """A breaking point with its interval, `0.2 [0.1, > 0.3]`; alone where nothing broke, or where both ends are it."""
    beyond = f"{'<' if row.harshest < unharmed else '>'} {row.harshest:g}"
    point, *interval = (beyond if np.isnan(getattr(row, end)) else number(getattr(row, end), 2) for end in ENDS)
    return f"{point} [{', '.join(interval)}]" if {*interval} != {point} else point


def broken(frame: pd.DataFrame, heads: Iterable[str], unharmed: Mapping[str, float]) -> pd.DataFrame:
    """A line a perturbation for a reader, with the columns `heads`, one for each row of `frame`: `0.2 [0.1, > 0.3]`.

    frame: perturbation, unit, the harshest severity and those where it breaks, with the interval: the columns `ends`,
    where NaN is beyond the harshest: `> 0.3`. unharmed: {perturbation: severity without a change}.
    """
    lines = {}
    for head, row in zip(heads, records(frame), strict=True):
        line = lines.setdefault(row.perturbation, {"perturbation": label(row.perturbation), "unit": row.unit})
        line[head] = cell(row, unharmed[row.perturbation])
    return pd.DataFrame(list(lines.values())).fillna("–")

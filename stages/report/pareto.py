"""Accuracy against cost: one chart for every stage, with the Pareto front drawn."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import Locator, LogLocator, MaxNLocator
from numpy.typing import ArrayLike

from .items import Figure
from .names import place_names
from .style import INK, MARKERS, colours, plain_logarithm, plot_style, plt
from .style import label as spoken

LISTED = 8  # names of the front that a caption lists at most


def pareto_front(cost: ArrayLike, quality: ArrayLike, better: str = "high") -> np.ndarray:
    """(k,) boolean: the choices that no other beats, that is, none is as good in both and better in one.

    cost (k,) lower is better; quality (k,) higher is better, or lower with better="low" (errors). A choice with a NaN
    is never on the front; equal choices stand or fall together.
    """
    if better not in ("high", "low"):
        raise ValueError(f'better is "high" or "low", got {better!r}')
    cost, loss = np.asarray(cost, dtype=float), np.asarray(quality, dtype=float) * (-1 if better == "high" else 1)
    if cost.shape != loss.shape or cost.ndim != 1:
        raise ValueError(f"cost and quality must be lists of one length, got {cost.shape} and {loss.shape}")
    no_worse = (cost[None] <= cost[:, None]) & (loss[None] <= loss[:, None])
    one_better = (cost[None] < cost[:, None]) | (loss[None] < loss[:, None])
    return np.isfinite(cost) & np.isfinite(loss) & ~(no_worse & one_better).any(axis=1)


def pareto_chart(
    frame: pd.DataFrame,
    quality: str,
    *,
    title: str,
    reference: str,
    quality_label: str,
    cost: str = "seconds",
    label: str = "name",
    better: str = "high",
    colour: str | None = None,
    marker: str | None = None,
    tints: Mapping[str, str] | None = None,
) -> Figure:
    """Quality against cost with the Pareto front; its words are title, alt and caption.

    frame: one row a choice; cost: its column of seconds; quality: its column, with `low` and `high` beside it where
    there is an interval; label: its column of names. reference: the name whose cost, timed in the same run, is the
    unit of the logarithmic cost axis. colour, marker: columns that choose colour and shape, shown in a legend.
    tints: dict value -> colour of the column `colour`, where the charts beside it have such; the front then goes
    without names, which the legend gives. better: "high" for accuracies, "low" for errors. Raises ValueError when the
    reference is missing.
    """
    rows = frame.loc[np.isfinite(frame[cost]) & np.isfinite(frame[quality])].copy()
    unit = rows.loc[rows[label] == reference, cost]
    if len(unit) != 1 or not unit.iloc[0] > 0:
        raise ValueError(
            f"the reference {reference!r} must name one row with a cost above 0; rows: {list(rows[label])}"
        )
    rows["cost_ratio"] = rows[cost] / unit.iloc[0]
    rows["on_front"] = pareto_front(rows["cost_ratio"], rows[quality], better)
    with plot_style():
        drawing = _draw(rows, quality, label, title, reference, quality_label, better, colour, marker, tints)
    front = _listed(list(rows.loc[rows["on_front"]].sort_values("cost_ratio")[label]))
    words = {
        "title": title,
        "alt": f"{quality_label} against cost as a ratio to {reference}; the Pareto front is {front}.",
        "caption": f"{'Up' if better == 'high' else 'Down'} and left is better. Nothing beats the choices on the line: "
        f"{front}. Cost 1 is {reference}, {unit.iloc[0]:.3g} s in the median case of this run. Bars: 95 % intervals.",
    }
    return Figure(drawing, words, rows)


def _listed(names: list[str]) -> str:
    """The names of the front from the cheapest to the best; of a long front its ends."""
    return "; ".join(names) if len(names) <= LISTED else f"{len(names)} choices, from {names[0]} to {names[-1]}"


def _draw(
    rows: pd.DataFrame,
    quality: str,
    label: str,
    title: str,
    reference: str,
    quality_label: str,
    better: str,
    colour: str | None,
    marker: str | None,
    tints: Mapping[str, str] | None,
) -> Drawing:
    figure, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set_xscale("log")
    axes.grid(True)
    front = rows.loc[rows["on_front"]].sort_values("cost_ratio")
    axes.step(front["cost_ratio"], front[quality], where="post", color=INK, lw=1, zorder=1, label="Pareto front")
    paint = tints or (colours(list(dict.fromkeys(rows[colour]))) if colour else {})
    shape = dict(zip(dict.fromkeys(rows[marker]), MARKERS, strict=False)) if marker else {}
    for _, row in rows.iterrows():
        tint = paint[row[colour]] if colour else "#0072B2"
        if "low" in row and np.isfinite([row["low"], row["high"]]).all():
            axes.plot([row["cost_ratio"]] * 2, [row["low"], row["high"]], color=tint, lw=1.2, alpha=0.55, zorder=2)
        form = shape[row[marker]] if marker else "o"
        axes.plot(row["cost_ratio"], row[quality], form, color=tint, ms=7, mec="white", mew=0.8, zorder=3)
    axes.set_xlabel(f"cost, as a ratio to {reference}")
    axes.set_ylabel(quality_label)
    axes.set_title(title, pad=12)
    axes.margins(x=0.12, y=0.1)
    if better == "low":
        axes.set_ylim(bottom=0)
    for value, tint in paint.items():
        axes.plot([], [], "o", color=tint, ms=6, label=spoken(value))
    for value, form in shape.items():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=spoken(value))
    plain_logarithm(axes.xaxis)
    axes.xaxis.set_major_locator(ticks(rows["cost_ratio"].max() / rows["cost_ratio"].min()))
    if colour:
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=9)
    if not tints:
        place_names(axes, *_with_names(rows, front if colour else rows, front, quality, label, better))
    return figure


def ticks(span: float) -> Locator:
    """What finds the numbers of a logarithmic axis whose dearest choice costs `span` times the cheapest.

    The narrower it is, the closer they must be, or the axis would be almost without any.
    """
    if span < 3:
        return MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
    return LogLocator(subs=(1.0, 2.0, 5.0) if span < 100 else (1.0,))


def _with_names(
    rows: pd.DataFrame, named: pd.DataFrame, front: pd.DataFrame, quality: str, label: str, better: str
) -> tuple[list, np.ndarray, list]:
    """What place_names wants: names with their points, all points, and the lines, in the data's units."""
    # The front, the reference and the best come first: who comes late may find no room.
    first = named["on_front"] | (named["cost_ratio"] == 1)
    order = named.assign(first=first).sort_values(["first", quality], ascending=[False, better == "low"])
    names = [(row[label], (row["cost_ratio"], row[quality])) for _, row in order.iterrows()]
    lines = []
    if "low" in rows:
        known = rows.dropna(subset=["low", "high"])
        lines += [((row.cost_ratio, row.low), (row.cost_ratio, row.high)) for row in known.itertuples()]
    corners = list(zip(front["cost_ratio"], front[quality], strict=True))
    for (left, before), (right, after) in pairwise(corners):
        lines += [((left, before), (right, before)), ((right, before), (right, after))]
    return names, rows[["cost_ratio", quality]].to_numpy(), lines

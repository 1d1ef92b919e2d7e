"""Accuracy against cost: one chart for every stage, with the Pareto front drawn."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import Locator, LogLocator, MaxNLocator
from numpy.typing import ArrayLike

from .items import Figure
from .markdown import number
from .names import Spot, place_names
from .results import NotRun
from .style import CYCLE, INK, MARKERS, SETTINGS, colours, label, plain_logarithm, plt

WIDE = 76  # letters of a line of a title
LISTED = 8  # names of the front that a caption lists at most
FEW = 12  # choices that are all named where there is room; of more only the front, where legends tell the others


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
    better: str = "high",
    colour: str | None = None,
    marker: str | None = None,
    tints: Mapping[str, str] | None = None,
    legends: Mapping[str, str] | None = None,
) -> Figure:
    """Quality against cost with the Pareto front; its words are title, alt and caption.

    frame: one row a choice, with its `name`; cost: its column of seconds; quality: its column, with `low` and `high`
    beside it where there is an interval. reference: the name whose cost, timed in the same run, is the unit of the
    logarithmic cost axis. colour, marker: columns that choose colour and shape, each shown in a legend; legends: dict
    column -> its title, where the column's name is none. tints: dict value -> colour of the column `colour`, where the
    charts beside it have such; the front then goes without names, which the legend gives. better: "high" for
    accuracies, "low" for errors. NotRun where the reference was not measured.
    """
    rows = frame.loc[np.isfinite(frame[cost]) & np.isfinite(frame[quality])].copy()
    unit = rows.loc[rows["name"] == reference, cost]
    if len(unit) != 1 or not unit.iloc[0] > 0:
        raise NotRun(f"the reference {reference} is not measured", "report", runnable=False)
    rows["cost_ratio"] = rows[cost] / unit.iloc[0]
    rows["on_front"] = pareto_front(rows["cost_ratio"], rows[quality], better)
    front = rows.loc[rows["on_front"]].sort_values("cost_ratio")
    with plt.rc_context(SETTINGS):
        drawing, axes = plt.subplots(figsize=(7.2, 4.6))
        axes.set(xscale="log", xlabel=f"cost, as a ratio to {reference}", ylabel=quality_label)
        axes.set_title(title if tints else fill(f"{title}. {_finding(front, quality)}", WIDE), pad=12)
        axes.grid(True)
        axes.step(front["cost_ratio"], front[quality], where="post", color=INK, lw=1, zorder=1, label="Pareto front")
        _draw(axes, rows, quality, colour, marker, tints)
        axes.margins(x=0.12, y=0.1)
        if better == "low":
            axes.set_ylim(bottom=0)
        plain_logarithm(axes.xaxis)
        axes.xaxis.set_major_locator(ticks(rows["cost_ratio"].max() / rows["cost_ratio"].min()))
        if colour:
            _legend(axes, [(legends or {}).get(column, column) for column in (colour, marker) if column])
        if not tints:
            named = _names(front if colour and marker and len(rows) > FEW else rows, quality, better)
            place_names(axes, named, rows[["cost_ratio", quality]].to_numpy(), _lines(rows, front, quality))
    names = list(front["name"])  # from the cheapest to the best; of a long front its ends
    said = "; ".join(names) if len(names) <= LISTED else f"{len(names)} choices, from {names[0]} to {names[-1]}"
    words = {
        "title": title,
        "alt": f"{quality_label} against cost as a ratio to {reference}; the Pareto front is {said}.",
        "caption": f"{'Up' if better == 'high' else 'Down'} and left is better. Nothing beats the choices on the line: "
        f"{said}. Cost 1 is {reference}, {unit.iloc[0]:.3g} s in the median case of this run. Bars: 95 % intervals.",
    }
    return Figure(drawing, words, rows)


def _draw(
    axes: Axes,
    rows: pd.DataFrame,
    quality: str,
    colour: str | None,
    marker: str | None,
    tints: Mapping[str, str] | None,
) -> None:
    """The choices with their intervals, pale off the front, each with its name for those who hover it."""
    paint = tints or (colours(list(dict.fromkeys(rows[colour]))) if colour else {})
    shape = dict(zip(dict.fromkeys(rows[marker]), MARKERS, strict=False)) if marker else {}
    for _, row in rows.iterrows():
        tint, form = paint[row[colour]] if colour else CYCLE[0], shape[row[marker]] if marker else "o"
        if "low" in row and np.isfinite([row["low"], row["high"]]).all():
            axes.plot([row["cost_ratio"]] * 2, [row["low"], row["high"]], color=tint, lw=1.2, zorder=2,
                      alpha=0.7 if row["on_front"] else 0.2)  # fmt: skip
        axes.plot(row["cost_ratio"], row[quality], form, color=tint, ms=7, mec="white", mew=0.8, zorder=3,
                  label=f"_{row['name']}")  # fmt: skip
    for column, entries in ((colour, paint), (marker, shape)):
        if column:
            axes.plot([], [], marker=" ", ls="none", label=column)  # the place of a title among the entries
        for value, look in entries.items():
            tint, form = (look, "o") if column == colour else ("none", look)
            axes.plot([], [], form, color=tint, mec=tint if column == colour else INK, ms=6, label=label(value))


def _legend(axes: Axes, titles: Sequence[str]) -> None:
    """What colours and shapes mean, each kind under its title."""
    handles, names = axes.get_legend_handles_labels()
    kinds = [k for k, handle in enumerate(handles) if isinstance(handle, Line2D) and handle.get_marker() == " "]
    for k, title in zip(kinds, titles, strict=True):
        names[k] = title
    legend = axes.legend(handles, names, loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=9)
    for k in kinds:
        legend.get_texts()[k].set_fontweight("bold")


def _finding(front: pd.DataFrame, quality: str) -> str:
    """What is best, and what costs least of all that its interval holds; front: from the cheapest to the best."""
    best = front.iloc[-1]
    said = f"Best: {best['name']} ({number(best[quality])})"
    if "low" not in front or len(front) < 2:
        return said
    near = front[:-1][front[quality][:-1].between(best["low"], best["high"])]
    if near.empty:
        return said
    share = near.iloc[0]["cost_ratio"] / best["cost_ratio"]
    return f"{said}. In its interval, at {number(100 * share, 2)} % of its cost: {near.iloc[0]['name']}"


def ticks(span: float) -> Locator:
    """What finds the numbers of a logarithmic axis whose dearest choice costs `span` times the cheapest.

    The narrower it is, the closer they must be, or the axis would be almost without any.
    """
    if span < 3:
        return MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
    return LogLocator(subs=(1.0, 2.0, 5.0) if span < 100 else (1.0,))


def _names(rows: pd.DataFrame, quality: str, better: str) -> list[tuple[str, Spot]]:
    """Names with their points: the front, the reference and the best come first, since the last may find no room."""
    first = rows["on_front"] | (rows["cost_ratio"] == 1)
    order = rows.assign(first=first).sort_values(["first", quality], ascending=[False, better == "low"])
    return list(zip(order["name"], zip(order["cost_ratio"], order[quality], strict=True), strict=True))


def _lines(rows: pd.DataFrame, front: pd.DataFrame, quality: str) -> list[tuple[Spot, Spot]]:
    """The two ends of each drawn line: the intervals, and the steps of the front."""
    known = rows.dropna(subset=["low", "high"]) if "low" in rows else rows[:0]
    bars = [((row["cost_ratio"], row["low"]), (row["cost_ratio"], row["high"])) for _, row in known.iterrows()]
    across, up = front[["cost_ratio", quality]].to_numpy().repeat(2, axis=0).T
    return [*bars, *pairwise(zip(across[1:], up[:-1], strict=True))]

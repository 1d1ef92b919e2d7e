"""Pareto charts of quality against cost for every stage, and the cost of looking.

`placed` counts the resamples of cost and quality that leave a choice on the front; `pareto_chart` draws the front.
`attention_seconds` sums the cost of an object's salient points, from the picture to the points.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import Locator, LogLocator, MaxNLocator
from numpy.typing import ArrayLike

from haptic_glance.base.timing import CLOCK, WALL
from haptic_glance.look.points.methods import is_method, method_named
from stages.charts.results import NotRun, Results

from .drawing import CYCLE, INK, MARKERS, SETTINGS, Spot, colours, label, place_names, plain_logarithm, plt
from .items import Figure
from .tables import number

ON, PERHAPS, OFF = "yes", "perhaps", "no"  # of a choice: whether it is on the front
CERTAIN, RESAMPLES, NORMAL = 0.95, 1000, 1.96
# Deviation of the logarithm of a cost from run to run: of wall time, whose ratios between two runs of one commit lie
# within 0.41 to 2.57 for 166 choices; and of processor time of the same work in other processes of a busy machine.
NOISE = {WALL: 0.25, CLOCK: 0.05}
CERTAINLY = "on the front in 95 % of resamples"
ALPHA = {ON: 0.8, PERHAPS: 0.6, OFF: 0.4}  # of intervals
RIMS = {name: {"mec": INK if name == ON else "white", "mew": 1.2 if name == ON else 0.8} for name in ALPHA}
WIDE = 76  # letters of a line of a title
LISTED = 8  # names of the front that a text for the blind lists at most
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


def placed(
    rows: pd.DataFrame,
    cost: str,
    quality: str,
    better: str = "high",
    noise: float | np.ndarray = NOISE[WALL],
    units: pd.DataFrame | None = None,
) -> pd.DataFrame:
    """The rows, a choice each, with `front_share`: in how many of the resamples no other beats it; and `on_front`.

    on_front: ON in 95 % of the resamples or more, OFF in 5 % or less, else PERHAPS. noise: the deviation of the
    logarithm of a cost from run to run, one or (k,). units (u, k): the values behind the qualities, a column for each
    `name`; units are then drawn for all choices together. The qualities vary as much as `low` to `high` say.
    """
    draw, qualities = np.random.default_rng(0), rows[quality].to_numpy(float)
    costs = rows[cost].to_numpy(float) * np.exp(noise * draw.standard_normal((RESAMPLES, len(rows))))
    if units is None:
        deviations = draw.standard_normal(costs.shape)
    else:
        values = units.reindex(columns=rows["name"]).to_numpy(float)
        values = np.nan_to_num(values - np.nanmean(values, axis=0))
        deviations = values[draw.integers(len(values), size=(RESAMPLES, len(values)))].mean(axis=1)
        deviations /= np.maximum(deviations.std(axis=0), np.finfo(float).tiny)
    spread = np.ptp(rows.reindex(columns=["low", "high"]).to_numpy(float), axis=1) / (2 * NORMAL)
    resampled = qualities + deviations * np.nan_to_num(spread)
    share = np.mean([pareto_front(*pair, better) for pair in zip(costs, resampled, strict=True)], axis=0)
    words = np.select([share >= CERTAIN, share > 1 - CERTAIN], [ON, PERHAPS], OFF)
    return rows.assign(front_share=share, on_front=words)


def pareto_chart(
    frame: pd.DataFrame,
    quality: str,
    *,
    title: str,
    reference: str,
    quality_label: str,
    cost: str = "seconds",
    clock: str = WALL,
    units: pd.DataFrame | None = None,
    better: str = "high",
    colour: str | None = None,
    marker: str | None = None,
    tints: Mapping[str, str] | None = None,
    legends: Mapping[str, str] | None = None,
) -> Figure:
    """Quality against cost with the Pareto front; its words are title, alt and caption.

    frame: one row a choice, with its `name`; cost: its column, of seconds unless clock is empty; quality: its column,
    with `low` and `high` beside it where there is an interval. reference: the name whose cost, timed in the same run,
    is the unit of the logarithmic cost axis. clock: as `Results.clock` says it, empty for a cost that is counted.
    units: as of `placed`; a column `noise` stands for that of the clock. colour, marker: columns that choose colour and
    shape, each shown in a legend; legends: dict column -> its title, where the column's name is none. tints: dict value
    -> colour of the column `colour`, where the charts beside it have such; the front then goes without names, which the
    legend gives. better: "high" for accuracies, "low" for errors. NotRun where the reference was not measured.
    """
    rows = frame.loc[np.isfinite(frame[cost]) & np.isfinite(frame[quality])].copy()
    base = rows.loc[rows["name"] == reference, cost]
    if len(base) != 1 or not base.iloc[0] > 0:
        raise NotRun(f"the reference {reference} is not measured", "report", runnable=False)
    unit = float(base.iloc[0])
    rows["cost_ratio"] = rows[cost] / unit
    noise = rows["noise"].to_numpy() if "noise" in rows else noise_by(clock)
    rows = placed(rows, "cost_ratio", quality, better, noise, units)
    front = rows.loc[pareto_front(rows["cost_ratio"], rows[quality], better)].sort_values("cost_ratio")
    certain = rows.loc[rows["on_front"] == ON].sort_values("cost_ratio")
    with plt.rc_context(SETTINGS):
        drawing, axes = plt.subplots(figsize=(7.2, 4.6))
        axes.set(xscale="log", xlabel=f"cost, as a ratio to {reference}", ylabel=quality_label)
        axes.set_title(title if tints else fill(f"{title}. {_finding(front, quality)}", WIDE), pad=12)
        axes.grid(True)
        if len(certain):
            axes.step(certain["cost_ratio"], certain[quality], where="post", color=INK, lw=1, zorder=1, label=CERTAINLY)
        _draw(axes, rows, quality, colour, marker, tints)
        axes.margins(x=0.12, y=0.1)
        if better == "low":
            axes.set_ylim(bottom=0)
        plain_logarithm(axes.xaxis)
        above = axes.secondary_xaxis(
            "top", functions=(lambda ratio: np.multiply(ratio, unit), lambda value: np.divide(value, unit))
        )
        cost_name = (legends or {}).get(cost, cost)
        above.set_xlabel(f"seconds, {clock}" if clock else cost_name, fontsize=9)
        plain_logarithm(above.xaxis)
        for axis in (axes.xaxis, above.xaxis):
            axis.set_major_locator(ticks(rows["cost_ratio"].max() / rows["cost_ratio"].min()))
        if colour:
            _legend(axes, [(legends or {}).get(column, column) for column in (colour, marker) if column])
        if not tints:
            point_names = _names(front if colour and marker and len(rows) > FEW else rows, quality, better)
            place_names(
                axes, point_names, rows[["cost_ratio", quality]].to_numpy(), lines(rows, certain, "cost_ratio", quality)
            )
    names = _listed(certain)
    first = f"{unit:.3g} s in the median case ({clock})" if clock else f"{unit:,.0f} {cost_name}"
    words = {
        "title": title,
        "alt": f"{quality_label} against cost as a ratio to {reference}; the Pareto front is {names}.",
        "caption": f"{'Up' if better == 'high' else 'Down'} and left is better. Line: choices that no other beats in "
        f"95 % of the resamples. Cost 1 is {reference}, {first}. Bars: 95 % intervals.",
    }
    return Figure(drawing, words, rows)


def noise_by(clock: str) -> float:
    """The NOISE of a clock as `Results.clock` says it; 0 without one."""
    return next((noise for name, noise in NOISE.items() if clock.startswith(name)), 0.0)


def _listed(rows: pd.DataFrame) -> str:
    """The names of choices, from the cheapest to the dearest; of many the ends."""
    names = list(rows["name"])
    return "; ".join(names) or "none" if len(names) <= LISTED else f"{len(names)}, from {names[0]} to {names[-1]}"


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
                      alpha=ALPHA[row["on_front"]])  # fmt: skip
        axes.plot(row["cost_ratio"], row[quality], form, color=tint, ms=7, zorder=3, **RIMS[row["on_front"]],
                  label=f"_{row['name']}")  # fmt: skip
    for column, entries in ((colour, paint), (marker, shape)):
        if column:
            axes.plot([], [], marker=" ", ls="none", label=column)  # the place of a title among the entries
        for value, look in entries.items():
            tint, form = (look, "o") if column == colour else ("none", look)
            axes.plot([], [], form, color=tint, mec=tint if column == colour else INK, ms=6, label=label(value))


def _legend(axes: Axes, titles: Sequence[str]) -> None:
    """Explains colours and shapes, each kind under its title."""
    handles, names = axes.get_legend_handles_labels()
    kinds = [k for k, handle in enumerate(handles) if isinstance(handle, Line2D) and handle.get_marker() == " "]
    for k, title in zip(kinds, titles, strict=True):
        names[k] = title
    legend = axes.legend(handles, names, loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=9)
    for k in kinds:
        legend.get_texts()[k].set_fontweight("bold")


def _finding(front: pd.DataFrame, quality: str) -> str:
    """The best choice, and the cheapest within its interval; front: from the cheapest to the best."""
    best = front.iloc[-1]
    text = f"Best: {best['name']}" + (f" ({number(best[quality])})" if best[quality] else "")
    if "low" not in front or len(front) < 2:
        return text
    near = front[:-1][front[quality][:-1].between(best["low"], best["high"])]
    if near.empty:
        return text
    share = near.iloc[0]["cost_ratio"] / best["cost_ratio"]
    return f"{text}. In its interval, at {number(100 * share, 2)} % of its cost: {near.iloc[0]['name']}"


def ticks(span: float) -> Locator:
    """The locator of numbers on a logarithmic axis whose dearest choice costs `span` times the cheapest.

    The narrower it is, the closer they must be, or the axis would be almost without any.
    """
    if span < 3:
        return MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
    return LogLocator(subs=(1.0, 2.0, 5.0) if span < 100 else (1.0,))


def _names(rows: pd.DataFrame, quality: str, better: str) -> list[tuple[str, Spot]]:
    """Names with their points: the front, the reference and the best come first, since the last may find no room."""
    first = (rows["on_front"] == ON) | (rows["cost_ratio"] == 1)
    order = rows.assign(first=first).sort_values(["first", quality], ascending=[False, better == "low"])
    return list(zip(order["name"], zip(order["cost_ratio"], order[quality], strict=True), strict=True))


def lines(rows: pd.DataFrame, front: pd.DataFrame, cost: str, quality: str) -> list[tuple[Spot, Spot]]:
    """The two ends of each drawn line, for `place_names`: the intervals, and the steps of the front."""
    bounded = rows.dropna(subset=["low", "high"]) if "low" in rows else rows[:0]
    bars = [((row[cost], row["low"]), (row[cost], row["high"])) for _, row in bounded.iterrows()]
    across, up = front[[cost, quality]].to_numpy().repeat(2, axis=0).T
    return [*bars, *pairwise(zip(across[1:], up[:-1], strict=True))]


def attention_seconds(results: Results, dataset: str | None = None) -> dict[str, float]:
    """dict method -> seconds of the median object of a set: all views, the maps of its channels, and the points."""
    stages = ("salient_points", "conspicuity", "views")
    points, channels, views = (results.rows(stage, dataset).dropna(subset=["seconds"]) for stage in stages)
    points = points.drop_duplicates(["item", "method", "seconds"]).groupby("method")["seconds"].median()
    channels = channels.groupby(["item", "method"])["seconds"].sum().groupby("method").median()
    views = views[views["metric"] == "coverage"].groupby("item")["seconds"].sum().median()
    return {str(method): seconds + _maps(str(method), views, channels) for method, seconds in points.items()}


def _maps(method: str, views: float, channels: pd.Series) -> float:
    """Seconds of the pictures and maps that a method reads; 0 for one that reads none (blind touch)."""
    own_channels = method_named(method).channels if is_method(method) else ()
    missing = [name for name in own_channels if name not in channels]
    if missing:
        raise NotRun(f"no seconds of the channels {', '.join(missing)}", "conspicuity")
    return views + sum(channels[name] for name in own_channels) if own_channels else 0.0

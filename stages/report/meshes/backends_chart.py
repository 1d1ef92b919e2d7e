"""Who simplifies: error against time as ratios to pymeshlab's QEM, and how the time grows with the mesh."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from stages.report.items import Figure
from stages.report.names import Spot, place_names
from stages.report.pareto import ON, noise_of, placed
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, colours, label, plain_logarithm, plt

from .backends import REFERENCE, common, summarised, tried
from .growth import FITTED, Growth, growth

ERRORS = {"error": ("Metro mean", "time and distance"), "seen": ("1 − SSIM", "time and error as seen")}
KEPT = {False: ("o", "nothing kept"), True: ("D", "points kept")}


def build(results: Results) -> Figure:
    """Two panels of error against time, as ratios, and one of seconds against the faces of the mesh."""
    rows = tried(results)
    frame, paired = summarised(rows), common(rows)
    tints = colours(list(dict.fromkeys(frame["backend"])))
    if REFERENCE not in tints or len(tints) < 2:
        raise NotRun(f"no backend beside {REFERENCE} was timed", "lod", runnable=False)
    drawing, panels = plt.subplots(1, 3, figsize=(13.2, 4.4), gridspec_kw={"wspace": 0.27})
    for axes, (kind, (name, title)) in zip(panels, ERRORS.items(), strict=False):
        frame[f"{kind}_front"] = False
        for _, group in frame.groupby("with_points"):  # the task without points to keep is another than the one with
            parts = {part: np.log(group[f"{kind}_{part}"]) for part in ("ratio", "low", "high")}
            own = group.assign(name=group["backend"], **parts)
            found = placed(own, "time_ratio", "ratio", "low", noise_of(group["time_low"], group["time_high"]))
            frame.loc[group.index, f"{kind}_front"] = found["on_front"] == ON
        _against(axes, frame, kind, tints)
        axes.set(ylabel=f"{name}, ratio to {REFERENCE}", title=title)
    fits = {name: growth(paired[paired["backend"] == name]) for name in dict.fromkeys(rows["backend"])}
    _growing(panels[2], paired, fits, tints)
    powers = "; ".join(f"{label(name)} {fit.said}" for name, fit in fits.items() if fit)
    words = {
        "reference": REFERENCE, "backends": ", ".join(map(label, tints)), "fitted": FITTED,
        "powers": f"p = 1 is n log n: {powers}." if powers else "",
    }  # fmt: skip
    return Figure(drawing, words, frame, dpi=95)


def _against(axes: Axes, frame: pd.DataFrame, kind: str, tints: dict[str, str]) -> None:
    """One error against time, as ratios. kind: the first part of the columns' names."""
    parts = {f"{kind}_{part}": part for part in ("ratio", "low", "high", "front")}
    known = frame.rename(columns=parts).dropna(subset=["ratio"])
    for with_points, group in known[known["front"]].sort_values("time_ratio").groupby("with_points"):
        style = "-" if with_points else ":"
        axes.step(group["time_ratio"], group["ratio"], where="post", color=INK, lw=1, ls=style, zorder=1)
    ends = [pair for row in known.itertuples() for pair in _mark(axes, row, tints)]
    for form, name in KEPT.values():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=name)
    axes.set(xscale="log", yscale="log", xlabel=f"seconds, ratio to {REFERENCE}")
    axes.axhline(1, color=GREY, lw=0.7, ls="--", zorder=0)
    axes.grid(True)
    axes.margins(x=0.16, y=0.2)
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithm(axis)
    axes.legend(loc="upper right", fontsize=8)
    first = known.drop_duplicates("backend")
    names = zip(first["backend"].map(label), zip(first["time_ratio"], first["ratio"], strict=True), strict=True)
    points = np.concatenate([known[["time_ratio", "ratio"]], known[["whole_ratio", "ratio"]].dropna()])
    place_names(axes, names, points, ends)


def _mark(axes: Axes, row: Any, tints: dict[str, str]) -> Iterator[list[Spot]]:
    """Draws a backend's point with its intervals, hollow for all of simplify; the ends of those that are known."""
    form, tint = KEPT[row.with_points][0], tints[row.backend]
    across = [(row.time_low, row.ratio), (row.time_high, row.ratio)]
    for pair in (across, [(row.time_ratio, row.low), (row.time_ratio, row.high)]):
        axes.plot(*zip(*pair, strict=True), color=tint, lw=1.2, alpha=0.55)
        if np.isfinite(pair).all():
            yield pair
    axes.plot(row.time_ratio, row.ratio, form, color=tint, ms=7, mec="white", mew=0.8, zorder=3)
    if row.backend != REFERENCE:
        axes.plot(row.whole_ratio, row.ratio, form, color=tint, mfc="none", ms=7, mew=1.1, zorder=2)


def _growing(axes: Axes, rows: pd.DataFrame, fits: dict[str, Growth | None], tints: dict[str, str]) -> None:
    """Seconds against faces, a dot a cell, with the fits and the intervals of their powers."""
    for backend, tint in tints.items():
        here, fit, power = rows[rows["backend"] == backend], fits[backend], ""
        axes.plot(here["full"], here["seconds"], ".", color=tint, ms=4, alpha=0.4, mew=0)
        if fit:
            n, power = np.geomspace(*fit.span, 30), f", p = {fit.said}"
            axes.plot(n, fit(n), color=tint, lw=1.4)
            axes.fill_between(n, *np.sort([fit(n, fit.low), fit(n, fit.high)], axis=0), color=tint, alpha=0.15, lw=0)
            axes.plot(n, fit(n, 1.0), color=INK, lw=0.9, ls="--")
        axes.plot([], [], "o", color=tint, ms=5, label=label(backend) + power)
    axes.plot([], [], color=INK, lw=0.9, ls="--", label="n log n")
    axes.set(xscale="log", yscale="log", xlabel="faces of the mesh, n", ylabel="seconds", title="growth with the mesh")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(lambda value, _: f"{value:,g}" if value < 1e6 else f"{value / 1e6:g} M")
        axis.set_minor_formatter(NullFormatter())
    axes.grid(True)
    where = {"loc": "center left", "bbox_to_anchor": (1.02, 0.5), "fontsize": 8}
    axes.legend(**where, title="power of the growth p [95 %]", title_fontsize=8, alignment="left")

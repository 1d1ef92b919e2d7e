"""Backends of simplification, as table and chart: time and error as ratios to pymeshlab's QEM, of one `make bench`.

`growth` fits a backend's time by a power of n, or of n log n, with its interval.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from stages.charts.drawing import GREY, INK, Spot, colours, label, place_names, plain_logarithm, plt
from stages.charts.items import Figure, Table, shared_notes
from stages.charts.pareto import ON, noise_of, placed
from stages.charts.results import NotRun, Results
from stages.charts.tables import interval_columns, percent, with_interval
from stages.engine.statistics import interval

REFERENCE, OURS = "pymeshlab", "fast"
CELL, TASK = ["mesh", "full", "target", "with_points"], ["backend", "with_points"]
RATIOS = {  # first part of a column's name -> title
    "time": "time ratio", "whole": "all of simplify", "colours": "with colours",
    "error": "Metro ratio", "largest": "largest-error ratio", "seen": "1 − SSIM ratio",
}  # fmt: skip
GROWTHS = {"linear": "n^p", "loglinear": "(n log n)^p"}
ANSWER = ["backend", "points kept", *(RATIOS[name] for name in ("time", "error", "largest", "seen")), "valid"]


FITTED = 10_000  # faces from which the growth is fitted: below, the fixed cost of a call counts
POWERS: dict[str, Callable] = {"linear": lambda n: n, "loglinear": lambda n: n * np.log(n)}


@dataclass(frozen=True)
class Growth:
    """seconds = level * (shape(n) / shape(middle))^power, with the 95 % interval of the power; shape: of POWERS."""

    shape: str
    level: float
    middle: float
    power: float
    low: float
    high: float
    span: tuple[float, float]

    def __call__(self, n: np.ndarray, power: float | None = None) -> np.ndarray:
        """Seconds at n faces; power: another than the fitted, through the same middle."""
        shape = POWERS[self.shape]
        return self.level * (shape(n) / shape(self.middle)) ** (self.power if power is None else power)

    @property
    def text(self) -> str:
        """`1.04 [0.90, 1.11]`: the power with its interval."""
        return with_interval(self.power, self.low, self.high, places=2)


def growth(rows: pd.DataFrame, shape: str = "loglinear") -> Growth | None:
    """The Growth of the column `seconds` over `full`, or None for fewer than three sizes of FITTED faces or more.

    rows: of one backend. A least-squares line through the logarithms, with a level of its own for each share of the
    faces and for kept points. The interval is a bootstrap over the meshes: a subdivided one goes with what it was.
    """
    rows = rows[(rows["full"] >= FITTED) & (rows["seconds"] > 0)]
    if rows["full"].nunique() < 3:
        return None
    n = rows["full"].to_numpy(dtype=float)
    x, y = np.log(POWERS[shape](n)), np.log(rows["seconds"].to_numpy(dtype=float))
    level = pd.factorize(pd.MultiIndex.from_arrays([(rows["target"] / n).round(2), rows["with_points"]]))[0]
    mesh, names = pd.factorize(rows["mesh"])
    random = np.random.default_rng(0)
    picks = (random.multinomial(len(names), np.full(len(names), 1 / len(names))) for _ in range(1000))
    low, high = np.nanquantile([_slope(x, y, level, times[mesh]) for times in picks], [0.025, 0.975])
    power, middle = _slope(x, y, level, np.ones(len(x))), np.exp(np.log(n).mean())
    offset = (y - power * (x - np.log(POWERS[shape](middle)))).mean()
    return Growth(shape, np.exp(offset), middle, power, low, high, (n.min(), n.max()))


def _slope(x: np.ndarray, y: np.ndarray, level: np.ndarray, weight: np.ndarray) -> float:
    """Weighted least-squares slope with an intercept for each level; NaN where no level has two places."""
    total = np.maximum(np.bincount(level, weight), 1e-9)
    x, y = (values - (np.bincount(level, weight * values) / total)[level] for values in (x, y))
    spread = (weight * x * x).sum()
    return (weight * x * y).sum() / spread if spread > 1e-12 else np.nan


def backends_table(results: Results) -> Table:
    """A row a backend, without and with points to keep."""
    rows = tried(results)
    frame = summarised(rows, fitted=True)
    cells = rows.drop_duplicates(CELL)
    sources, kept = rows.groupby("source", sort=False)["mesh"].nunique(), cells.loc[cells["with_points"], "kept_points"]
    lines = [_sentence(row) for row in frame[frame["backend"] == OURS].itertuples() if row.cells]
    words = {
        "measured": shared_notes(__package__, "timed"),
        "findings": "\n".join([*lines, *against_meshoptimizer(rows)]),
        "sources": ", ".join(f"{count} {source}" for source, count in sources.items()),
        "least": rows["full"].min(), "most": rows["full"].max(), "cells": len(cells), "with_points": len(kept),
        "kept": f"{kept.min()} to {kept.max()}" if len(kept) else "no",
        "infeasible": (cells["outcome"] == "infeasible").sum(), "fitted": FITTED,
    }  # fmt: skip
    # no ranking: time stands against error, as the chart of the same name shows
    return Table(frame, _wide(frame), words, answer=ANSWER)


def tried(results: Results) -> pd.DataFrame:
    """The rows of bench/simplification.csv.gz, with with_points and RATIOS' columns; NotRun without outcomes."""
    rows = results.bench("simplification").rename(columns={"ratio": "time_ratio"})
    if "outcome" not in rows:
        raise NotRun("bench/simplification.csv.gz has no outcomes: `make bench` writes it anew", "lod", runnable=False)
    rows = rows.assign(with_points=rows["kept_points"] > 0)
    rows["base"] = rows["ssim_error"].where((rows["backend"] == REFERENCE) & (rows["ssim_error"] > 0))
    return rows.assign(seen_ratio=rows["ssim_error"] / rows.groupby(CELL)["base"].transform("first"))


def common(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows of the cells that all backends of their task (with points, or without) reached."""
    reached_rows = rows[rows["outcome"] == "reached"]
    total = rows.groupby("with_points")["backend"].nunique()
    count = reached_rows.groupby(CELL)["backend"].transform("nunique")
    return reached_rows[count == reached_rows["with_points"].map(total)]


def summarised(rows: pd.DataFrame, fitted: bool = False) -> pd.DataFrame:
    """A row a backend, without and with points to keep: refusals, ratios of time and errors; fitted: and growth."""
    paired, lines = common(rows), []
    for key, group in rows.groupby(TASK, sort=False):
        cells, outcomes = paired[(paired[TASK] == key).all(axis=1)], group["outcome"].value_counts()
        line = dict(zip(TASK, key, strict=True)) | {"meshes": cells["mesh"].nunique(), "cells": len(cells)}
        line |= {"tried": len(group) - outcomes.get("infeasible", 0)}
        line |= {name: outcomes.get(name, 0) for name in ("refused", "missed")}
        for name in RATIOS:
            ratios = over_meshes(cells.set_index("mesh")[f"{name}_ratio"])
            line |= interval_columns(f"{name}_ratio", ratios, prefix=f"{name}_")
        line |= {"slowest": cells["time_ratio"].max(), "seconds": cells["seconds"].median()}
        reached_rows = group[group["outcome"] == "reached"]
        line |= {name: reached_rows[name].dropna().astype(bool).mean() for name in ("kept", "valid")}
        for shape in GROWTHS if fitted else ():
            fit = growth(cells, shape)
            line |= {f"{shape}_{name}": getattr(fit, name, np.nan) for name in ("power", "low", "high")}
        lines.append(line if line["with_points"] else line | {"kept": np.nan})
    return pd.DataFrame(lines).sort_values(["with_points", "time_ratio"], ascending=[True, False], ignore_index=True)


def _sentence(row) -> str:
    peer, faster = label(REFERENCE), (1 / row.time_ratio, 1 / row.time_high, 1 / row.time_low)
    error = row.error_ratio, row.error_low, row.error_high
    power = row.loglinear_power, row.loglinear_low, row.loglinear_high
    return (
        f"{label(OURS)}, {'points' if row.with_points else 'nothing'} kept: {with_interval(*faster)} times as fast as "
        f"{peer}. Its Metro error is {with_interval(*error)} times {peer}'s. Its time grows as (n log n)^p, p = "
        f"{with_interval(*power, places=2)}."
    )


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    def texts(name: str, middle: str = "ratio", places: int | None = None) -> list[str]:
        rows = frame[[f"{name}_{middle}", f"{name}_low", f"{name}_high"]].itertuples(index=False)
        return [with_interval(*row, places=places).replace("not run", "–") for row in rows]

    counts, shares = frame.astype(str), frame[["kept", "valid"]].map(lambda share: f"{percent(share)} %")
    return pd.DataFrame({
        "backend": frame["backend"].map(label), "points kept": np.where(frame["with_points"], "yes", "no"),
        **{name: counts[name] + " of " + counts["tried"] for name in ("refused", "missed")},
        "cells compared": frame["cells"],
        **{title: texts(name) for name, title in RATIOS.items()},
        "slowest": frame["slowest"], **shares.replace("– %", "–"),
        **{f"growth: p of {title}": texts(shape, "power", 2) for shape, title in GROWTHS.items()},
        "meshes": frame["meshes"],
    })  # fmt: skip


ERRORS = {"error": ("Metro mean", "time and distance"), "seen": ("1 − SSIM", "time and error as seen")}
KEPT = {False: ("o", "nothing kept"), True: ("D", "points kept")}


def backends_chart(results: Results) -> Figure:
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
            choices = group.assign(name=group["backend"], **parts)
            ranked = placed(choices, "time_ratio", "ratio", "low", noise_of(group["time_low"], group["time_high"]))
            frame.loc[group.index, f"{kind}_front"] = ranked["on_front"] == ON
        _against(axes, frame, kind, tints)
        axes.set(ylabel=f"{name}, ratio to {REFERENCE}", title=title)
    fits = {name: growth(paired[paired["backend"] == name]) for name in dict.fromkeys(rows["backend"])}
    _growing(panels[2], paired, fits, tints)
    powers = "; ".join(f"{label(name)} {fit.text}" for name, fit in fits.items() if fit)
    words = {
        "reference": REFERENCE, "backends": ", ".join(map(label, tints)), "fitted": FITTED,
        "powers": f"p = 1 is n log n: {powers}." if powers else "",
    }  # fmt: skip
    return Figure(drawing, words, frame, dpi=95)


def _against(axes: Axes, frame: pd.DataFrame, kind: str, tints: dict[str, str]) -> None:
    """One error against time, as ratios. kind: the first part of the columns' names."""
    parts = {f"{kind}_{part}": part for part in ("ratio", "low", "high", "front")}
    compared = frame.rename(columns=parts).dropna(subset=["ratio"])
    for with_points, group in compared[compared["front"]].sort_values("time_ratio").groupby("with_points"):
        style = "-" if with_points else ":"
        axes.step(group["time_ratio"], group["ratio"], where="post", color=INK, lw=1, ls=style, zorder=1)
    ends = [pair for row in compared.itertuples() for pair in _mark(axes, row, tints)]
    for form, name in KEPT.values():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=name)
    axes.set(xscale="log", yscale="log", xlabel=f"seconds, ratio to {REFERENCE}")
    axes.axhline(1, color=GREY, lw=0.7, ls="--", zorder=0)
    axes.grid(True)
    axes.margins(x=0.16, y=0.2)
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithm(axis)
    axes.legend(loc="upper right", fontsize=8)
    first = compared.drop_duplicates("backend")
    names = zip(first["backend"].map(label), zip(first["time_ratio"], first["ratio"], strict=True), strict=True)
    points = np.concatenate([compared[["time_ratio", "ratio"]], compared[["whole_ratio", "ratio"]].dropna()])
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
        cells, fit, power = rows[rows["backend"] == backend], fits[backend], ""
        axes.plot(cells["full"], cells["seconds"], ".", color=tint, ms=4, alpha=0.4, mew=0)
        if fit:
            n, power = np.geomspace(*fit.span, 30), f", p = {fit.text}"
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


OTHER = "meshoptimizer"


def against_meshoptimizer(rows: pd.DataFrame) -> Iterator[str]:
    """A sentence a task, of the rows of bench/simplification.csv.gz; none where not measured."""
    for with_points, group in rows[rows["outcome"] == "reached"].groupby("with_points"):
        if OTHER in set(group["backend"]):
            pairs = group.pivot(index=CELL, columns="backend", values=["metro_mean", "seconds"])
            error, time = (over_meshes(pairs[value][OURS] / pairs[value][OTHER]) for value in ("metro_mean", "seconds"))
            yield (
                f"{label(OURS)}, {'points' if with_points else 'nothing'} kept: {with_interval(*error)} times "
                f"{label(OTHER)}'s Metro error. It takes {with_interval(*time)} times its time."
            )


def over_meshes(ratios: pd.Series) -> tuple[float, float, float]:
    """(mean, low, high) of ratios with a level `mesh`: geometric, over the meshes; of positive ratios alone."""
    mean, low, high = np.exp(interval(ratios[ratios > 0].apply(np.log).groupby("mesh").mean()))
    return float(mean), float(low), float(high)

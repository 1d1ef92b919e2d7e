"""Who simplifies: error against time as ratios to pymeshlab's QEM, and how the time grows with the mesh."""

import numpy as np
from matplotlib.ticker import FuncFormatter, NullFormatter

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.names import place_names
from stages.report.pareto import pareto_front
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, colours, plain_logarithm, plt, save
from stages.report.style import label as spoken

from .backends import REFERENCE, WANTED, common, growths, summarised, tried
from .growth import FITTED

ERRORS = {"error": "Metro mean", "seen": "1 − SSIM"}
TITLES = {"error": "time and distance", "seen": "time and error as seen"}
KEPT = {False: ("o", "nothing kept"), True: ("D", "points kept")}
ROOM = 60  # free above the seconds for the legend, as a factor


def build(results: Results) -> Figure:
    rows = tried(results)
    frame = summarised(rows)
    if REFERENCE not in set(frame["backend"]) or frame["backend"].nunique() < 2:
        raise NotRun(f"no backend beside {REFERENCE} was timed", "lod", runnable=False)
    fits = growths(rows)
    tints = colours(list(dict.fromkeys(frame["backend"])))
    folder = results.reports / "tradeoff"
    figure, panels = plt.subplots(1, 3, figsize=(13.2, 4.4), gridspec_kw={"wspace": 0.27})
    for axes, (kind, name) in zip(panels, ERRORS.items(), strict=False):
        _fronts(frame, kind)
        _against(axes, frame, kind, tints)
        axes.set_ylabel(f"{name}, ratio to {REFERENCE}")
        axes.set_title(TITLES[kind])
    _growing(panels[2], common(rows), fits, tints)
    folder.mkdir(parents=True, exist_ok=True)
    write_table(folder / "backends.csv", frame)
    path = save(figure, folder / "backends.png", dpi=95)
    return Figure(
        "Who simplifies: error, time, and how time grows",
        f"Left and middle: Metro and SSIM error against seconds, as ratios to {REFERENCE}, for "
        f"{', '.join(map(spoken, tints))}. Right: seconds against the faces of the mesh, with fits.",
        "Left (distance) and middle (as seen): geometric means of the ratios over meshes and targets, timed in turns "
        "in one process, with 95 % intervals over the meshes; down and left is better; hollow: all of `simplify`, with "
        "kept faces found and the target tested; lines: the Pareto fronts without (dotted) and with points to keep; "
        f"dashed: equal error, and {WANTED} times faster. Right: each dot a mesh, target and kept set; lines: "
        f"c (n log n)^p fitted to both kinds of cells, from {FITTED:,} faces on; bands: the 95 % interval of p; "
        f"dashed: n log n. {_said(fits)}",
        [path, folder / "backends.csv"],
    )


def _fronts(frame, kind):
    """Adds the column KIND_front; the task without points to keep is another than the one with."""
    frame[f"{kind}_front"] = False
    for _, group in frame.groupby("with_points"):
        frame.loc[group.index, f"{kind}_front"] = pareto_front(group["time_ratio"], group[f"{kind}_ratio"], "low")


def _against(axes, frame, kind, tints):
    """One error against time, as ratios. kind: the first part of the columns' names."""
    names = {f"{kind}_{part}": part for part in ("ratio", "low", "high", "front")}
    known = frame.rename(columns=names).dropna(subset=["ratio"])
    for with_points, group in known[known["front"]].sort_values("time_ratio").groupby("with_points"):
        style = "-" if with_points else ":"
        axes.step(group["time_ratio"], group["ratio"], where="post", color=INK, lw=1, ls=style, zorder=1)
    ends = []
    for row in known.itertuples():
        spot, form = (row.time_ratio, row.ratio), KEPT[row.with_points][0]
        pairs = [((row.time_low, spot[1]), (row.time_high, spot[1])), ((spot[0], row.low), (spot[0], row.high))]
        ends += [pair for pair in pairs if np.isfinite(pair).all()]
        for pair in pairs:
            axes.plot(*zip(*pair, strict=True), color=tints[row.backend], lw=1.2, alpha=0.55)
        axes.plot(*spot, form, color=tints[row.backend], ms=7, mec="white", mew=0.8, zorder=3)
        if row.backend != REFERENCE:
            axes.plot(row.whole_ratio, row.ratio, form, color=tints[row.backend], mfc="none", ms=7, mew=1.1, zorder=2)
    for form, name in KEPT.values():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=name)
    _dress(axes)
    first = known.drop_duplicates("backend")
    names = [(spoken(row.backend), (row.time_ratio, row.ratio)) for row in first.itertuples()]
    points = np.concatenate([known[["time_ratio", "ratio"]], known[["whole_ratio", "ratio"]].dropna()])
    place_names(axes, names, points, ends)


def _dress(axes):
    axes.set(xscale="log", yscale="log", xlabel=f"seconds, ratio to {REFERENCE}")
    axes.axhline(1, color=GREY, lw=0.7, ls="--", zorder=0)
    axes.axvline(1 / WANTED, color=GREY, lw=0.7, ls="--", zorder=0)
    axes.grid(True)
    axes.margins(x=0.16, y=0.2)
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithm(axis)
    axes.legend(loc="upper right", fontsize=8)


def _growing(axes, rows, fits, tints):
    for backend, tint in tints.items():
        here, fit = rows[rows["backend"] == backend], fits[backend]
        axes.plot(here["full"], here["seconds"], ".", color=tint, ms=4, alpha=0.4, mew=0)
        power = ""
        if fit is not None:
            n, power = np.geomspace(*fit.span, 30), f", p = {_power(fit)}"
            axes.plot(n, fit(n), color=tint, lw=1.4)
            axes.fill_between(n, *np.sort([fit(n, fit.low), fit(n, fit.high)], axis=0), color=tint, alpha=0.15, lw=0)
            axes.plot(n, fit(n, 1.0), color=INK, lw=0.9, ls="--")
        axes.plot([], [], "o", color=tint, ms=5, label=spoken(backend) + power)
    axes.plot([], [], color=INK, lw=0.9, ls="--", label="n log n")
    axes.set(xscale="log", yscale="log", xlabel="faces of the mesh, n", ylabel="seconds", title="growth with the mesh")
    axes.set_ylim(top=axes.get_ylim()[1] * ROOM)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}" if value < 1e6 else f"{value / 1e6:g} M"))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(True)
    axes.legend(loc="upper left", fontsize=8)


def _power(fit):
    return f"{fit.power:.2f} [{fit.low:.2f}, {fit.high:.2f}]"


def _said(fits):
    """The fitted powers with their intervals."""
    parts = [f"{spoken(name)} {_power(fit)}" for name, fit in fits.items() if fit is not None]
    return f"p = 1 is n log n: {'; '.join(parts)}." if parts else ""

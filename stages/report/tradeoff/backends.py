"""Who simplifies: error against time as ratios to pymeshlab's QEM, and how the time grows with the mesh."""

import numpy as np
from matplotlib.ticker import FuncFormatter, NullFormatter

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.names import place_names
from stages.report.pareto import pareto_front
from stages.report.results import NotRun
from stages.report.style import GREY, INK, colours, plt, save
from stages.report.style import label as spoken
from stages.report.tables.backends import FITTED, REFERENCE, growth, summarised

ERRORS = {"error": "Metro mean", "seen": "1 − SSIM"}
KEPT = {False: ("o", "nothing kept"), True: ("D", "points kept")}
WANTED = 20  # times faster than the reference: a dashed line


def build(results):
    rows = results.bench("simplification")
    frame = summarised(rows)
    if REFERENCE not in set(frame["backend"]) or frame["backend"].nunique() < 2:
        raise NotRun(f"no backend beside {REFERENCE} was timed", "lod", runnable=False)
    fits = {backend: growth(group) for backend, group in rows.groupby("backend", sort=False)}
    tints = colours(list(dict.fromkeys(frame["backend"])))
    folder = results.reports / "tradeoff"
    figure, panels = plt.subplots(1, 3, figsize=(12.6, 4.0), gridspec_kw={"wspace": 0.27})
    for axes, (kind, name) in zip(panels, ERRORS.items(), strict=False):
        _fronts(frame, kind)
        _against(axes, frame, kind, tints)
        axes.set_ylabel(f"{name}, ratio to {REFERENCE}")
    _growing(panels[2], rows, fits, tints)
    folder.mkdir(parents=True, exist_ok=True)
    write_table(folder / "backends.csv", frame)
    path = save(figure, folder / "backends.png", dpi=95)
    return Figure(
        "Who simplifies: error, time, and how time grows",
        f"Left and middle: Metro and SSIM error against seconds, as ratios to {REFERENCE}, for "
        f"{', '.join(map(spoken, tints))}. Right: seconds against the faces of the mesh, with fits.",
        "Left (distance) and middle (as seen): geometric means of the ratios over meshes and targets, timed in the "
        "same run, with 95 % intervals over the meshes; down and left is better; lines: the Pareto fronts without "
        f"(dotted) and with points to keep; dashed: equal error, and {WANTED} times faster. Right: each dot a mesh and "
        f"target; lines: c (n log n)^p fitted from {FITTED:,} faces on. {_said(fits)}",
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
        spot = (row.time_ratio, row.ratio)
        pairs = [((row.time_low, spot[1]), (row.time_high, spot[1])), ((spot[0], row.low), (spot[0], row.high))]
        ends += [pair for pair in pairs if np.isfinite(pair).all()]
        for pair in pairs:
            axes.plot(*zip(*pair, strict=True), color=tints[row.backend], lw=1.2, alpha=0.55)
        axes.plot(*spot, KEPT[row.with_points][0], color=tints[row.backend], ms=7, mec="white", mew=0.8, zorder=3)
    for form, name in KEPT.values():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=name)
    _dress(axes)
    first = known.drop_duplicates("backend")
    names = [(spoken(row.backend), (row.time_ratio, row.ratio)) for row in first.itertuples()]
    place_names(axes, names, known[["time_ratio", "ratio"]].to_numpy(), ends)


def _dress(axes):
    axes.set(xscale="log", xlabel=f"seconds, ratio to {REFERENCE}")
    axes.axhline(1, color=GREY, lw=0.7, ls="--", zorder=0)
    axes.axvline(1 / WANTED, color=GREY, lw=0.7, ls="--", zorder=0)
    axes.grid(True)
    axes.margins(x=0.14, y=0.16)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(loc="upper right", fontsize=8)


def _growing(axes, rows, fits, tints):
    for backend, tint in tints.items():
        here, fit = rows[rows["backend"] == backend], fits[backend]
        axes.plot(here["full"], here["seconds"], ".", color=tint, ms=4, alpha=0.5)
        power = ""
        if fit is not None:
            n, power = np.geomspace(*fit.span, 30), f": p = {fit.power:.2f}"
            axes.plot(n, fit(n), color=tint, lw=1.2)
        axes.plot([], [], "o", color=tint, ms=5, label=spoken(backend) + power)
    axes.set(xscale="log", yscale="log", xlabel="faces of the mesh, n", ylabel="seconds")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}" if value < 1e6 else f"{value / 1e6:g} M"))
    axes.grid(True)
    axes.legend(loc="lower right", fontsize=8)


def _said(fits):
    """The fitted powers with their intervals."""
    known = {spoken(name): fit for name, fit in fits.items() if fit is not None}
    parts = [f"{name} {fit.power:.2f} [{fit.low:.2f}, {fit.high:.2f}]" for name, fit in known.items()]
    return f"p = 1 is n log n: {'; '.join(parts)}." if parts else ""

"""Touching: exactness against time, and imprints a second against the faces of the mesh, beside camera-based peers."""

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.names import place_names
from stages.report.pareto import pareto_front
from stages.report.style import CYCLE, GREY, INK, MARKERS, plt, save
from stages.report.tables.imprint_rates import NAMES, OURS, REFERENCE, WANTED, WIDE, summarised

ROUNDING = 1e-9  # of a cell: errors below are those of double precision, and drawn here


def build(results):
    frame = summarised(results)
    rows = results.bench("imprints").query("what == 'rate'").dropna(subset=["value"])
    methods = [method for method in NAMES if method in set(rows["method"])]
    style = {method: (CYCLE[k], MARKERS[k]) for k, method in enumerate(methods)}
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.4, 4.4), gridspec_kw={"wspace": 0.28})
    wide = frame[(frame["cells"] == WIDE) & frame["rate"].notna()].reset_index(drop=True)
    wide["seconds"] = 1 / wide["rate"]
    wide["cell_error"] = wide["error"] / wide["pitch"]
    wide["on_front"] = pareto_front(wide["seconds"], np.maximum(wide["cell_error"], ROUNDING), "low")
    _exactness(left, wide, style)
    _growth(right, rows, style)
    folder = results.reports / "tradeoff"
    folder.mkdir(parents=True, exist_ok=True)
    write_table(folder / "imprints.csv", wide)
    path = save(figure, folder / "imprints.png", dpi=110)
    names = ", ".join(NAMES[method] for method in methods)
    return Figure(
        "Touching: exactness, time, and the size of the mesh",
        f"Left: largest error against seconds an imprint of {WIDE} x {WIDE} cells, for {names}. Right: imprints a "
        "second against the faces of the mesh.",
        f"Left: largest error over four analytic shapes, in cells (drawn at {ROUNDING:g} where it is rounding), "
        "against the seconds of one imprint, the geometric mean over the meshes with its 95 % interval; down and left "
        f"is better. Right: {WIDE} x {WIDE} cells (full), 16 x 16 (hollow), mean of both pitches; dashed: the "
        f"{WANTED['rate']:,} a second that were wanted, and {WANTED['ratio']} times TACTO's rate.",
        [path, folder / "imprints.csv"],
    )


def _exactness(axes, wide, style):
    """Largest error against seconds of one imprint."""
    spots = np.stack([wide["seconds"], np.maximum(wide["cell_error"], ROUNDING)], axis=1)
    front = spots[wide["on_front"]]
    front = front[np.argsort(front[:, 0])]
    axes.step(front[:, 0], front[:, 1], where="post", color=INK, lw=1, zorder=1)
    ends = []
    for row, spot in zip(wide.itertuples(), spots, strict=True):
        tint, form = style[row.method]
        axes.plot(*spot, form, color=tint, ms=8, mec="white", mew=0.8, zorder=3)
        if np.isfinite([row.rate_low, row.rate_high]).all():
            ends.append(((1 / row.rate_high, spot[1]), (1 / row.rate_low, spot[1])))
            axes.plot(*zip(*ends[-1], strict=True), color=tint, lw=1.4, alpha=0.6)
    axes.set(xscale="log", yscale="log", xlabel="seconds an imprint, one core", ylabel="largest error, in cells")
    axes.set_title("exactness and time")
    axes.grid(True)
    axes.margins(x=0.28, y=0.2)
    place_names(axes, [(NAMES[row.method], spot) for row, spot in zip(wide.itertuples(), spots, strict=True)], spots,
                ends)  # fmt: skip


def _growth(axes, rows, style):
    """Imprints a second against the faces of the mesh."""
    for method, (tint, form) in style.items():
        for cells, group in rows[rows["method"] == method].groupby("cells"):
            means = np.exp(np.log(group["value"]).groupby(group["faces"]).mean())
            fill = {"mfc": tint, "mec": "white"} if cells == WIDE else {"mfc": "white", "mec": tint}
            line = "-" if cells == WIDE else ":"
            axes.plot(means.index, means, form + line, color=tint, ms=6, lw=1.2, mew=0.9, **fill)
        axes.plot([], [], form, color=tint, ms=6, label=NAMES[method])
    axes.axhline(WANTED["rate"], color=GREY, lw=0.9, ls="--")
    known = rows[rows["method"] == REFERENCE]["value"]
    if len(known) and OURS in style:
        axes.axhline(WANTED["ratio"] * np.exp(np.log(known).mean()), color=GREY, lw=0.9, ls="--")
    axes.set(xscale="log", yscale="log", xlabel="faces of the mesh", ylabel="imprints a second")
    axes.set_title("rate and size of the mesh")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    axes.grid(True)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=9)

"""Imprints per second and how exact they are, beside camera-based simulators, timed in one run of `make bench`."""

import numpy as np
import pandas as pd
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from stages.kit.files import write_table
from stages.kit.stats import interval
from stages.report.items import Figure, Table
from stages.report.markdown import with_interval
from stages.report.names import place_names
from stages.report.pareto import pareto_front
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, GREY, INK, MARKERS, plt, save
from stages.report.target import on_target

OURS, REFERENCE = "ours", "tacto_160x120"
NAMES = {
    "ours": "ours", "trimesh_embree": "trimesh on embree", "depth_picture": "depth picture (pyrender)",
    "tacto_32x32": "TACTO, 32 x 32 pixels", "tacto_160x120": "TACTO, its 160 x 120 pixels",
}  # fmt: skip
WANTED = {"rate": 3000, "ratio": 50}  # imprints of WIDE x WIDE cells a second; times TACTO's rate
WIDE = 32
MANY = 100  # rates from here on are shown as whole numbers
ROUNDING = 1e-9  # of a cell: errors below are those of double precision, and drawn here
NOTES = [
    "Rate: geometric mean over the meshes, arrays 0.002 and 0.01 units apart [95 % interval over the meshes], of 40 "
    "random vertices, the same for all, by the time of the process on one core; lowest: of the slowest mesh. Ratio: to "
    "the rate of TACTO (a camera-based simulator of a gel sensor) at its own resolution on the same mesh and points, "
    "one call of its renderer a touch, without noise, forces and steps of its physics.",
    "Error: the largest distance, over a plane, a sphere, a cylinder and a saddle, between what was measured and the "
    "mesh that was touched, in thousandths of the distance of two cells. The cameras' error comes from "
    "pyrender, which takes the depth at a sample up to 3/8 of a pixel off the pixel's middle.",
    "A depth picture, and TACTO's, is what is seen from above; the array also measures where it is inside the object. "
    "trimesh's rays start above as well, one a cell.",
]


def table(results: Results) -> Table:
    """Imprints per second and how exact they are, beside camera-based simulators."""
    frame = summarised(results)
    return Table("Imprints a second", frame, [*_said(frame), _meshes(results), *NOTES], _wide(frame))


def summarised(results: Results) -> pd.DataFrame:
    """One row per method and number of cells: rates, ratios, error (units) and pitch (units) of that, note."""
    rows = results.bench("imprints")
    rates, errors = rows[rows["what"] == "rate"], rows[rows["what"] == "error"]
    if rates["value"].notna().sum() == 0 or len(errors) == 0:
        raise NotRun("bench/imprints.csv is not whole: `make bench` writes it anew", "imprints", runnable=False)
    found = []
    for (method, cells), group in rates.dropna(subset=["method"]).groupby(["method", "cells"], sort=False):
        line = {"method": method, "cells": int(cells), "meshes": group.dropna(subset=["value"])["mesh"].nunique()}
        for name, column in (("rate", "value"), ("ratio", "ratio")):
            line |= dict(zip((name, f"{name}_low", f"{name}_high"), _mean(group, column), strict=True))
            line[f"{name}_least"] = group[column].min()
        own = errors[errors["method"] == method]
        line |= {"error": own["to_mesh"].max(), "pitch": own["pitch"].max()}
        notes = group["note"].dropna()
        found.append(line | {"note": notes.iloc[0] if len(notes) else ""})
    return pd.DataFrame(found).sort_values(["cells", "rate"], ascending=[True, False], ignore_index=True)


def _mean(group, column):
    """(geometric mean, low, high) over the meshes."""
    logs = np.log(group[column].astype(float)).groupby(group["mesh"]).mean()
    return tuple(np.exp(interval(logs)))


def _said(frame):
    """The targets of ours, and whether they were met."""
    said = []
    for row in frame[frame["method"] == OURS].itertuples():
        rate, ratio = (row.rate, row.rate_low, row.rate_high), (row.ratio, row.ratio_low, row.ratio_high)
        size = f"{row.cells} x {row.cells} cells"
        text = f"Ours, {size}: {_whole(*rate)} imprints a second on one core"
        text += f"; {WANTED['rate']:,} is {on_target(*rate, at_least=WANTED['rate'])}" if row.cells == WIDE else ""
        word = on_target(*ratio, at_least=WANTED["ratio"])
        beside = f"{_whole(*ratio)} times TACTO's rate; {WANTED['ratio']} times is {word}"
        said.append(f"{text}. {beside if ratio[0] == ratio[0] else 'TACTO was not run'}.")
    return said


def _meshes(results):
    rows = results.bench("imprints").query("what == 'rate'")
    known = rows.dropna(subset=["value"]).drop_duplicates("mesh")
    lines = [f"{row.mesh} ({row.source}, {int(row.faces):,} faces)" for row in known.itertuples()]
    absent = rows[rows["value"].isna()].dropna(subset=["note"])
    who = absent["method"].map(NAMES).fillna(absent["source"])
    reasons = dict.fromkeys(f"{name}: {note}" for name, note in zip(who, absent["note"], strict=True))
    return f"Meshes: {', '.join(lines)}. " + "".join(f"{reason}. " for reason in reasons)


def _wide(frame):
    shown = pd.DataFrame({"method": frame["method"].map(NAMES), "cells": frame["cells"]})
    for name, title in (("rate", "imprints a second"), ("ratio", "ratio to TACTO")):
        triples = frame[[name, f"{name}_low", f"{name}_high"]].itertuples(index=False)
        shown[title] = ["–" if triple[0] != triple[0] else _whole(*triple) for triple in triples]
        shown[f"lowest {name}"] = [round(value) if value >= MANY else value for value in frame[f"{name}_least"]]
    shown["error, thousandths of a cell"] = [_error(value) for value in 1000 * frame["error"] / frame["pitch"]]
    return shown.assign(**{"version and renderer": frame["note"]})


def _whole(*triple):
    """A mean with its interval, large ones as whole numbers."""
    return with_interval(*(round(value) if value >= MANY else value for value in triple))


def _error(value):
    """A number; below a millionth it is rounding of double precision and said so."""
    return "< 1e-6" if value < 1e-6 else value


def chart(results: Results) -> Figure:
    """Exactness against time, and imprints per second against the faces of the mesh, beside camera-based peers."""
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

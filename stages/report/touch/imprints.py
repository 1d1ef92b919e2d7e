"""Imprints of touch: their rate and exactness beside camera-based simulators, timed in one run of `make bench`."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.charts.drawing import CYCLE, INK, MARKERS, place_names, plain_logarithm, plt
from stages.charts.items import Figure, Table
from stages.charts.pareto import ON, noise_of, placed
from stages.charts.results import NotRun, Results
from stages.charts.tables import Ranking, records, with_interval
from stages.engine.statistics import interval

OURS = "ours"
NAMES = {
    "ours": "ours", "trimesh_embree": "trimesh on embree", "depth_picture": "depth picture (pyrender)",
    "tacto_32x32": "TACTO, 32 x 32 pixels", "tacto_160x120": "TACTO, its 160 x 120 pixels",
}  # fmt: skip
STYLES = {method: (CYCLE[k], MARKERS[k]) for k, method in enumerate(NAMES)}
WIDE = 32
MANY = 100  # rates from here on are shown as whole numbers
TITLES = {"rate": "imprints a second", "ratio": "ratio to TACTO"}
ROUNDING = 1e-9  # of a cell: errors below are those of double precision, and drawn here


def table(results: Results) -> Table:
    """Imprints per second and how exact they are, beside camera-based simulators."""
    rates, frame = _read(results)
    meshes = rates.dropna(subset=["value"]).drop_duplicates("mesh")
    absent_rows = rates[rates["value"].isna()].dropna(subset=["note"])
    reasons = absent_rows["method"].map(NAMES).fillna(absent_rows["source"]) + ": " + absent_rows["note"] + "."
    text_table = pd.DataFrame({"method": frame["method"].map(NAMES), "cells": frame["cells"]})
    numbers = frame.select_dtypes("number")
    numbers = numbers.mask(numbers >= MANY, numbers.round())
    for name, title in TITLES.items():
        ends = numbers[[name, f"{name}_low", f"{name}_high"]].itertuples(index=False)
        text_table[title] = [with_interval(*mean).replace("not run", "–") for mean in ends]
        text_table[f"lowest {name}"] = numbers[f"{name}_least"]
    errors = 1000 * frame["error"] / frame["pitch"]
    text_table["error, thousandths of a cell"] = ["< 1e-6" if error < 1e-6 else error for error in errors]
    texts = text_table[[*TITLES.values()]].itertuples(index=False, name=None)
    lines = [_sentence(row, *pair) for row, pair in zip(records(frame), texts, strict=True) if row.method == OURS]
    words = {
        "findings": "\n".join(lines), "absent": " ".join(reasons.unique()),
        "meshes": ", ".join(f"{row.mesh} ({row.source}, {int(row.faces):,} faces)" for row in records(meshes)),
    }  # fmt: skip
    answer = ["method", "cells", *TITLES.values(), "error, thousandths of a cell"]
    text_table = text_table.assign(**{"version and renderer": frame["note"]})
    return Table(frame, text_table, words, Ranking(TITLES["rate"], among=["cells"]), answer)


def _read(results: Results) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(rows of rates; one row per method and number of cells: rates, ratios, error and its pitch in units, note)."""
    rates, errors = (results.bench("imprints").query(f"what == '{kind}'") for kind in ("rate", "error"))
    if rates["value"].isna().all() or errors.empty:
        raise NotRun("bench/imprints.csv is not whole: `make bench` writes it anew", "imprints", runnable=False)
    largest = errors.groupby("method")[["to_mesh", "pitch"]].max().rename(columns={"to_mesh": "error"})
    lines, groups = [], rates.groupby(["method", "cells"], sort=False)
    for _, group in groups:
        line = {"meshes": group.dropna(subset=["value"])["mesh"].nunique()}
        for name, column in (("rate", "value"), ("ratio", "ratio")):
            logs = group[column].astype(float).transform(np.log).groupby(group["mesh"]).mean()
            line |= zip((name, f"{name}_low", f"{name}_high"), np.exp(interval(logs)), strict=True)
            line[f"{name}_least"] = group[column].min()
        lines.append(line)
    notes = groups["note"].first().fillna("")
    frame = pd.DataFrame(lines, notes.index).join(largest, on="method").join(notes).reset_index()
    return rates, frame.sort_values(["cells", "rate"], ascending=[True, False], ignore_index=True)


def _sentence(row: Any, rate: str, ratio: str) -> str:
    """How fast ours is."""
    text = f"Ours, {row.cells} x {row.cells} cells: {rate} imprints a second on one core. "
    return text + ("TACTO was not run." if row.ratio != row.ratio else f"{ratio} times TACTO's rate.")


def chart(results: Results) -> Figure:
    """Exactness against time, and imprints per second against the faces of the mesh, beside camera-based peers."""
    rates, frame = _read(results)
    rates = rates.dropna(subset=["value"])
    methods = [method for method in NAMES if method in set(rates["method"])]
    wide = frame[(frame["cells"] == WIDE) & frame["rate"].notna()]
    wide = wide.assign(seconds=1 / wide["rate"], cell_error=wide["error"] / wide["pitch"])
    wide["shown"] = np.maximum(wide["cell_error"], ROUNDING)
    wide = placed(wide, "seconds", "shown", "low", noise_of(wide["rate_low"], wide["rate_high"]))
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.4, 4.4), gridspec_kw={"wspace": 0.28})
    _draw_exactness(left, wide)
    _draw_growth(right, rates, methods)
    words = {"wide": WIDE, "names": ", ".join(NAMES[method] for method in methods), "rounding": f"{ROUNDING:g}"}
    return Figure(figure, words, wide, dpi=110)


def _draw_exactness(axes: Axes, wide: pd.DataFrame) -> None:
    front = wide[wide["on_front"] == ON].sort_values("seconds")
    axes.step(front["seconds"], front["shown"], where="post", color=INK, lw=1, zorder=1)
    names, lines = [], []
    for row in records(wide):
        tint, form = STYLES[row.method]
        axes.plot(row.seconds, row.shown, form, color=tint, ms=8, mec="white", mew=0.8, zorder=3)
        names.append((NAMES[row.method], (row.seconds, row.shown)))
        if np.isfinite([row.rate_low, row.rate_high]).all():
            lines.append(((1 / row.rate_high, row.shown), (1 / row.rate_low, row.shown)))
            axes.plot(*zip(*lines[-1], strict=True), color=tint, lw=1.4, alpha=0.6)
    axes.loglog()
    axes.set(xlabel="seconds an imprint, one core", ylabel="largest error, in cells", title="exactness and time")
    axes.grid(True)
    axes.margins(x=0.28, y=0.2)
    place_names(axes, names, wide[["seconds", "shown"]].to_numpy(), lines)


def _draw_growth(axes: Axes, rows: pd.DataFrame, methods: list[str]) -> None:
    for method in methods:
        tint, form = STYLES[method]
        for cells, group in rows[rows["method"] == method].groupby("cells"):
            rates = np.exp(group["value"].transform(np.log).groupby(group["faces"]).mean())
            line, fill, rim = ("-", tint, "white") if cells == WIDE else (":", "white", tint)
            axes.plot(rates, form + line, color=tint, ms=6, lw=1.2, mew=0.9, mfc=fill, mec=rim)
        axes.plot([], [], form, color=tint, ms=6, label=NAMES[method])
    axes.loglog()
    axes.set(xlabel="faces of the mesh", ylabel="imprints a second", title="rate and size of the mesh")
    plain_logarithm(axes.xaxis)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(lambda value, _: f"{value:,g}")
    axes.grid(True)
    axes.legend(loc="lower left", bbox_to_anchor=(1.01, 0), fontsize=9)

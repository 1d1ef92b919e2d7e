"""Every detector and combination of channels by the errors of the mesh that keeps its points (T3.1.5, figure 3.5)."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.kit.stats import interval
from stages.report.items import Figure, Table
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, plt
from stages.report.words import dataset_text

from .dots import draw_dots, dress
from .methods import PLAIN, fixed, ordered, short
from .rows import ERRORS, STAGE, by_object, data_sets, face_counts, marked, paired_cells, said, wide

MAIN = ("metro_mean", "ssim_error", "gaze_error")  # shown for the data sets after the first
COLUMNS = ["data", "method", "metric", "objects", "mean", "low", "high", "over_plain", "over_plain_low",
           "over_plain_high"]  # fmt: skip
SPREAD = {"metro_mean": "mean", "metro_rms": "rms", "metro_max": "max"}
SEEN = ("ssim_error", "dlap", "dnor")
COUNTS = 2  # face counts of panel b: the most, and the next
ROW = 0.185  # inches a method
APART = (-0.24, 0.0, 0.24)  # rows between the dots of one method in one panel
TITLES = ["(a) Metro, %", "(b) Metro mean, %", "(c) 1 − SSIM, %", "(d) DLap", "(e) Dnor", "(f) points"]


def table(results: Results) -> Table:
    """Errors and numbers of points of every method, on every data set."""
    tables = {dataset_text(name): _per_object(results, name) for name in data_sets(results)}
    tables = {data: table for data, table in tables.items() if PLAIN in table.index.unique("method")}
    if not tables:
        raise NotRun("no face count that plain QEM and all other methods reach on one object", "lod", runnable=False)
    frame = pd.DataFrame([line for data, found in tables.items() for line in _means(found, data)], columns=COLUMNS)
    counts = ", ".join(f"{len(found.index.unique('item'))} {data}" for data, found in tables.items())
    return Table(frame, _wide(frame), {"counts": counts})


def _per_object(results: Results, dataset: str) -> pd.DataFrame:
    """Frame (object, method) x (errors, points, kept): means over the targets that all methods reach."""
    rows, key = paired_cells(results, dataset=dataset), ["item", "method"]
    errors = rows.pivot_table(index=key, columns="metric", values="value", sort=False)
    return errors.join(rows.groupby(key, sort=False)[[name for name in ("points", "kept") if name in rows]].mean())


def _means(found: pd.DataFrame, data: str) -> list[list]:
    """Lines of COLUMNS: means over the objects, the errors beside those of plain QEM."""
    lines, plain = [], found.xs(PLAIN, level="method")
    for method in ordered(found.index.unique("method")):
        mine = found.xs(method, level="method")
        for metric in found:
            gain = interval(mine[metric] - plain[metric].reindex(mine.index)) if metric in ERRORS else [np.nan] * 3
            lines.append([data, method, metric, mine[metric].count(), *interval(mine[metric]), *gain])
    return lines


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    own, texts, heads = frame["data"].iloc[0], [], []
    cells = frame[(frame["data"] == own) | frame["metric"].isin(MAIN)]
    for row in cells.itertuples():
        name = ERRORS[row.metric][0] if row.metric in ERRORS else row.metric
        heads.append(name if row.data == own else f"{name}, {row.data}")
        texts.append(marked(row) if row.metric in ERRORS else f"{row.mean:.1f}")
    found = wide(cells.assign(text=texts, head=heads), "method", "head")
    first = [name for name in ("points", "kept") if name in found]
    found = found.loc[ordered(found.index), [*first, *found.columns.drop(first)]]
    return found.rename(short).reset_index(names="kept points")


def figure(results: Results) -> Figure:
    """Six panels of dots, a row each method: distances, the same by face count, errors as seen, number of points."""
    rows = paired_cells(results, methods=filter(fixed, set(results.rows(STAGE)["method"])))
    methods = ordered(set(rows["method"]))
    if PLAIN not in methods or len(methods) < 3:
        raise NotRun("no face count that plain QEM and two other methods reach", "lod", runnable=False)
    counts = face_counts(rows)[:COUNTS]
    drawing, panels = plt.subplots(1, 6, figsize=(11.4, 1.1 + ROW * len(methods)), sharey=True)
    _draw(panels, rows, methods, counts)
    dress(panels, TITLES, methods, pad=20)
    objects = rows.groupby("target")["item"].nunique()
    words = {
        "methods": ", ".join(map(short, methods)), "objects": rows["item"].nunique(),
        "over": ", ".join(f"{objects[target]} at {said(target)}" for target in counts),
    }  # fmt: skip
    return Figure(drawing, words, dpi=100)


def _draw(panels: Sequence[Axes], rows: pd.DataFrame, methods: list[str], counts: list[str]) -> None:
    """The six panels. counts: the face counts of panel b."""
    known = set(rows["metric"])
    spread = [metric for metric in SPREAD if metric in known]
    for metric, tint, down in zip(spread, CYCLE, APART, strict=False):
        draw_dots(panels[0], by_object(rows, metric), methods, tint, PLAIN, SPREAD[metric], down)
    for target, tint, down in zip(counts, CYCLE[3:], APART, strict=False):
        errors = by_object(rows, "metro_mean", target)
        draw_dots(panels[1], errors, methods, tint, PLAIN, said(target).removesuffix(" faces"), down)
    for axes, metric in zip(panels[2:5], SEEN, strict=True):
        if metric in known:
            draw_dots(axes, by_object(rows, metric), methods, CYCLE[0], PLAIN)
    draw_dots(panels[5], rows.pivot_table(index="item", columns="method", values="points"), methods, CYCLE[0])
    panels[0].set_xscale("log")
    panels[0].xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    for axes in panels[:2]:
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.99), ncols=3, fontsize=8, handletextpad=0,
                        columnspacing=0.6, borderpad=0.2)  # fmt: skip

"""T table 3.2 and figures 3.23 to 3.26: errors of the simplified meshes by face count, on every data set."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from stages.kit.stats import interval
from stages.report.grid import means
from stages.report.items import Figure, Table
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.report.style import GREY, INK, METHOD_COLOURS, PALE, label, plt
from stages.report.words import dataset_text

from .dots import name_rows
from .methods import ENHANCED, FIXED_ADAPTIVE, HKS, OURS, PLAIN, RIVALS, short
from .rows import ERRORS, FEWEST, METRICS, STAGE, UNITS, data_sets, face_counts, marked, paired_cells, said, size, wide

METHODS = [*FIXED_ADAPTIVE, "thesis_ed", "thesis_ed-adaptive", ENHANCED, f"{ENHANCED}-adaptive", "VisAttAll", HKS,
           OURS, PLAIN]  # fmt: skip
PRINTED = {"guided_ed": "ed", "thesis_ed": "ed", "guided_ssim": "ssim", ENHANCED: "ssim", "svm": "svm"}
BLOCK = ["target", "nothing_shrunk"]
KEY = ["data", "nothing_shrunk", "target", "method", "metric"]
DRAWN = [*FIXED_ADAPTIVE, OURS, f"{OURS}-adaptive", f"{OURS}-soft", "VisAttAll", HKS, *RIVALS, PLAIN]
TINTS = dict.fromkeys(DRAWN, GREY) | dict.fromkeys(FIXED_ADAPTIVE, "#D55E00")  # the methods of T3.2; below: ours
TINTS |= {method: METHOD_COLOURS[OURS] for method in DRAWN if method.startswith(OURS)}
TARGETS = ("1500", "3000")
FLOOR = 1e-3  # of plain QEM's median: an axis begins there, since some meshes are exact


def table(results: Results) -> Table:
    """Errors by method and face count, on all objects and where nothing shrank, beside the thesis's."""
    parts = list(_parts(results))
    if not parts:
        raise NotRun("no face count that all methods of the table reach", STAGE, runnable=False)
    rows = pd.concat(parts)
    frame = pd.DataFrame(means(rows, KEY)).rename(columns={"values": "objects"}).drop(columns="seconds")
    gains = rows.assign(gain=rows["value"] - rows["plain"]).groupby(KEY, sort=False)["gain"]
    frame[["over_plain", "over_plain_low", "over_plain_high"]] = [interval(gain) for _, gain in gains]
    thesis = results.thesis("table_3_2_lod_errors").melt(["method", "faces"], METRICS, "metric", "thesis")
    thesis = thesis.rename(columns={"method": "printed", "faces": "target"}).astype({"target": str})
    frame = frame.assign(printed=frame["method"].map(PRINTED)).merge(thesis, "left").drop(columns="printed")
    orders = {"target": sorted(set(frame["target"]), key=size), "method": METHODS, "metric": list(METRICS)}
    cells = frame.assign(block=frame["target"].map(said) + np.where(frame["nothing_shrunk"], ", nothing shrunk", ""))
    cells = cells.assign(**{name: pd.Categorical(frame[name], order) for name, order in orders.items()})
    return Table(frame, _wide(cells), {"objects": _counted(cells), "fewest": FEWEST})


def _parts(results: Results) -> Iterator[pd.DataFrame]:
    """Rows of each data set, with all cells and, where they are fewer, with those in which nothing shrank."""
    for name in data_sets(results):
        every = None
        for whole in (False, True):
            rows = paired_cells(results, METRICS, METHODS, name, whole)
            rows = rows[rows["target"].isin(face_counts(rows))]
            if len(rows) and (every is None or len(rows) < len(every)):
                yield rows.assign(data=dataset_text(name), nothing_shrunk=whole)
            every = rows


def _wide(cells: pd.DataFrame) -> pd.DataFrame:
    """A row a block and method, most faces first; for each metric a column a data set, and the thesis's."""
    printed = cells.drop_duplicates([*BLOCK, "method", "metric"]).assign(data="thesis")
    printed["text"] = (printed["metric"].map(UNITS).astype(float) * printed["thesis"]).map(number)
    cells = pd.concat([cells.assign(text=[marked(row) for row in cells.itertuples()]), printed])
    cells = cells.sort_values([*BLOCK, "method", "metric"], ignore_index=True)
    cells["head"] = cells["metric"].map(ERRORS).astype(str) + ", " + cells["data"]
    cells["kept points"] = cells["method"].map(label)
    return wide(cells, ["block", "kept points"], "head").reset_index(names=["target", "kept points"])


def _counted(cells: pd.DataFrame) -> str:
    """How many objects each block is over."""
    counts = cells.drop_duplicates(["data", *BLOCK]).sort_values(BLOCK)
    objects = (counts["objects"].astype(str) + " " + counts["data"]).groupby(counts["block"], sort=False)
    return "; ".join(f"{block}: {sets}" for block, sets in objects.agg(", ".join).items())


def figure(results: Results) -> Figure:
    """A row of panels for each data set, a panel for each error and face count, a box for each method."""
    shown = {}
    for dataset in data_sets(results):
        rows = paired_cells(results, METRICS, DRAWN, dataset)
        rows = rows[rows["target"].isin(set(TARGETS).intersection(face_counts(rows)))]
        if len(rows):
            shown[dataset_text(dataset)] = rows
    if not shown:
        raise NotRun("no data set with enough objects that all methods take to 1,500 or 3,000 faces", STAGE, False)
    known = pd.concat(shown)["method"].unique()
    methods = [method for method in DRAWN if method in known]
    height = 0.5 + 0.17 * len(methods)
    drawing, grid = plt.subplots(len(shown), 4, figsize=(10.4, 0.4 + height * len(shown)), squeeze=False, sharey=True)
    for row, (name, rows) in zip(grid, shown.items(), strict=True):
        for axes, (metric, target) in zip(row, product(METRICS, TARGETS), strict=True):
            here = rows[(rows["metric"] == metric) & (rows["target"] == target)]
            _boxes(axes, here.assign(value=UNITS[metric] * here["value"]), methods)
            title = f"{ERRORS[metric]}, {said(target)}\n{name}, {here['item'].nunique()} objects"
            axes.set_title(title, fontsize=8.5, fontweight="normal", pad=4)
        name_rows(row[0], methods, [TINTS[method] for method in methods], 8)
    drawing.subplots_adjust(wspace=0.08, hspace=0.34)
    return Figure(drawing, {"methods": ", ".join(map(short, methods)), "sets": " and ".join(shown)}, dpi=95)


def _boxes(axes: Axes, rows: pd.DataFrame, methods: list[str]) -> None:
    floor = FLOOR * rows.loc[rows["method"] == PLAIN, "value"].median()
    for y, method in enumerate(methods):
        values = np.maximum(rows.loc[rows["method"] == method, "value"].to_numpy(), floor)
        if len(values) == 0 or not floor > 0:
            continue
        low, left, middle, right, high = np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95])
        axes.plot([low, high], [y, y], color=TINTS[method], lw=0.9)
        axes.barh(y, right - left, 0.62, left, color=TINTS[method], alpha=0.45)
        axes.plot([middle] * 2, [y - 0.31, y + 0.31], color=INK, lw=1.3)
        if method == PLAIN:
            axes.axvline(middle, color=GREY, lw=0.9, ls="--", zorder=0)
    axes.set(xscale="log", xlim=(floor if floor > 0 else None, None))
    axes.xaxis.set_major_locator(LogLocator(numticks=6))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="x", labelsize=8, which="both")
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=PALE, lw=0.5)

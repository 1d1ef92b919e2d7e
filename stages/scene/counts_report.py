"""Faces of objects: the counts that models predict (T3.1.3), and frames at the chosen levels.

The thesis's networks, two simpler models and a lookup of the object's own curve predict the count; the table shows
their waste, their failures and their cost. `frames` draws full, uniform and our levels side by side, with
the displacement from the full levels, above charts of all frames of the path; it reads data/scene/pictures.npz.
"""

import numpy as np
import pandas as pd
from matplotlib.figure import SubFigure

from haptic_glance.base.files import read_arrays
from stages.charts.datasets import SECTION_3_1
from stages.charts.drawing import INK, plt
from stages.charts.items import Figure, Table
from stages.charts.results import Results, require_file
from stages.charts.tables import number, records, with_interval
from stages.scene.budget_report import COLOURS, NAMES, OURS, scene_rows

MODELS = {
    "network": "the thesis's networks",
    "linear": "linear in logarithms",
    "one_mesh": "one measured mesh, common power law",
    "lookup": "lookup of the object's own curve",
}
CONDITIONS = {
    "left_out": "objects left out",
    "equal_rate": "the same, times a safety factor",
    "built": "a sample, as meshes",
    "built_equal_rate": "the sample with the factor, as meshes",
    "coarser": "coarser than anything known",
    "finer": "finer than anything known",
    "larger": "objects larger than any known",
    "flat": "objects of flat sides",
}
METRICS = {  # head of the column, scale, decimal places
    "factor_median": ("off by (half)", 1, 2),
    "factor_90": ("off by (90 %)", 1, 2),
    "count_bias": ("count / needed", 1, 2),
    "within": ("within the tolerance, %", 100, 0),
    "excess": ("excess error, %", 100, 0),
    "waste": ("wasted faces, %", 100, 0),
}


def counts_table(results: Results) -> Table:
    """A line for each condition and model, and what the models cost beside the lookup."""
    rows = _measured(results, [*CONDITIONS, "cost"])
    costs = rows[rows["condition"] == "cost"].pivot(index="method", columns="metric", values="value")
    costs = costs.reindex(list(MODELS), columns=["fit", "ask"]).dropna()
    texts = [f"{MODELS[row.Index]} {number(row.fit)} and {number(row.ask)}" for row in records(costs)]
    subset, keys = rows[rows["metric"].isin(METRICS)], ["condition", "method"]
    text = [with_interval(row.value, row.low, row.high, *METRICS[row.metric][1:]) for row in records(subset)]
    wide = subset.assign(text=text).pivot(index=keys, columns="metric", values="text").reindex(columns=list(METRICS))
    wide = wide.fillna("–").rename(columns={metric: head for metric, (head, *_) in METRICS.items()})
    wide = wide.join(subset.groupby(keys)[["cases", "objects"]].max().astype(int))
    wide = wide.loc[[key for key in pd.MultiIndex.from_product([CONDITIONS, MODELS]) if key in wide.index]]
    wide = wide.rename(CONDITIONS, level="condition").rename(MODELS, level="method")
    text_table = wide.rename_axis(["asked about", "model"]).reset_index()
    return Table(rows, text_table, {"costs": "; ".join(texts) or "not measured"})


def _measured(results: Results, conditions: list[str]) -> pd.DataFrame:
    """Rows of the models: of the thesis's fourteen combinations where they were run."""
    return results.measured("scene", results.printed(SECTION_3_1, "scene"), condition=conditions, method=list(MODELS))


MARGIN = 8  # pixels round the objects
DRAWN = ("full", "uniform", "uniform_size", "network", OURS)
ROW, CHART = 1.95, 2.9  # inches
GRID = {"wspace": 0.04, "hspace": 0.3, "left": 0.03, "right": 0.97, "bottom": 0.01, "top": 0.92}
SMALL = {"fontsize": 9, "fontweight": "normal", "loc": "center"}  # titles


def frames(results: Results) -> Figure:
    """Rendered frames with their displacement, above the faces and errors of all frames."""
    path = require_file(results.folder("scene") / "pictures.npz", "no data/scene/pictures.npz", "scene")
    arrays = read_arrays(path)
    rows, scene, tolerance, unit = scene_rows(results, metric=["faces", "error"], factor=1, item=None)
    rows = rows[rows["matched"].isin(["", "error"])]  # plans equal to ours, or for themselves
    rows = rows[rows["frame"] != "all"].astype({"frame": int})
    methods, frames = [str(method) for method in arrays["methods"]], arrays["frames"]
    brightest = tolerance if unit == "pixels" else 1.0  # displacement in pixels
    figure = plt.figure(figsize=(12, ROW * len(frames) + CHART))
    pictures, charts = figure.subfigures(2, 1, squeeze=False, height_ratios=[ROW * len(frames), CHART]).flat
    bare = {"squeeze": False, "gridspec_kw": GRID, "subplot_kw": {"xticks": [], "yticks": []}}
    grid = pictures.subplots(len(frames), 2 * len(methods) - 1, **bare)
    for line, frame, rgb, displacement in zip(grid, frames, arrays["rgb"], arrays["displacement"], strict=True):
        numbers = rows[rows["frame"] == frame].pivot_table(index="method", columns="metric", values="value")
        box = _box(rgb[0])
        for axes, picture, method in zip(line, rgb, methods, strict=False):
            axes.imshow(picture[box])
            caption = f"{numbers.loc[method, 'faces']:,.0f} faces, error {number(numbers.loc[method, 'error'])}"
            axes.set_title(f"{NAMES[method]}\n{caption}", **SMALL)
        for axes, values, method in zip(line[len(methods) :], displacement[1:], methods[1:], strict=True):
            axes.set_facecolor("#dddddd")
            axes.imshow(values[box].astype(float), cmap="inferno", vmin=0, vmax=brightest, interpolation="nearest")
            axes.set_title(f"displacement,\n{NAMES[method]}", **SMALL)
        for axes in line:
            axes.spines[:].set_visible(False)
        line[0].set_ylabel(f"frame {frame}")
    _charts(charts, rows, tolerance, unit)
    words = {"scene": scene, "methods": ", ".join(NAMES[method] for method in methods), "brightest": f"{brightest:g}"}
    return Figure(figure, words, dpi=110)


def _box(picture: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns round what the full frame shows, in the shape of the screen."""
    h, w, _ = picture.shape
    down, across = np.nonzero((picture > 0).any(axis=2))
    if not len(down):
        return slice(None), slice(None)
    tall = min(max(np.ptp(down) + 2 * MARGIN, (np.ptp(across) + 2 * MARGIN) * h / w), h)
    wide = int(tall * w / h)
    top = int(np.clip((down.min() + down.max() - tall) // 2, 0, h - tall))
    left = int(np.clip((across.min() + across.max() - wide) // 2, 0, w - wide))
    return slice(top, top + int(tall)), slice(left, left + wide)


def _charts(figure: SubFigure, rows: pd.DataFrame, tolerance: float, unit: str) -> None:
    left, right = figure.subplots(1, 2, gridspec_kw={"left": 0.06, "right": 0.97, "bottom": 0.3, "top": 0.95})
    for axes, metric in ((left, "faces"), (right, "error")):
        for method in [name for name in DRAWN if name in set(rows["method"])]:
            line = rows[(rows["method"] == method) & (rows["metric"] == metric)].sort_values("frame")
            axes.plot(line["frame"], line["value"], ".-", color=COLOURS[method], lw=1.4, ms=4, label=NAMES[method])
        axes.set_xlabel("frame")
        axes.grid(axis="y")
    left.set(yscale="log", ylabel="faces of the frame")
    right.axhline(tolerance, color=INK, ls=":", lw=1)
    right.set(ylabel=f"error of the frame, {unit}", ylim=(0, None))
    handles, names = left.get_legend_handles_labels()
    figure.legend(handles, names, fontsize=9, labelcolor=INK, ncols=len(names), loc="lower center")

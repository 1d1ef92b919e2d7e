"""Frames of the scene: full, uniform and our levels side by side, where they differ, and all frames of the path."""

import numpy as np
import pandas as pd
from matplotlib.figure import SubFigure

from haptic_glance.base.files import read_arrays
from stages.report.items import Figure
from stages.report.markdown import number
from stages.report.results import Results, there
from stages.report.style import INK, plt

from .rows import COLOURS, NAMES, OURS, scene_rows

MARGIN = 8  # pixels round the objects
DRAWN = ("full", "uniform", "uniform_size", "network", OURS)
ROW, CHART = 1.95, 2.9  # inches
GRID = {"wspace": 0.04, "hspace": 0.3, "left": 0.03, "right": 0.97, "bottom": 0.01, "top": 0.92}
SMALL = {"fontsize": 9, "fontweight": "normal", "loc": "center"}  # titles


def build(results: Results) -> Figure:
    """Rendered frames with their displacement, above the faces and errors of all frames."""
    path = there(results.folder("scene") / "pictures.npz", "no data/scene/pictures.npz", "scene")
    stored = read_arrays(path)
    rows, scene, tolerance, unit = scene_rows(results, metric=["faces", "error"], factor=1, item=None)
    rows = rows[rows["matched"].isin(["", "error"])]  # plans equal to ours, or for themselves
    rows = rows[rows["frame"] != "all"].astype({"frame": int})
    methods, frames = [str(method) for method in stored["methods"]], stored["frames"]
    brightest = tolerance if unit == "pixels" else 1.0  # displacement in pixels
    figure = plt.figure(figsize=(12, ROW * len(frames) + CHART))
    pictures, charts = figure.subfigures(2, 1, squeeze=False, height_ratios=[ROW * len(frames), CHART]).flat
    bare = {"squeeze": False, "gridspec_kw": GRID, "subplot_kw": {"xticks": [], "yticks": []}}
    grid = pictures.subplots(len(frames), 2 * len(methods) - 1, **bare)
    for line, frame, rgb, displacement in zip(grid, frames, stored["rgb"], stored["displacement"], strict=True):
        said = rows[rows["frame"] == frame].pivot_table(index="method", columns="metric", values="value")
        box = _box(rgb[0])
        for axes, picture, method in zip(line, rgb, methods, strict=False):
            axes.imshow(picture[box])
            measured = f"{said.loc[method, 'faces']:,.0f} faces, error {number(said.loc[method, 'error'])}"
            axes.set_title(f"{NAMES[method]}\n{measured}", **SMALL)
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

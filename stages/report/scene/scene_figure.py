"""Frames of the scene: full, uniform and our levels side by side, where they differ, and all frames of the path."""

import numpy as np

from stages.kit.files import read_arrays
from stages.report.items import Figure
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.report.style import INK, plt, save

from .rows import COLOURS, NAMES, OURS, at_tolerance, of_scene, scene_rows

MARGIN = 8  # pixels round the objects
DRAWN = ("full", "uniform", "uniform_size", "network", OURS)
ERROR_MAP = "inferno"
ROW, CHART = 1.95, 2.9  # inches
GRID = {"wspace": 0.04, "hspace": 0.3, "left": 0.03, "right": 0.97, "bottom": 0.01, "top": 0.92}


def build(results: Results) -> Figure:
    path = results.folder("scene") / "pictures.npz"
    if not path.exists():
        raise NotRun("no data/scene/pictures.npz", "scene")
    stored = read_arrays(path)
    rows = at_tolerance(scene_rows(results, metric=["faces", "error"]))
    scene, tolerance, unit = of_scene(rows)
    rows = rows[(rows["frame"] != "all") & rows["item"].isna()].astype({"frame": int})
    methods = [str(method) for method in stored["methods"]]
    height = ROW * len(stored["frames"])
    figure = plt.figure(figsize=(12, height + CHART))
    pictures, charts = figure.subfigures(2, 1, height_ratios=[height, CHART])
    grid = pictures.subplots(len(stored["frames"]), 2 * len(methods) - 1, squeeze=False, gridspec_kw=GRID)
    for k, (line, frame) in enumerate(zip(grid, stored["frames"], strict=True)):
        _frame(line, stored, k, methods, rows[rows["frame"] == frame], tolerance, unit)
        line[0].set_ylabel(f"frame {frame}")
    _charts(charts, rows, tolerance, unit)
    out = save(figure, results.reports / "figures/scene.png", dpi=110)
    names = ", ".join(NAMES[method] for method in methods)
    return Figure(
        f"Scene {scene}: no more faces than the frame needs",
        f"Rendered frames of scene {scene} with {names}, their displacement, and faces and error over the frames.",
        f"Left: rendered frames, cut to the objects. Right, black to yellow: displacement from the full frame, 0 to "
        f"{_top(tolerance, unit):g} px. Below: every frame of the path; the uniform levels are tuned to our mean error "
        "of the rendered frames. Dotted: the tolerance.",
        [out],
    )


def _frame(line, stored, k, methods, rows, tolerance, unit):
    box = _box(stored["rgb"][k, 0])
    said = rows.pivot_table(index="method", columns="metric", values="value")
    for axes, picture, method in zip(line, stored["rgb"][k], methods, strict=False):
        axes.imshow(picture[box])
        measured = f"{said.loc[method, 'faces']:,.0f} faces, error {number(said.loc[method, 'error'])}"
        axes.set_title(f"{NAMES[method]}\n{measured}", fontsize=9, fontweight="normal", loc="center")
    for axes, values, method in zip(line[len(methods) :], stored["displacement"][k, 1:], methods[1:], strict=True):
        axes.set_facecolor("#dddddd")
        top = _top(tolerance, unit)
        axes.imshow(values[box].astype(float), cmap=ERROR_MAP, vmin=0, vmax=top, interpolation="nearest")
        axes.set_title(f"displacement,\n{NAMES[method]}", fontsize=9, fontweight="normal", loc="center")
    for axes in line:
        axes.set_xticks([])
        axes.set_yticks([])
        axes.spines[:].set_visible(False)


def _top(tolerance, unit):
    """The displacement in pixels that the brightest colour stands for."""
    return tolerance if unit == "pixels" else 1.0


def _box(picture):
    """Rows and columns round what the full frame shows, in the shape of the screen."""
    h, w, _ = picture.shape
    filled = (picture > 0).any(axis=2)
    down, across = np.flatnonzero(filled.any(axis=1)), np.flatnonzero(filled.any(axis=0))
    if not len(down):
        return slice(None), slice(None)
    tall = min(max(np.ptp(down) + 2 * MARGIN, (np.ptp(across) + 2 * MARGIN) * h / w), h)
    wide = int(tall * w / h)
    top = int(np.clip((down[0] + down[-1] - tall) // 2, 0, h - tall))
    left = int(np.clip((across[0] + across[-1] - wide) // 2, 0, w - wide))
    return slice(top, top + int(tall)), slice(left, left + wide)


def _charts(figure, rows, tolerance, unit):
    left, right = figure.subplots(1, 2, gridspec_kw={"left": 0.06, "right": 0.97, "bottom": 0.3, "top": 0.95})
    for axes, metric in ((left, "faces"), (right, "error")):
        for method in [name for name in DRAWN if name in set(rows["method"])]:
            line = rows[(rows["method"] == method) & (rows["metric"] == metric)].sort_values("frame")
            axes.plot(line["frame"], line["value"], ".-", color=COLOURS[method], lw=1.4, ms=4, label=NAMES[method])
        axes.set_xlabel("frame")
        axes.grid(axis="y")
    left.set_yscale("log")
    left.set_ylabel("faces of the frame")
    right.axhline(tolerance, color=INK, ls=":", lw=1)
    right.set_ylabel(f"error of the frame, {unit}")
    right.set_ylim(bottom=0)
    handles, names = left.get_legend_handles_labels()
    figure.legend(handles, names, fontsize=9, labelcolor=INK, ncols=len(names), loc="lower center")

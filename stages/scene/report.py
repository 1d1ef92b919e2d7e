"""How many faces each object of a scene needs (T3.1.3)."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import SubFigure

from haptic_glance.base.files import read_arrays
from stages.charts.datasets import SECTION_3_1
from stages.charts.drawing import GREY, INK, plt
from stages.charts.items import Figure, Table
from stages.charts.pareto import pareto_chart
from stages.charts.results import Results, require_file
from stages.charts.tables import grouped, interval_columns, number, percent, records, with_interval
from stages.engine.statistics import interval

NAMES = {
    "full": "full models",
    "uniform": "uniform levels by distance",
    "uniform_size": "uniform levels by size on the screen",
    "network": "the thesis's network",
    "ours_plain": "ours, salience left out",
    "ours": "ours",
}
COLOURS = {
    "full": "#222222", "uniform": "#E69F00", "uniform_size": "#D55E00", "network": "#CC79A7", "ours_plain": "#56B4E9",
    "ours": "#0072B2",
}  # fmt: skip
UNITS = {"pixels": "pixels", "ssim": "1 − SSIM"}
OURS = "ours"


def scene_rows(results: Results, **where: Any) -> tuple[pd.DataFrame, str, float, str]:
    """(rows of the stage with a value and no gaps in `matched`, the scene, the first tolerance, its unit in words)."""
    rows = results.measured("scene", **where).fillna({"matched": ""})
    first = rows.dropna(subset=["tolerance"]).iloc[0]
    return rows, first["group"], float(first["tolerance"]), UNITS[first["kind"]]


def amount(value: float, unit: str) -> str:
    """A tolerance in words: 1 pixel, 0.5 pixels."""
    return f"{value:g} {unit.removesuffix('s') if value == 1 else unit}"


def savings(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows on the share of the faces that ours saves: value, low, high, the `rival`, and in per cent as `text`."""
    saved = rows[rows["metric"].str.startswith("saved_")].dropna(subset=["kind", "value"])
    text = [with_interval(row.value, row.low, row.high, 100, 0) for row in records(saved)]
    return saved.assign(rival=saved["metric"].str.removeprefix("saved_"), text=text)


EQUAL_IN = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
           "asked": "nothing: as it answers"}  # fmt: skip
COLUMNS = {
    "faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame", "held": "frames within, %",
    "displacement_mean": "displacement, mean px", "displacement_99.9": "99.9 %, px",
    "salient_displacement": "where one looks, px", "ssim_error": "1 − SSIM of the frames", "step_worst": "worst jump",
    "planning_ms": "planning, ms a frame",
}  # fmt: skip
ANSWER, SAVED = ("faces", "error", "error_worst", "held", "displacement_mean"), "faces that ours saves, %"
EQUAL = {"": "", "displacement": "mean displacement", "error": "worst object's error"}  # of the chart
REFERENCE = "full"


def scene_table(results: Results) -> Table:
    """A line for each way to choose levels and what was made equal to ours."""
    rows, scene, tolerance, unit = scene_rows(results, frame="all", factor=1, item=None)
    wide = rows.pivot_table(index=["method", "matched"], columns="metric", values="value", sort=False)
    wide["seconds"] = rows.groupby(["method", "matched"])["seconds"].max()
    wide, saved = wide[wide["faces"].notna()], savings(rows)
    text = {(row.rival, row.matched): row.text for row in records(saved)}
    text_table = wide.reindex(columns=list(COLUMNS)).assign(faces=wide["faces"].round())
    text_table = text_table.assign(held=text_table["held"].map(percent)).map(number).rename(columns=COLUMNS)
    text_table[SAVED] = [text.get(key, "–") for key in wide.index]
    text_table = text_table.assign(seconds=wide["seconds"].map(number)).replace({"0.000": "0"})
    text_table = text_table.rename(NAMES, level="method").rename(EQUAL_IN, level="matched")
    text_table = text_table.rename_axis(["levels chosen by", "equal to ours in"]).reset_index()
    notes = results.rows("scene", frame="all", factor=1).dropna(subset=["note"]).drop_duplicates(["method", "note"])
    words = {
        "scene": scene,
        "tolerance": amount(tolerance, unit),
        "noted": "\n".join(f"{NAMES.get(row.method, row.method)}: {row.note}." for row in records(notes)),
    }
    answer = ["levels chosen by", "equal to ours in", *(COLUMNS[name] for name in ANSWER), SAVED]
    return Table(wide.reset_index(), text_table, words, answer=answer, keys=answer[:2])


def chart(results: Results) -> Figure:
    """The error of the rendered frames against the faces that they take, by every way to choose the levels."""
    rows = results.measured("scene", frame="all", metric=["faces", "error"])
    rows = rows.fillna({"matched": ""})
    rows = rows[rows["matched"].isin(EQUAL) & rows["method"].isin(NAMES)].dropna(subset=["tolerance"])
    unit, scenes = UNITS[rows["kind"].iloc[0]], list(dict.fromkeys(rows["group"]))
    lines, errors = [], {}
    for (tolerance, method, matched), group in grouped(rows, ["tolerance", "method", "matched"]):
        way = NAMES[method]
        name = way if method == REFERENCE else ", ".join(filter(None, (way, amount(tolerance, unit), EQUAL[matched])))
        wide = group.pivot(index="group", columns="metric", values="value")
        errors[name], ends = wide["error"], interval_columns("error", interval(wide["error"]), prefix="")
        lines.append({"method": method, "way": way, "name": name, "tolerance": tolerance, "matched": EQUAL[matched],
                      "faces": wide["faces"].mean(), **ends})  # fmt: skip
    frame = pd.DataFrame(lines).sort_values("tolerance", kind="stable").drop_duplicates("name")
    marker = "tolerance" if frame["tolerance"].nunique() > 1 else "matched"
    frame["tolerance"] = [amount(value, unit) for value in frame["tolerance"]]
    frame["matched"] = frame["matched"].replace("", "nothing: as planned")
    subject = f"{len(scenes)} random scenes" if len(scenes) > 1 else f"Scene {scenes[0]}"
    return pareto_chart(
        frame, "error", title=f"{subject}: faces against what shows", reference=NAMES[REFERENCE],
        quality_label=f"error of the rendered frames, mean, {unit}", cost="faces", better="low", colour="way",
        marker=marker, clock="", units=pd.DataFrame(errors),
        legends={"matched": "equal to ours in", "faces": "faces a frame"},
        tints={name: COLOURS.get(method, GREY) for method, name in NAMES.items() if method in set(frame["method"])},
    )  # fmt: skip


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
    answer = ["asked about", "model", "off by (half)", *(METRICS[name][0] for name in ("within", "excess", "waste"))]
    words = {"costs": "; ".join(texts) or "not measured"}
    return Table(rows, text_table, words, answer=answer, keys=answer[:2])


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
    return Figure(figure, dpi=110)


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


PAGE = "simplify"
TABLES = {
    "scene": scene_table,
    "face_counts": counts_table,
}
FIGURES = {
    "scene": frames,
}
CHARTS = {
    "scene": chart,
}

"""Errors of simplified meshes by method, as figures, and by cost, as a chart.

T figures 3.4, 3.5 and 3.23 show channels, detectors and the methods of T3.2 as dots and boxes. `simplification` draws
error against the seconds to find the points and to simplify, with a front at each share of the faces.
"""

from itertools import product

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from stages.charts.datasets import SECTION_3_1, dataset_text
from stages.charts.drawing import (
    CYCLE,
    GREY,
    INK,
    MARKERS,
    METHOD_COLOURS,
    PALE,
    WAYS,
    colours,
    label,
    plain_logarithm,
    plt,
)
from stages.charts.items import Figure
from stages.charts.pareto import ON, attention_seconds, noise_by, placed
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import means
from stages.engine.statistics import interval
from stages.lod.error_tables import (  # fmt: skip
    CLASSICAL,
    COMBINATIONS,
    ERRORS,
    FEWEST,
    FIXED_ADAPTIVE,
    HKS,
    METRICS,
    OURS,
    PLAIN,
    PROPOSED,
    RIVALS,
    UNITS,
    WEIGHTED,
    by_object,
    face_counts,
    is_drawn,
    ordered,
    paired_cells,
    rows_by_set,
    short,
    size,
    target_text,
)

SPREAD = {"metro_mean": "mean", "metro_rms": "rms", "metro_max": "max"}
APART = (-0.24, 0.0, 0.24)  # rows between the dots of one method in one panel
TITLES = ["(a) Metro, %", "(b) Metro mean, %", "(c) 1 − SSIM, %", "(d) DLap", "(e) Dnor", "(f) points"]
BOXES = [*FIXED_ADAPTIVE, OURS, f"{OURS}-adaptive", f"{OURS}-soft", "VisAttAll", HKS, *RIVALS, PLAIN]
TINTS = dict.fromkeys(BOXES, GREY) | dict.fromkeys(FIXED_ADAPTIVE, "#D55E00")  # the methods of T3.2; below: ours
TINTS |= {method: METHOD_COLOURS[OURS] for method in BOXES if method.startswith(OURS)}
TARGETS = ("1500", "3000")  # of the boxes
GAP = 0.12  # inches beside each panel of the boxes: closer, numbers of two axes would touch
FLOOR = 1e-3  # of plain QEM's median: an axis begins there, since some meshes are exact


def figure_3_4(results: Results) -> Figure:
    """Metro and SSIM error by combination of channels, a panel for each of up to three face counts."""
    rows = paired_cells(results.rows("lod", results.printed(SECTION_3_1, "lod")), methods=COMBINATIONS)
    methods, targets = [name for name in COMBINATIONS if name in set(rows["method"])], face_counts(rows)[:3]
    if CLASSICAL not in methods or len(methods) < 2 or not targets:
        raise NotRun(f"no face count that all of two combinations reach on {FEWEST} objects", "lod", runnable=False)
    cells = list(product(METRICS, targets))
    size = (1.5 + 1.6 * len(cells), 0.8 + 0.19 * len(methods))
    drawing, panels = plt.subplots(1, len(cells), figsize=size, sharey=True)
    for axes, (metric, target) in zip(panels, cells, strict=True):
        _draw_dots(axes, by_object(rows, methods, metric, target), CYCLE[METRICS.index(metric)], CLASSICAL)
    _dress(drawing, [f"{ERRORS[metric]}\n{target_text(target)}" for metric, target in cells], methods)
    objects = rows.groupby("target")["item"].nunique()
    object_counts = ", ".join(f"{target_text(target)}: {objects[target]} objects" for target in targets)
    words = {"methods": ", ".join(map(short, methods)), "counts": len(targets), "classical": short(CLASSICAL)}
    return Figure(drawing, words | {"over": object_counts}, dpi=100)


def figure_3_5(results: Results) -> Figure:
    """Six panels, a row each method: distances, the same by face count, errors as seen, number of points."""
    rows = results.rows("lod", results.printed(SECTION_3_1, "lod"))
    rows = paired_cells(rows, methods=filter(is_drawn, set(rows["method"])))
    methods, targets = ordered(set(rows["method"])), face_counts(rows)[:2]
    if PLAIN not in methods or len(methods) < 3:
        raise NotRun("no face count that plain QEM and two other methods reach", "lod", runnable=False)
    drawing, panels = plt.subplots(1, 6, figsize=(11.4, 1.1 + 0.185 * len(methods)), sharey=True)
    for metric, tint, down in zip(SPREAD, CYCLE, APART, strict=False):
        _draw_dots(panels[0], by_object(rows, methods, metric), tint, PLAIN, SPREAD[metric], down)
    for target, tint, down in zip(targets, CYCLE[3:], APART, strict=False):
        errors = by_object(rows, methods, "metro_mean", target)
        _draw_dots(panels[1], errors, tint, PLAIN, target_text(target).removesuffix(" faces"), down)
    for axes, metric in zip(panels[2:5], ("ssim_error", "dlap", "dnor"), strict=True):
        _draw_dots(axes, by_object(rows, methods, metric), CYCLE[0], PLAIN)
    _draw_dots(panels[5], rows.pivot_table(index="item", columns="method", values="points")[methods], CYCLE[0])
    panels[0].set_xscale("log")
    panels[0].xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    _dress(drawing, TITLES, methods, pad=20)
    objects = rows.groupby("target")["item"].nunique()
    object_counts = ", ".join(f"{objects[target]} at {target_text(target)}" for target in targets)
    words = {"methods": ", ".join(map(short, methods)), "objects": rows["item"].nunique(), "over": object_counts}
    return Figure(drawing, words, dpi=100)


def figure_3_23(results: Results) -> Figure:
    """A row of panels for each data set, a panel for each error and face count, a box for each method."""
    by_set = {
        dataset_text(name): paired_cells(rows, METRICS, BOXES) for name, rows in rows_by_set(results, PROPOSED).items()
    }
    by_set = {name: rows[rows["target"].isin(set(TARGETS) & set(face_counts(rows)))] for name, rows in by_set.items()}
    groups = {name: rows for name, rows in by_set.items() if PLAIN in set(rows["method"])}
    require_rows(
        groups, "no data set with enough objects that all methods take to 1,500 or 3,000 faces", "lod", runnable=False
    )
    boxes = {name: [method for method in BOXES if method in set(rows["method"])] for name, rows in groups.items()}
    heights = [0.9 + 0.17 * len(methods) for methods in boxes.values()]  # of a title, the boxes and an axis
    drawing, grid = plt.subplots(
        len(groups), 4, figsize=(10.4, sum(heights)), squeeze=False, sharey="row", height_ratios=heights,
        layout=ConstrainedLayoutEngine(w_pad=GAP),
    )  # fmt: skip
    for row, (name, rows) in zip(grid, groups.items(), strict=True):
        for axes, (metric, target) in zip(row, product(METRICS, TARGETS), strict=True):
            errors = by_object(rows, boxes[name], metric, target)
            _draw_boxes(axes, errors)
            title = f"{ERRORS[metric]}, {target_text(target)}\n{len(errors)} objects"
            axes.set_title(title, fontsize=8.5, fontweight="normal", pad=4)
        row[0].set_title(f"{name}\n{row[0].get_title('left')}", fontsize=8.5, fontweight="normal", pad=4)
        _name_rows(row[0], boxes[name], TINTS, 8)
    methods = [method for method in BOXES if any(method in group for group in boxes.values())]
    return Figure(drawing, {"methods": ", ".join(map(short, methods)), "sets": " and ".join(groups)}, dpi=95)


def _draw_boxes(axes: Axes, errors: pd.DataFrame) -> None:
    """Draws the errors objects x methods as boxes, the first method on top."""
    tints, y, plain = [TINTS[str(method)] for method in errors], np.arange(errors.shape[1]), errors[PLAIN].median()
    axes.set_xscale("log")
    if plain > 0:  # a data set may not reach a face count
        quantiles = errors.clip(lower=FLOOR * plain).quantile([0.05, 0.25, 0.5, 0.75, 0.95])
        low, left, middle, right, high = quantiles.to_numpy()
        axes.hlines(y, low, high, color=tints, lw=0.9, capstyle="projecting", zorder=2)
        axes.barh(y, right - left, 0.62, left, color=tints, alpha=0.45)
        axes.plot([middle, middle], [y - 0.31, y + 0.31], color=INK, lw=1.3)
        axes.axvline(plain, color=GREY, lw=0.9, ls="--", zorder=0.9)  # above the grid, below the boxes
        axes.set_xlim(left=max(FLOOR * plain, 0.7 * low.min()))
    low, high = axes.get_xlim()
    if high < 100 * low:
        plain_logarithm(axes.xaxis)  # powers of ten alone would name one place of the axis
    else:
        axes.xaxis.set_major_locator(LogLocator(numticks=4))
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="x", labelsize=8, which="both")
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=PALE, lw=0.5)


def _draw_dots(axes: Axes, table: pd.DataFrame, tint: str, base: str = "", name: str = "", down: float = 0) -> None:
    """Draws the means of a frame objects x methods as dots, the first method on top; nothing of an empty one.

    base: the method, dashed, from which a line about each dot is the 95 % interval of the paired difference; "": the
    interval of the mean itself. down: how far below the middle of its row a dot is drawn, where there are several.
    """
    if table.empty:
        return
    zero, middle = (table[base], table[base].mean()) if base else (0.0, 0.0)
    mean, low, high = middle + np.transpose([interval(table[method] - zero) for method in table])
    y = np.arange(len(mean)) + down
    axes.plot([low, high], [y, y], color=tint, lw=1.6, alpha=0.5)
    axes.plot(mean, y, "o", color=tint, ms=4.2, mec="white", mew=0.5)
    if base:
        axes.axvline(middle, color=tint, lw=0.9, ls="--", zorder=1)  # above the grid
    if name:
        axes.plot([], [], "o", color=tint, ms=4, label=name)
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.99), ncols=3, fontsize=8, handletextpad=0,
                    columnspacing=0.6, borderpad=0.2)  # fmt: skip


def _dress(drawing: Drawing, titles: list[str], methods: list[str], pad: float = 6) -> None:
    """Titles above the panels of a row, names of the methods at the left, ours and plain QEM in their colours."""
    for axes, title in zip(drawing.axes, titles, strict=True):
        axes.set_title(title, fontsize=9.5, fontweight="normal", pad=pad)
        axes.grid(axis="x")
        if axes.get_xscale() == "linear":
            axes.xaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
        axes.hlines(range(len(methods)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        axes.tick_params(axis="x", labelsize=8)
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
    _name_rows(drawing.axes[0], methods, {OURS: METHOD_COLOURS[OURS], PLAIN: GREY}, 8.5)
    drawing.subplots_adjust(wspace=0.28)  # closer, numbers of two axes would touch


def _name_rows(axes: Axes, methods: list[str], tints: dict[str, str], size: float) -> None:
    """Short names of the methods at the left of their rows, the first on top, in these colours."""
    axes.set_yticks(range(len(methods)), [short(method) for method in methods], fontsize=size)
    axes.set_ylim(len(methods) - 0.4, -0.6)
    for text, method in zip(axes.get_yticklabels(), methods, strict=True):
        text.set_color(tints.get(method, INK))


# As many as have a colour of their own; the other methods are in figures 3.4 and 3.5.
METHODS = [PLAIN, OURS, f"{OURS}-soft", CLASSICAL, WEIGHTED, f"{WEIGHTED}-adaptive", "random", HKS]
DRAWN = (*METRICS, "salient_error")


def simplification(results: Results) -> Figure:
    """Three errors against cost as a ratio to plain QEM, with a front for each share of the faces."""
    rows = paired_cells(results.rows("lod"), DRAWN, METHODS)
    rows = rows[rows["target"].str.endswith("%")]
    if PLAIN not in set(rows["method"]):
        message = "no share of the faces that plain QEM and all methods reach on the same object"
        raise NotRun(message, "lod", runnable=False)
    frame = _costed(rows, attention_seconds(results), noise_by(results.clock("lod")))
    targets = sorted(set(frame["target"]), key=size)
    objects = rows.groupby("target")["item"].nunique()
    plain = frame.query("method == @PLAIN and target == @targets[0]")["seconds"].iloc[0]
    words = {
        "methods": ", ".join(map(label, frame["method"].unique())), "targets": ", ".join(targets),
        "milliseconds": 1000 * plain, "first": targets[0],
        "over": ", ".join(f"{target}: {objects[target]} objects" for target in targets),
    }  # fmt: skip
    return Figure(_draw(frame, targets), words, frame, dpi=100)


def _costed(rows: pd.DataFrame, search: dict[str, float], noise: float) -> pd.DataFrame:
    """A row a metric, method and share: mean error in its unit, cost with the seconds of the search, and front."""
    frame = pd.DataFrame(means(rows, ["metric", "method", "target"]))
    base = frame["method"].str.replace(f"-({'|'.join(WAYS)})$", "", regex=True)
    frame = frame.assign(looked=base.map({**search, PLAIN: 0.0})).dropna(subset=["looked"])
    plain = frame["seconds"].where(frame["method"] == PLAIN).groupby([frame["metric"], frame["target"]])
    frame["seconds"] += frame["looked"]
    frame["cost_ratio"] = frame["seconds"] / plain.transform("first")
    ends = ["mean", "low", "high"]
    frame[ends] = frame[ends].mul(frame["metric"].map(UNITS), axis=0)
    for _, group in frame.groupby(["metric", "target"]):
        frame.loc[group.index, "on_front"] = placed(group, "cost_ratio", "mean", "low", noise)["on_front"] == ON
    return frame.astype({"on_front": bool})


def _draw(frame: pd.DataFrame, targets: list[str]) -> Drawing:
    tints = colours([method for method in METHODS if method in set(frame["method"])])
    forms = dict(zip(targets, MARKERS, strict=False))
    metrics = [metric for metric in DRAWN if metric in set(frame["metric"])]
    drawing, panels = plt.subplots(1, len(metrics), figsize=(4.0 * len(metrics), 4.2), squeeze=False)
    for axes, metric in zip(panels[0], metrics, strict=True):
        panel = frame[frame["metric"] == metric]
        for _, group in panel[panel["on_front"]].sort_values("cost_ratio").groupby("target"):
            ends = [*group["cost_ratio"], panel["cost_ratio"].max()]
            axes.step(ends, [*group["mean"], group["mean"].iloc[-1]], where="post", color=INK, lw=0.9, zorder=1)
        columns = panel[["method", "target", "cost_ratio", "mean", "low", "high"]]
        for method, target, cost, mean, *ends in columns.itertuples(index=False):
            axes.plot([cost] * 2, ends, color=tints[method], lw=1.2, alpha=0.5, zorder=2)
            name = f"_{label(method)}, {target}"
            axes.plot(cost, mean, forms[target], color=tints[method], ms=7, mec="white", mew=0.8, zorder=3, label=name)
        unit = "%" if metric == "ssim_error" else "% of the diagonal"
        axes.set(xscale="log", yscale="log", xlabel=f"cost, as a ratio to {label(PLAIN)}", ylabel=unit)
        axes.set_title(ERRORS[metric].removesuffix(", %"), fontsize=10)
        axes.grid(True)
        axes.margins(x=0.1)
        plain_logarithm(axes.xaxis, (1.0,))
        plain_logarithm(axes.yaxis)
    for method, tint in tints.items():
        axes.plot([], [], "o", color=tint, ms=6, label=label(method))
    for target, form in forms.items():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=f"{target} of the faces")
    axes.plot([], [], color=INK, lw=0.9, label="on the front of a share in 95 % of resamples")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9)
    drawing.subplots_adjust(wspace=0.32)
    return drawing

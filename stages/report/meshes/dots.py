"""T figures 3.4 and 3.5: errors of every combination of channels and of every detector, as rows of dots."""

from collections.abc import Iterable, Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, GREY, INK, METHOD_COLOURS, PALE, plt

from .methods import CLASSICAL, COMBINATIONS, OURS, PLAIN, fixed, ordered, short
from .rows import ERRORS, FEWEST, METRICS, STAGE, by_object, face_counts, paired_cells, said

HELD = {OURS: METHOD_COLOURS[OURS], PLAIN: GREY}  # colours of names
SPREAD = {"metro_mean": "mean", "metro_rms": "rms", "metro_max": "max"}
APART = (-0.24, 0.0, 0.24)  # rows between the dots of one method in one panel
TITLES = ["(a) Metro, %", "(b) Metro mean, %", "(c) 1 − SSIM, %", "(d) DLap", "(e) Dnor", "(f) points"]


def figure_3_4(results: Results) -> Figure:
    """Metro and SSIM error by combination of channels, a panel for each of up to three face counts."""
    rows = paired_cells(results, methods=COMBINATIONS)
    methods, targets = [name for name in COMBINATIONS if name in set(rows["method"])], face_counts(rows)[:3]
    if CLASSICAL not in methods or len(methods) < 2 or not targets:
        raise NotRun(f"no face count that all of two combinations reach on {FEWEST} objects", STAGE, runnable=False)
    cells = [(metric, target) for metric in METRICS for target in targets]
    size = (1.5 + 1.6 * len(cells), 0.8 + 0.19 * len(methods))
    drawing, panels = plt.subplots(1, len(cells), figsize=size, sharey=True, squeeze=False)
    for axes, (metric, target) in zip(panels[0], cells, strict=True):
        _draw(axes, by_object(rows, metric, target), methods, CYCLE[METRICS.index(metric)], CLASSICAL)
    _dress(drawing, [f"{ERRORS[metric]}\n{said(target)}" for metric, target in cells], methods)
    objects = rows.groupby("target")["item"].nunique()
    over = ", ".join(f"{said(target)}: {objects[target]} objects" for target in targets)
    words = {"methods": ", ".join(map(short, methods)), "counts": len(targets), "classical": short(CLASSICAL)}
    return Figure(drawing, words | {"over": over}, dpi=100)


def figure_3_5(results: Results) -> Figure:
    """Six panels, a row each method: distances, the same by face count, errors as seen, number of points."""
    rows = paired_cells(results, methods=filter(fixed, set(results.rows(STAGE)["method"])))
    methods, targets, known = ordered(set(rows["method"])), face_counts(rows)[:2], set(rows["metric"])
    if PLAIN not in methods or len(methods) < 3:
        raise NotRun("no face count that plain QEM and two other methods reach", STAGE, runnable=False)
    drawing, panels = plt.subplots(1, 6, figsize=(11.4, 1.1 + 0.185 * len(methods)), sharey=True)
    spread = [metric for metric in SPREAD if metric in known]
    for metric, tint, down in zip(spread, CYCLE, APART, strict=False):
        _draw(panels[0], by_object(rows, metric), methods, tint, PLAIN, SPREAD[metric], down)
    for target, tint, down in zip(targets, CYCLE[3:], APART, strict=False):
        errors = by_object(rows, "metro_mean", target)
        _draw(panels[1], errors, methods, tint, PLAIN, said(target).removesuffix(" faces"), down)
    for axes, metric in zip(panels[2:5], ("ssim_error", "dlap", "dnor"), strict=True):
        if metric in known:
            _draw(axes, by_object(rows, metric), methods, CYCLE[0], PLAIN)
    _draw(panels[5], rows.pivot_table(index="item", columns="method", values="points"), methods, CYCLE[0])
    panels[0].set_xscale("log")
    panels[0].xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    for axes in panels[:2]:
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.99), ncols=3, fontsize=8, handletextpad=0,
                        columnspacing=0.6, borderpad=0.2)  # fmt: skip
    _dress(drawing, TITLES, methods, pad=20)
    objects = rows.groupby("target")["item"].nunique()
    over = ", ".join(f"{objects[target]} at {said(target)}" for target in targets)
    words = {"methods": ", ".join(map(short, methods)), "objects": rows["item"].nunique(), "over": over}
    return Figure(drawing, words, dpi=100)


def _draw(
    axes: Axes, table: pd.DataFrame, methods: Sequence[str], tint: str, base: str = "", name: str = "", down: float = 0
) -> None:
    """Draws the means of a frame objects x methods as dots, the first method on top.

    base: the method that the others are compared with: a line about each dot is the 95 % interval of the paired
    difference from it, and a dashed line its own mean; "": the line is the interval of the mean itself. down: how
    far below the middle of its row a dot is drawn, where a panel has several a row.
    """
    zero, middle = (table[base], table[base].mean()) if base else (0.0, 0.0)
    for y, method in enumerate(methods):
        mean, low, high = interval(table[method] - zero)
        axes.plot([middle + low, middle + high], [y + down] * 2, color=tint, lw=1.6, alpha=0.5)
        axes.plot(middle + mean, y + down, "o", color=tint, ms=4.2, mec="white", mew=0.5)
    if base:
        axes.axvline(middle, color=tint, lw=0.9, ls="--", zorder=0)
    if name:
        axes.plot([], [], "o", color=tint, ms=4, label=name)


def _dress(drawing: Drawing, titles: Iterable[str], methods: Sequence[str], pad: float = 6) -> None:
    """Titles above the panels of a row, names of the methods at the left, ours and plain QEM in their colours."""
    for axes, title in zip(drawing.axes, titles, strict=True):
        axes.set_title(title, fontsize=9.5, fontweight="normal", pad=pad)
        axes.grid(axis="x")
        axes.hlines(range(len(methods)), 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.4, zorder=0)
        axes.tick_params(axis="y", length=0)
        axes.tick_params(axis="x", labelsize=8)
        axes.spines["left"].set_visible(False)
    name_rows(drawing.axes[0], methods, [HELD.get(method, INK) for method in methods], 8.5)
    drawing.subplots_adjust(wspace=0.12)


def name_rows(axes: Axes, methods: Sequence[str], tints: Sequence[str], size: float) -> None:
    """Short names of the methods at the left of their rows, the first on top, each in its colour."""
    axes.set_yticks(range(len(methods)), [short(method) for method in methods], fontsize=size)
    axes.set_ylim(len(methods) - 0.4, -0.6)
    for text, tint in zip(axes.get_yticklabels(), tints, strict=True):
        text.set_color(tint)

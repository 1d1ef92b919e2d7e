"""How many faces: what each model of the count wastes, where it fails, and what it costs."""

import numpy as np
from matplotlib.ticker import FuncFormatter, NullLocator

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import CYCLE, GREY, INK, MARKERS, plain_logarithm, plt, save

from .face_counts import MODELS, cell

COLOURS = dict(zip(MODELS, CYCLE[1::-1] + CYCLE[2:4], strict=True))
PLACES = {
    "left_out": "objects\nleft out", "coarser": "coarser\nthan known", "finer": "finer\nthan known",
    "larger": "larger\nobjects", "flat": "flat\nsides",
}  # fmt: skip


def build(results: Results) -> Figure:
    rows = results.measured("scene", condition=[*PLACES, "equal_rate", "trained_on", "cost"], method=list(MODELS))
    figure, panels = plt.subplots(2, 2, figsize=(9.6, 7.2))
    _waste(panels[0, 0], rows)
    _failures(panels[0, 1], rows)
    _training(panels[1, 0], rows)
    _costs(panels[1, 1], rows)
    handles, names = panels[0, 1].get_legend_handles_labels()
    figure.tight_layout(h_pad=2, w_pad=2.5, rect=(0, 0.05, 1, 1))
    figure.legend(handles, names, loc="lower center", ncol=4, fontsize=9, columnspacing=1.6)
    path = save(figure, results.reports / "figures/face_counts.png")
    return Figure(
        "How many faces does it need?",
        "Four charts of the models of the face count: wasted faces against the share of cases within the tolerance, "
        "the count over the needed one where models fail, the error against the number of training objects, and "
        "against cost.",
        "Top left: hollow as trained, full times a safety factor found on training objects; lines: 95 % interval over "
        "the objects. Top right: geometric mean of the count over the needed one: below 1 the mesh is too coarse (of "
        "flat sides the coarsest measured mesh stands for it). Bottom: the factor, either way, that 90 % of the counts "
        "stay within. Cost: seconds before the first question, those of building and measuring one "
        "object's whole curve being 1.",
        [path],
    )


def _waste(axes, rows):
    for k, method in enumerate(MODELS):
        ends = [_point(rows, condition, method) for condition in ("left_out", "equal_rate")]
        if None in ends:
            continue
        axes.plot(*zip(*(end[0] for end in ends), strict=True), color=COLOURS[method], lw=1, alpha=0.6)
        for (place, (low, high)), fill in zip(ends, ("white", COLOURS[method]), strict=True):
            axes.plot([place[0]] * 2, [low, high], color=COLOURS[method], lw=1, alpha=0.6)
            axes.plot(*place, MARKERS[k], color=COLOURS[method], mfc=fill, ms=6.5, mew=1.3)
    axes.set_xlabel("cases within the tolerance, %")
    axes.set_ylabel("wasted faces, %")
    axes.set_ylim(bottom=0)
    axes.grid()
    axes.set_title("what keeping to the tolerance costs")


def _point(rows, condition, method):
    """((within, waste), interval of the waste) in per cent; None where it was not measured."""
    within, waste = (cell(rows, condition, method, metric) for metric in ("within", "waste"))
    if within is None or waste is None:
        return None
    return (100 * within["value"], 100 * waste["value"]), (100 * waste["low"], 100 * waste["high"])


def _failures(axes, rows):
    shown = [condition for condition in PLACES if condition in set(rows["condition"])]
    for k, (method, name) in enumerate(MODELS.items()):
        found = [cell(rows, condition, method, "count_bias") for condition in shown]
        x = np.arange(len(shown)) + 0.15 * (k - 1.5)
        value, low, high = ([np.nan if row is None else row[end] for row in found] for end in ("value", "low", "high"))
        axes.vlines(x, low, high, color=COLOURS[method], lw=1.2, alpha=0.6)
        axes.plot(x, value, MARKERS[k], color=COLOURS[method], ms=6, label=name)
    axes.axhline(1, color=INK, lw=0.8, ls=":")
    axes.set_yscale("log")
    axes.set_xticks(range(len(shown)), [PLACES[condition] for condition in shown], fontsize=8.5)
    axes.tick_params(axis="x", length=0)
    axes.set_ylabel("count / needed")
    axes.grid(axis="y")
    axes.set_title("where it fails")
    _factors(axes.yaxis)


def _training(axes, rows):
    for k, method in enumerate(MODELS):
        found = rows[(rows["condition"] == "trained_on") & (rows["method"] == method) & (rows["metric"] == "factor_90")]
        if len(found):
            found = found.sort_values("setting")
            axes.plot(found["setting"], found["value"], color=COLOURS[method], marker=MARKERS[k], ms=5.5, lw=1.4)
            axes.fill_between(found["setting"], found["low"], found["high"], color=COLOURS[method], alpha=0.1, lw=0)
    own = cell(rows, "left_out", "lookup", "factor_90")
    if own is not None:
        axes.axhline(own["value"], color=COLOURS["lookup"], lw=1.4, ls="--")
    axes.set_xlabel("objects trained on (the lookup needs none)")
    axes.set_ylabel("off by (90 % of the counts)")
    axes.set_ylim(1, max(axes.get_ylim()[1], 1.1))
    axes.grid()
    axes.set_title("few objects to learn from")


def _costs(axes, rows):
    for k, method in enumerate(MODELS):
        cost, error = cell(rows, "cost", method, "fit"), cell(rows, "left_out", method, "factor_90")
        if cost is not None and error is not None:
            axes.vlines(cost["value"], error["low"], error["high"], color=COLOURS[method], lw=1.2, alpha=0.6)
            axes.plot(cost["value"], error["value"], MARKERS[k], color=COLOURS[method], ms=7)
    axes.axvline(1, color=GREY, lw=0.6)
    axes.set_xscale("log")
    plain_logarithm(axes.xaxis)
    axes.set_xlabel("cost before the first question / the lookup's")
    axes.set_ylabel("off by (90 % of the counts)")
    axes.set_ylim(1, max(axes.get_ylim()[1], 1.1))
    axes.grid()
    axes.set_title("accuracy against cost")


def _factors(axis):
    """Ticks at factors that a person reads."""
    axis.set_major_locator(plt.FixedLocator([0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 3, 4]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())

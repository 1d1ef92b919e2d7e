"""T3.1.3: how many faces an object needs, told by networks, by less and by more; where they fail, and their cost."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, NullLocator

from stages.report.grid import records
from stages.report.items import Figure, Table
from stages.report.markdown import number, with_interval
from stages.report.results import SECTION_3_1, Results
from stages.report.style import CYCLE, GREY, INK, MARKERS, plain_logarithm, plt

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
PLACES = {
    "left_out": "objects\nleft out", "coarser": "coarser\nthan known", "finer": "finer\nthan known",
    "larger": "larger\nobjects", "flat": "flat\nsides",
}  # fmt: skip
FACTORS = [0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 3, 4]  # ticks that a person reads
LOOKS = dict(zip(MODELS, zip(CYCLE[1::-1] + CYCLE[2:4], MARKERS, strict=False), strict=True))  # colour and marker


def build(results: Results) -> Table:
    """A line for each condition and model, and what the models cost beside the lookup."""
    rows = _measured(results, [*CONDITIONS, "cost"])
    costs = rows[rows["condition"] == "cost"].pivot(index="method", columns="metric", values="value")
    costs = costs.reindex(list(MODELS), columns=["fit", "ask"]).dropna()
    said = [f"{MODELS[row.Index]} {number(row.fit)} and {number(row.ask)}" for row in records(costs)]
    told, keys = rows[rows["metric"].isin(METRICS)], ["condition", "method"]
    text = [with_interval(row.value, row.low, row.high, *METRICS[row.metric][1:]) for row in records(told)]
    wide = told.assign(text=text).pivot(index=keys, columns="metric", values="text").reindex(columns=list(METRICS))
    wide = wide.fillna("–").rename(columns={metric: head for metric, (head, *_) in METRICS.items()})
    wide = wide.join(told.groupby(keys)[["cases", "objects"]].max().astype(int))
    wide = wide.loc[[key for key in pd.MultiIndex.from_product([CONDITIONS, MODELS]) if key in wide.index]]
    wide = wide.rename(CONDITIONS, level="condition").rename(MODELS, level="method")
    shown = wide.rename_axis(["asked about", "model"]).reset_index()
    return Table(rows, shown, {"costs": "; ".join(said) or "not measured"})


def figure(results: Results) -> Figure:
    """What each model of the count wastes, where it fails, how it learns, and what it costs."""
    rows = _measured(results, [*PLACES, "equal_rate", "trained_on", "cost"])
    drawing, panels = plt.subplots(2, 2, figsize=(9.6, 7.2))
    for axes, draw in zip(panels.flat, (_waste, _failures, _training, _costs), strict=True):
        draw(axes, rows)
    for axes in panels[1]:  # factors, from 1 on
        axes.set(ylabel="off by (90 % of the counts)", ylim=(1, max(axes.get_ylim()[1], 1.1)))
        axes.grid()
    drawing.tight_layout(h_pad=2, w_pad=2.5, rect=(0, 0.05, 1, 1))
    explained = panels[0, 1].get_legend_handles_labels()
    drawing.legend(*explained, loc="lower center", ncol=4, fontsize=9, columnspacing=1.6)
    return Figure(drawing)


def _measured(results: Results, conditions: list[str]) -> pd.DataFrame:
    """Rows of the models: of the thesis's fourteen combinations where they were run."""
    return results.measured("scene", results.printed(SECTION_3_1, "scene"), condition=conditions, method=list(MODELS))


def _of(rows: pd.DataFrame, condition: str, metric: str) -> pd.DataFrame:
    """Frame MODELS x (value, low, high), NaN where it was not measured."""
    found = rows[(rows["condition"] == condition) & (rows["metric"] == metric)].set_index("method")
    return found[["value", "low", "high"]].reindex(list(MODELS))


def _waste(axes: Axes, rows: pd.DataFrame) -> None:
    ends = [(100 * _of(rows, name, "within"), 100 * _of(rows, name, "waste")) for name in ("left_out", "equal_rate")]
    for method, (tint, marker) in LOOKS.items():
        x, y = ([end[k]["value"][method] for end in ends] for k in (0, 1))
        axes.plot(x, y, color=tint, lw=1, alpha=0.6)
        for across, up, (_, waste), fill in zip(x, y, ends, ("white", tint), strict=True):
            axes.plot([across] * 2, waste.loc[method, ["low", "high"]], color=tint, lw=1, alpha=0.6)
            axes.plot(across, up, marker, color=tint, mfc=fill, ms=6.5, mew=1.3)
    axes.set(xlabel="cases within the tolerance, %", ylabel="wasted faces, %", ylim=(0, None))
    axes.set_title("what keeping to the tolerance costs")
    axes.grid()


def _failures(axes: Axes, rows: pd.DataFrame) -> None:
    shown = [condition for condition in PLACES if condition in set(rows["condition"])]
    bias = pd.concat([_of(rows, condition, "count_bias") for condition in shown], keys=shown)
    for k, (method, (tint, marker)) in enumerate(LOOKS.items()):
        x, own = np.arange(len(shown)) + 0.15 * (k - 1.5), bias.xs(method, level=1)
        axes.vlines(x, own["low"], own["high"], color=tint, lw=1.2, alpha=0.6)
        axes.plot(x, own["value"], marker, color=tint, ms=6, label=MODELS[method])
    axes.axhline(1, color=INK, lw=0.8, ls=":")
    axes.set_yscale("log")
    axes.yaxis.set(major_locator=FixedLocator(FACTORS), major_formatter="{x:g}", minor_locator=NullLocator())
    axes.set_xticks(range(len(shown)), [PLACES[condition] for condition in shown], fontsize=8.5)
    axes.tick_params(axis="x", length=0)
    axes.set(ylabel="count / needed", title="where it fails")
    axes.grid(axis="y")


def _training(axes: Axes, rows: pd.DataFrame) -> None:
    trained = rows[(rows["condition"] == "trained_on") & (rows["metric"] == "factor_90")].sort_values("setting")
    for method, (tint, marker) in LOOKS.items():
        own = trained[trained["method"] == method]
        axes.plot(own["setting"], own["value"], color=tint, marker=marker, ms=5.5, lw=1.4)
        axes.fill_between(own["setting"], own["low"], own["high"], color=tint, alpha=0.1, lw=0)
    own = _of(rows, "left_out", "factor_90")["value"]["lookup"]
    axes.axhline(own, color=LOOKS["lookup"][0], lw=1.4, ls="--")
    axes.set(xlabel="objects trained on (the lookup needs none)", title="few objects to learn from")


def _costs(axes: Axes, rows: pd.DataFrame) -> None:
    cost, error = _of(rows, "cost", "fit")["value"], _of(rows, "left_out", "factor_90")
    for method, (tint, marker) in LOOKS.items():
        axes.vlines(cost[method], error["low"][method], error["high"][method], color=tint, lw=1.2, alpha=0.6)
        axes.plot(cost[method], error["value"][method], marker, color=tint, ms=7)
    axes.axvline(1, color=GREY, lw=0.6)
    axes.set_xscale("log")
    plain_logarithm(axes.xaxis)
    axes.set(xlabel="cost before the first question / the lookup's", title="accuracy against cost")

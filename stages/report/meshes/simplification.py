"""Simplification: error against the seconds to find the points to keep and to simplify, at each share of the faces."""

import pandas as pd
from matplotlib.figure import Figure as Drawing

from stages.report.costs import attention_seconds
from stages.report.grid import means
from stages.report.items import Figure
from stages.report.pareto import ON, noise_by, placed
from stages.report.results import NotRun, Results
from stages.report.style import INK, MARKERS, WAYS, colours, label, plain_logarithm, plt

from .methods import CLASSICAL, HKS, OURS, PLAIN, WEIGHTED
from .rows import ERRORS, METRICS, UNITS, paired_cells, size

# As many as have a colour of their own; the other methods are in figures 3.4 and 3.5.
METHODS = [PLAIN, OURS, f"{OURS}-soft", CLASSICAL, WEIGHTED, f"{WEIGHTED}-adaptive", "random", HKS]
DRAWN = (*METRICS, "salient_error")


def build(results: Results) -> Figure:
    """Three errors against cost as a ratio to plain QEM, with a front for each share of the faces."""
    rows = paired_cells(results, DRAWN, METHODS)
    rows = rows[rows["target"].str.endswith("%")]
    if PLAIN not in set(rows["method"]):
        raise NotRun("no share of the faces that plain QEM and all methods reach on the same object", "lod")
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
    known = [metric for metric in DRAWN if metric in set(frame["metric"])]
    drawing, panels = plt.subplots(1, len(known), figsize=(4.0 * len(known), 4.2), squeeze=False)
    for axes, metric in zip(panels[0], known, strict=True):
        here = frame[frame["metric"] == metric]
        for _, group in here[here["on_front"]].sort_values("cost_ratio").groupby("target"):
            ends = [*group["cost_ratio"], here["cost_ratio"].max()]
            axes.step(ends, [*group["mean"], group["mean"].iloc[-1]], where="post", color=INK, lw=0.9, zorder=1)
        columns = here[["method", "target", "cost_ratio", "mean", "low", "high"]]
        for method, target, cost, mean, *ends in columns.itertuples(index=False):
            axes.plot([cost] * 2, ends, color=tints[method], lw=1.2, alpha=0.5, zorder=2)
            said = f"_{label(method)}, {target}"
            axes.plot(cost, mean, forms[target], color=tints[method], ms=7, mec="white", mew=0.8, zorder=3, label=said)
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

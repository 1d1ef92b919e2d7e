"""Simplification: error against the seconds to find the points to keep and to simplify, at each share of the faces."""

import pandas as pd

from stages.kit.files import write_table
from stages.report.costs import attention_seconds
from stages.report.grid import means
from stages.report.items import Figure
from stages.report.pareto import pareto_front
from stages.report.results import NotRun, Results
from stages.report.style import INK, MARKERS, WAYS, colours, label, plain_logarithm, plt, save

from .rows import ERRORS, PLAIN, paired_cells, size

METHODS = [  # as many as have a colour of their own; the other methods are in figures 3.4 and 3.5
    PLAIN, "enhanced", "enhanced-soft", "itti", "thesis_ssim", "thesis_ssim-adaptive", "random", "heat_kernel",
]  # fmt: skip
METRICS = ("metro_mean", "ssim_error", "salient_error")
NAME = "simplification"


def build(results: Results) -> Figure:
    rows = paired_cells(results, list(METRICS), METHODS)
    rows = rows[rows["target"].str.endswith("%")]
    if not len(rows) or PLAIN not in set(rows["method"]):
        raise NotRun("no share of the faces that plain QEM and all methods reach on the same object", "lod")
    frame = _costed(rows, attention_seconds(results))
    objects = rows.groupby("target")["item"].nunique()
    targets = sorted(set(frame["target"]), key=size)
    folder = results.reports / "tradeoff"
    folder.mkdir(parents=True, exist_ok=True)
    write_table(folder / f"{NAME}.csv", frame)
    path = _draw(frame, targets, folder / f"{NAME}.png")
    over = ", ".join(f"{target}: {objects[target]} objects" for target in targets)
    plain = frame.loc[(frame["method"] == PLAIN) & (frame["target"] == targets[0]), "seconds"].iloc[0]
    return Figure(
        "Simplifying a mesh to a share of its faces",
        f"Metro mean, SSIM and salient error against cost as a ratio to plain QEM, both logarithmic, for "
        f"{', '.join(map(label, dict.fromkeys(frame['method'])))} at {', '.join(targets)} of the faces.",
        "Down and left is better. Distance, error as seen, and distance where our own model looks. Cost: finding the "
        "points (views, maps, points) "
        f"and simplifying, as a ratio to plain QEM at the same share ({1000 * plain:.2g} ms at {targets[0]}), median "
        f"objects of this run. Lines: the Pareto front of each share. Bars: 95 % intervals over the objects ({over}).",
        [path, folder / f"{NAME}.csv"],
    )


def _costed(rows, search):
    """A row a metric, method and share: the mean error in its unit with its interval, the cost, and the front."""
    frame = pd.DataFrame(means(rows, ["metric", "method", "target"]))
    frame["looked"] = frame["method"].map(lambda method: _looking(method, search))
    frame = frame.dropna(subset=["looked"])
    plain = frame[frame["method"] == PLAIN].set_index(["metric", "target"])["seconds"].rename("plain")
    frame["seconds"] += frame["looked"]
    frame = frame.join(plain, on=["metric", "target"])
    frame["cost_ratio"] = frame["seconds"] / frame.pop("plain")
    for metric, group in frame.groupby("metric"):
        frame.loc[group.index, ["mean", "low", "high"]] *= ERRORS[metric][1]
    for _, group in frame.groupby(["metric", "target"]):
        frame.loc[group.index, "on_front"] = pareto_front(group["cost_ratio"], group["mean"], "low")
    return frame.astype({"on_front": bool})


def _looking(method, search):
    """Seconds to find the points that a method keeps; none for plain QEM, which looks for nothing."""
    base, _, way = method.rpartition("-")
    return 0.0 if method == PLAIN else search.get(base if way in WAYS else method, float("nan"))


def _draw(frame, targets, path):
    found = set(frame["method"])
    tints = colours([method for method in METHODS if method in found])
    forms = dict(zip(targets, MARKERS, strict=False))
    known = [metric for metric in METRICS if metric in set(frame["metric"])]
    figure, panels = plt.subplots(1, len(known), figsize=(4.0 * len(known), 4.2), squeeze=False)
    for axes, metric in zip(panels[0], known, strict=True):
        here = frame[frame["metric"] == metric]
        for _, group in here[here["on_front"]].sort_values("cost_ratio").groupby("target"):
            ends = [*group["cost_ratio"], here["cost_ratio"].max()]
            axes.step(ends, [*group["mean"], group["mean"].iloc[-1]], where="post", color=INK, lw=0.9, zorder=1)
        for row in here.itertuples():
            axes.plot([row.cost_ratio] * 2, [row.low, row.high], color=tints[row.method], lw=1.2, alpha=0.5, zorder=2)
            axes.plot(row.cost_ratio, row.mean, forms[row.target], color=tints[row.method], ms=7, mec="white", mew=0.8,
                      zorder=3)  # fmt: skip
        _dress(axes, "%" if metric == "ssim_error" else "% of the diagonal")
        axes.set_title(ERRORS[metric][0].removesuffix(", %"), fontsize=10)
    for method, tint in tints.items():
        axes.plot([], [], "o", color=tint, ms=6, label=label(method))
    for target, form in forms.items():
        axes.plot([], [], form, color="none", mec=INK, ms=6, label=f"{target} of the faces")
    axes.plot([], [], color=INK, lw=0.9, label="Pareto front of a share")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9)
    figure.subplots_adjust(wspace=0.32)
    return save(figure, path, dpi=100)


def _dress(axes, words):
    axes.set(xscale="log", yscale="log", xlabel=f"cost, as a ratio to {label(PLAIN)}", ylabel=words)
    axes.grid(True)
    axes.margins(x=0.1)
    plain_logarithm(axes.xaxis, (1.0,))
    plain_logarithm(axes.yaxis)

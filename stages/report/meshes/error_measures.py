"""What the error measures need and cost: Metro's samples of the surface, and the pictures' viewpoints."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import grouped
from stages.report.items import Figure
from stages.report.results import Results, some
from stages.report.style import CYCLE, INK, plt

METRO = {  # method -> name, marker, and where its numbers stand: ours lies below and left of the other line
    "metro": ("ours", "o", (-8, -4), "right", "top"),
    "pymeshlab": ("pymeshlab", "s", (8, 4), "left", "bottom"),
}
USUAL, MOST = 10_000, 1_000_000
NAMED = (1000, USUAL, 100_000, MOST)  # samples written beside their point
SAMPLES = "Samples of the surface against the accuracy of Metro's mean error"
SEEN = {"ssim": "1 - SSIM", "dlap": "Laplacian (DLap)", "dnor": "normalised Laplacian (Dnor)"}
CHOSEN = {"four": ("D", "four round the object"), "twelve": ("*", "the twelve of T figure 3.2")}  # sets of stages.views
ASIDE = (0.97, 1.0, 1.03)  # times the views: where the marks of a metric stand, so that their bars are told apart
VIEWS = "Viewpoints against the accuracy of the picture errors"


def samples(results: Results) -> Figure:
    """Error of the mean against time, a line for ours and one for pymeshlab."""
    rows = _rows(results, "samples")
    frame = _typical_samples(rows)
    lines = ours, theirs = [frame[frame["method"] == method].set_index("samples") for method in METRO]
    speed = _rows(results, "speed").pivot_table("seconds", ["mesh", "left"], "method")
    plain, whole = (speed[peer] / speed["metro"] for peer in ("pymeshlab", "pymeshlab, with vertices"))
    words = {
        "title": SAMPLES, "meshes": rows["mesh"].nunique(), "usual": USUAL,
        "ours": 100 * ours["value"][USUAL], "theirs": 100 * theirs["value"][USUAL],
        "same": ours.index[ours["value"] <= theirs["value"][USUAL]].min(), "pairs": len(speed),
        "plain": plain.median(), "least": plain.min(), "most": plain.max(), "whole": whole.median(),
        "million": theirs["seconds"][MOST] / ours["seconds"][MOST],
    }  # fmt: skip
    drawing, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set(xscale="log", yscale="log", ylabel="error of the mean, %")
    axes.set_xlabel(f"time, as a ratio to pymeshlab with {USUAL:,} samples")
    axes.set_title(SAMPLES, pad=12)
    axes.grid(True)
    for line, tint, (name, marker, away, across, up) in zip(lines, CYCLE, METRO.values(), strict=False):
        axes.vlines(line["cost_ratio"], 100 * line["low"], 100 * line["high"], color=tint, lw=1.2, alpha=0.35)
        axes.plot(line["cost_ratio"], 100 * line["value"], marker=marker, color=tint, mec="white", ms=7, label=name)
        for count, cost, value in line.loc[line.index.isin(NAMED), ["cost_ratio", "value"]].itertuples():
            axes.annotate(f"{count:,}", (cost, 100 * value), xytext=away, ha=across, va=up,
                          textcoords="offset points", fontsize=8.5, color=INK)  # fmt: skip
    axes.margins(x=0.1, y=0.1)
    axes.legend(title="samples each way")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    return Figure(drawing, words, frame)


def _typical_samples(rows: pd.DataFrame) -> pd.DataFrame:
    """A row a method and number of samples: geometric means over the meshes; low, high: the best and the worst mesh."""
    logs = rows.assign(value=np.log(rows["value"]), seconds=np.log(rows["seconds"])).groupby(["method", "samples"])
    frame = logs[["value", "seconds"]].mean().assign(low=logs["value"].min(), high=logs["value"].max()).apply(np.exp)
    frame["cost_ratio"] = frame["seconds"] / frame["seconds"]["pymeshlab", USUAL]
    return frame.reset_index().astype({"samples": int})


def views(results: Results) -> Figure:
    """Deviation from the error over all 62 viewpoints against the number of viewpoints, a line a metric."""
    frame = _typical_views(_rows(results, "views"))
    percent = frame.assign(**{name: 100 * frame[name] for name in ("value", "low", "high")})
    drawing, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set(xscale="log", xlabel="viewpoints (lines: chosen by chance among 62)", ylabel="deviation from all 62, %")
    axes.set_title(VIEWS, pad=12)
    axes.grid(True)
    for (metric, name), tint, aside in zip(SEEN.items(), CYCLE, ASIDE, strict=False):
        points = percent[percent["metric"] == metric]
        points = points.assign(views=aside * points["views"])
        axes.vlines(points["views"], points["low"], points["high"], color=tint, lw=1.2, alpha=0.4)
        line = points[points["method"] == "any"].sort_values("views")
        axes.plot(line["views"], line["value"], "o-", color=tint, mec="white", ms=6, label=name)
        for method, (marker, _) in CHOSEN.items():
            one = points[points["method"] == method]
            axes.plot(one["views"], one["value"], marker, color=tint, mec=INK, mew=0.8, ms=10, zorder=4)
    for marker, said in CHOSEN.values():
        axes.plot([], [], marker, color="none", mec=INK, ms=9, label=said)
    ticks = sorted(set(frame["views"]))
    axes.set_xticks(ticks, [f"{tick:.0f}" for tick in ticks])
    axes.minorticks_off()
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=9)
    miss = percent.set_index(["method", "views", "metric"])["value"]
    words = {
        "title": VIEWS, "meshes": frame["meshes"].max(),
        "twelve": ", ".join(f"{name} {miss['twelve', 12, metric]:.1f} %" for metric, name in SEEN.items()),
        "chance": ", ".join(f"{miss['any', 12, metric]:.1f} %" for metric in SEEN),
        "four": miss["four", 4, "ssim"], "any_four": miss["any", 4, "ssim"],
        "milliseconds": 1000 * frame.loc[frame["method"] == "twelve", "seconds"].iloc[0],
    }  # fmt: skip
    return Figure(drawing, words, frame)


def _typical_views(rows: pd.DataFrame) -> pd.DataFrame:
    """A row a metric, way of choosing and number of views: root mean square over the meshes with its interval."""
    keys, found = ["metric", "method", "views"], []
    for key, group in grouped(rows, keys):
        ends = np.sqrt(np.maximum(interval(group["value"] ** 2), 0))
        found.append([*key, *ends, group["seconds"].mean(), len(group)])
    return pd.DataFrame(found, columns=[*keys, "value", "low", "high", "seconds", "meshes"])


def _rows(results: Results, what: str) -> pd.DataFrame:
    rows = results.bench("errors").query("what == @what")
    return some(rows, f"bench/errors.csv has no rows of {what}", "lod", runnable=False)

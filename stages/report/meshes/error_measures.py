"""What the error measures need and cost: Metro's samples of the surface, and the pictures' viewpoints."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import INK, plt

METRO = {"metro": ("ours", "#0072B2", "o"), "pymeshlab": ("pymeshlab", "#D55E00", "s")}
NAMED = (1000, 10_000, 100_000, 1_000_000)  # samples written beside their point
USUAL, MOST = NAMED[1], NAMED[-1]
SAMPLES = "Samples of the surface against the accuracy of Metro's mean error"
SEEN = {"ssim": ("1 - SSIM", "#0072B2"), "dlap": ("Laplacian (DLap)", "#D55E00"),
        "dnor": ("normalised Laplacian (Dnor)", "#009E73")}  # fmt: skip
CHOSEN = {"four": ("D", "four round the object"), "twelve": ("*", "the twelve of T figure 3.2")}  # sets of stages.views
ASIDE = (0.97, 1.0, 1.03)  # times the views: where the marks of a metric stand, so that their bars are told apart
VIEWS = "Viewpoints against the accuracy of the picture errors"


def samples(results: Results) -> Figure:
    """Error of the mean against time, a line for ours and one for pymeshlab."""
    rows = _rows(results, "samples")
    frame = _typical_samples(rows)
    ours, theirs = (frame[frame["method"] == method].set_index("samples") for method in METRO)
    speed = results.bench("errors").query("what == 'speed'").pivot_table("seconds", ["mesh", "left"], "method")
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
    axes.grid(True)
    for method, (name, colour, marker) in METRO.items():
        line = frame[frame["method"] == method].sort_values("samples")
        axes.vlines(line["cost_ratio"], 100 * line["low"], 100 * line["high"], color=colour, lw=1.2, alpha=0.35)
        axes.plot(line["cost_ratio"], 100 * line["value"], marker=marker, color=colour, mec="white", ms=7, label=name)
        # Ours lies below and left of the other line: its numbers stand on the free side.
        side = (-8, -4, "right", "top") if method == "metro" else (8, 4, "left", "bottom")
        named = line.loc[line["samples"].isin(NAMED), ["samples", "cost_ratio", "value"]]
        for count, cost, value in named.itertuples(index=False):
            axes.annotate(f"{count:,}", (cost, 100 * value), xytext=side[:2], ha=side[2], va=side[3],
                          textcoords="offset points", fontsize=8.5, color=INK)  # fmt: skip
    axes.set_xlabel(f"time, as a ratio to pymeshlab with {USUAL:,} samples")
    axes.set_title(SAMPLES, pad=12)
    axes.margins(x=0.1, y=0.1)
    axes.legend(title="samples each way")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    return Figure(drawing, words, frame)


def _typical_samples(rows: pd.DataFrame) -> pd.DataFrame:
    """One row a method and number of samples: geometric means over the meshes, time as a ratio to the peer's usual.

    low, high: the error of the best and of the worst of the few meshes.
    """
    logs = rows.assign(value=np.log(rows["value"]), seconds=np.log(rows["seconds"])).groupby(["method", "samples"])
    frame = logs[["value", "seconds"]].mean().assign(low=logs["value"].min(), high=logs["value"].max())
    frame = frame.apply(np.exp).reset_index().astype({"samples": int})
    usual = frame.loc[(frame["method"] == "pymeshlab") & (frame["samples"] == USUAL), "seconds"]
    return frame.assign(cost_ratio=frame["seconds"] / (usual.iloc[0] if len(usual) else np.nan))


def views(results: Results) -> Figure:
    """Deviation from the error over all 62 viewpoints against the number of viewpoints, a line a metric."""
    frame = _typical_views(_rows(results, "views"))
    drawing, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set(xscale="log", xlabel="viewpoints (lines: chosen by chance among 62)", ylabel="deviation from all 62, %")
    axes.grid(True)
    for (metric, (name, colour)), aside in zip(SEEN.items(), ASIDE, strict=True):
        points = frame[frame["metric"] == metric]
        points = points.assign(views=aside * points["views"])
        line = points[points["method"] == "any"].sort_values("views")
        axes.vlines(points["views"], 100 * points["low"], 100 * points["high"], color=colour, lw=1.2, alpha=0.4)
        axes.plot(line["views"], 100 * line["value"], "o-", color=colour, mec="white", ms=6, label=name)
        for method, (marker, _) in CHOSEN.items():
            one = points[points["method"] == method]
            axes.plot(one["views"], 100 * one["value"], marker, color=colour, mec=INK, mew=0.8, ms=10, ls="none",
                      zorder=4)  # fmt: skip
    for marker, said in CHOSEN.values():
        axes.plot([], [], marker, color="none", mec=INK, ms=9, ls="none", label=said)
    ticks = sorted(set(frame["views"]))
    axes.set_xticks(ticks, [f"{tick:.0f}" for tick in ticks])
    axes.minorticks_off()
    axes.set_ylim(bottom=0)
    axes.set_title(VIEWS, pad=12)
    axes.legend(fontsize=9)
    miss, known = 100 * frame.set_index(["method", "views", "metric"])["value"], set(frame["metric"])
    words = {
        "title": VIEWS, "meshes": frame["meshes"].max(),
        "twelve": ", ".join(f"{SEEN[one][0]} {miss['twelve', 12, one]:.1f} %" for one in SEEN if one in known),
        "chance": ", ".join(f"{miss['any', 12, one]:.1f} %" for one in SEEN if one in known),
        "four": miss["four", 4, "ssim"], "any_four": miss["any", 4, "ssim"],
        "milliseconds": 1000 * frame.loc[frame["method"] == "twelve", "seconds"].iloc[0],
    }  # fmt: skip
    return Figure(drawing, words, frame)


def _typical_views(rows: pd.DataFrame) -> pd.DataFrame:
    """One row a metric, way of choosing and number of views.

    value, low, high: root mean square over the meshes, with the interval over them; seconds: mean.
    """
    keys, found = ["metric", "method", "views"], []
    for key, group in rows.groupby(keys, sort=False):
        ends = np.sqrt(np.maximum(interval(group["value"] ** 2), 0))
        found.append([*key, *ends, group["seconds"].mean(), len(group)])
    return pd.DataFrame(found, columns=[*keys, "value", "low", "high", "seconds", "meshes"])


def _rows(results: Results, what: str) -> pd.DataFrame:
    rows = results.bench("errors").query("what == @what")
    if rows.empty:
        raise NotRun(f"bench/errors.csv has no rows of {what}", "lod", runnable=False)
    return rows

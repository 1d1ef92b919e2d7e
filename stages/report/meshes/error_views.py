"""The picture errors: how many viewpoints they need."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import INK, plt, save

from .error_charts import errors_chart

METRICS = {"ssim": ("1 - SSIM", "#0072B2"), "dlap": ("Laplacian (DLap)", "#D55E00"),
           "dnor": ("normalised Laplacian (Dnor)", "#009E73")}  # fmt: skip
NAMED = {"four": ("D", "four round the object"), "twelve": ("*", "the twelve of T figure 3.2")}  # sets of stages.views
ASIDE = (0.97, 1.0, 1.03)  # times the views: where the marks of a metric stand, so that their bars are told apart
TITLE = "Viewpoints against the accuracy of the picture errors"
SHOWS = "Deviation from the error over 62 viewpoints against the number of viewpoints, a line for each picture error."


def build(results: Results) -> Figure:
    return errors_chart(results, "views", typical, _draw, _said, TITLE, SHOWS)


def typical(rows):
    """One row a metric, way of choosing and number of views.

    value, low, high: root mean square over the meshes, with the interval over them; seconds: mean.
    """
    keys, found = ["metric", "method", "views"], []
    for key, group in rows.groupby(keys, sort=False):
        ends = np.sqrt(np.maximum(interval(group["value"] ** 2), 0))
        line = dict(zip([*keys, "value", "low", "high"], [*key, *ends.tolist()], strict=True))
        found.append(line | {"seconds": group["seconds"].mean(), "meshes": len(group)})
    return pd.DataFrame(found, columns=[*keys, "value", "low", "high", "seconds", "meshes"])


def _draw(frame, path):
    figure, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set_xscale("log")
    axes.grid(True)
    for (metric, (name, colour)), aside in zip(METRICS.items(), ASIDE, strict=True):
        of = frame[frame["metric"] == metric].assign(views=lambda rows, aside=aside: aside * rows["views"])
        line = of[of["method"] == "any"].sort_values("views")
        axes.vlines(of["views"], 100 * of["low"], 100 * of["high"], color=colour, lw=1.2, alpha=0.4)
        axes.plot(line["views"], 100 * line["value"], "o-", color=colour, mec="white", ms=6, label=name)
        for method, (marker, _) in NAMED.items():
            point = of[of["method"] == method]
            axes.plot(
                point["views"], 100 * point["value"], marker, color=colour, mec=INK, mew=0.8, ms=10, ls="none", zorder=4
            )
    for marker, said in NAMED.values():
        axes.plot([], [], marker, color="none", mec=INK, ms=9, ls="none", label=said)
    ticks = sorted(set(frame["views"]))
    axes.set_xticks(ticks, [f"{tick:.0f}" for tick in ticks])
    axes.minorticks_off()
    axes.set_ylim(bottom=0)
    axes.set_xlabel("viewpoints (lines: chosen by chance among 62)")
    axes.set_ylabel("deviation from all 62, %")
    axes.set_title(TITLE, pad=12)
    axes.legend(fontsize=9)
    save(figure, path)


def _said(frame, _):
    """What the twelve views cost and miss, in words."""
    twelve = frame[frame["method"] == "twelve"].set_index("metric")
    chance = frame[(frame["method"] == "any") & (frame["views"] == 12)].set_index("metric")
    misses = ", ".join(f"{METRICS[m][0]} {100 * twelve.loc[m, 'value']:.1f} %" for m in METRICS if m in twelve.index)
    four, any_four = (
        100 * frame[(frame["method"] == method) & (frame["views"] == 4) & (frame["metric"] == "ssim")]["value"].sum()
        for method in ("four", "any")
    )
    by_chance = ", ".join(f"{100 * chance.loc[m, 'value']:.1f} %" for m in METRICS if m in chance.index)
    return (
        f"Root mean square over {int(frame['meshes'].max())} meshes (a tenth of their faces left) and 200 choices; "
        "bars: 95 % interval over the meshes. The twelve viewpoints of T figure 3.2 miss the value over 62 by "
        f"{misses}; twelve by chance by {by_chance}. "
        f"Four all round, which see neither top nor bottom, miss that of 1 - SSIM by {four:.0f} %, four by chance by "
        f"{any_four:.0f} %. Cost grows with the views: {1000 * twelve['seconds'].iloc[0]:.0f} ms for the twelve "
        "pictures of a simplified mesh and all three errors, on one core."
    )

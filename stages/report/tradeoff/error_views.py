"""The picture errors: how many viewpoints they need."""

import numpy as np
import pandas as pd

from stages.kit.files import write_table
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import INK, look, plt, save

METRICS = {"ssim": ("1 - SSIM", "#0072B2"), "dlap": ("Laplacian", "#D55E00"), "dnor": ("normalised", "#009E73")}
NAMED = {"four": ("D", "four round the object"), "twelve": ("*", "the twelve of T figure 3.2")}  # sets of stages.views
TITLE = "Viewpoints against the accuracy of the picture errors"


def build(results):
    rows = results.bench("errors")
    frame = typical(rows[rows["what"] == "views"])
    if not len(frame):
        raise NotRun("bench/errors.csv has no rows of views", "lod", runnable=False)
    folder = results.reports / "tradeoff"
    folder.mkdir(parents=True, exist_ok=True)
    write_table(folder / "error_views.csv", frame)
    with look():
        _draw(frame, folder / "error_views.png")
    return Figure(
        TITLE,
        "Deviation from the error over 62 viewpoints against the number of viewpoints, a line for each picture error.",
        _said(frame),
        [folder / "error_views.png", folder / "error_views.csv"],
    )


def typical(rows):
    """One row a metric, way of choosing and number of views: root mean square over the meshes, mean seconds."""
    keys = ["metric", "method", "views"]
    found = [
        dict(zip(keys, key, strict=True))
        | {
            "value": float(np.sqrt((group["value"] ** 2).mean())),
            "seconds": group["seconds"].mean(),
            "meshes": len(group),
        }
        for key, group in rows.groupby(keys, sort=False)
    ]
    return pd.DataFrame(found, columns=[*keys, "value", "seconds", "meshes"])


def _draw(frame, path):
    figure, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set_xscale("log")
    axes.grid(True)
    for metric, (name, colour) in METRICS.items():
        of = frame[frame["metric"] == metric]
        line = of[of["method"] == "any"].sort_values("views")
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
    axes.set_xlabel("viewpoints, chosen by chance among 62")
    axes.set_ylabel("deviation from all 62, %")
    axes.set_title(TITLE, pad=12)
    axes.legend()
    save(figure, path)


def _said(frame):
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
        f"Root mean square over {int(frame['meshes'].max())} meshes (a tenth of their faces left) and 200 choices. The "
        f"twelve viewpoints of T figure 3.2 miss the value over 62 by {misses}; twelve by chance by {by_chance}. "
        f"Four all round, which see neither top nor bottom, miss that of 1 - SSIM by {four:.0f} %, four by chance by "
        f"{any_four:.0f} %. Cost grows with the views: {1000 * twelve['seconds'].iloc[0]:.0f} ms for the twelve "
        "pictures of a simplified mesh and all three errors, on one core."
    )

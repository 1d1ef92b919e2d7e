"""Metro's error: how many samples it needs, and what they cost beside pymeshlab's."""

import numpy as np

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import INK, plt, save

from .error_charts import errors_chart

METHODS = {"metro": ("ours", "#0072B2", "o"), "pymeshlab": ("pymeshlab", "#D55E00", "s")}
NAMED = (1000, 10_000, 100_000, 1_000_000)  # samples written beside their point
TITLE = "Samples of the surface against the accuracy of Metro's mean error"
SHOWS = "Relative error of the mean against time, both logarithmic, one line for ours and one for pymeshlab."


def build(results: Results) -> Figure:
    return errors_chart(results, "samples", typical, _draw, _said, TITLE, SHOWS)


def typical(rows):
    """One row a method and number of samples: geometric means over the meshes, time as a ratio to the peer's usual.

    low, high: the error of the best and of the worst of the few meshes.
    """
    logs = rows.assign(value=np.log(rows["value"]), seconds=np.log(rows["seconds"])).groupby(["method", "samples"])
    frame = np.exp(logs[["value", "seconds"]].mean())
    frame["low"], frame["high"] = np.exp(logs["value"].min()), np.exp(logs["value"].max())
    frame = frame.reset_index()
    frame["samples"] = frame["samples"].astype(int)
    usual = frame[(frame["method"] == "pymeshlab") & (frame["samples"] == 10_000)]["seconds"]
    frame["cost_ratio"] = frame["seconds"] / (usual.iloc[0] if len(usual) else np.nan)
    return frame


def _draw(frame, path):
    figure, axes = plt.subplots(figsize=(7.2, 4.6))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True)
    for method, (name, colour, marker) in METHODS.items():
        line = frame[frame["method"] == method].sort_values("samples")
        axes.vlines(line["cost_ratio"], 100 * line["low"], 100 * line["high"], color=colour, lw=1.2, alpha=0.35)
        axes.plot(line["cost_ratio"], 100 * line["value"], marker=marker, color=colour, mec="white", ms=7, label=name)
        for row in line[line["samples"].isin(NAMED)].itertuples():
            # Ours lies below and left of the other line: its numbers stand on the free side.
            left = method == "metro"
            axes.annotate(
                f"{row.samples:,}", (row.cost_ratio, 100 * row.value), xytext=(-8 if left else 8, -4 if left else 4),
                textcoords="offset points", ha="right" if left else "left", va="top" if left else "bottom",
                fontsize=8.5, color=INK,
            )  # fmt: skip
    axes.set_xlabel("time, as a ratio to pymeshlab with 10,000 samples")
    axes.set_ylabel("error of the mean, %")
    axes.set_title(TITLE, pad=12)
    axes.margins(x=0.1, y=0.1)
    axes.legend(title="samples each way")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(lambda value, _: f"{value:g}")
    save(figure, path)


def _said(frame, rows):
    """How much the samples buy, in words."""
    found = {key: group.set_index("samples") for key, group in frame.groupby("method")}
    ours, theirs = found["metro"], found["pymeshlab"]
    speed = rows[rows["what"] == "speed"].pivot_table("seconds", ["mesh", "left"], "method")
    plain, whole = (speed[peer] / speed["metro"] for peer in ("pymeshlab", "pymeshlab, with vertices"))
    same = ours.index[ours["value"] <= theirs.loc[10_000, "value"]].min()
    meshes = rows.loc[rows["what"] == "samples", "mesh"].nunique()
    return (
        "Down and left is better. Root mean square over the seeds, geometric mean over the meshes (a tenth of their "
        f"faces left; bars: the best and the worst of {meshes}), against 4 million samples. With 10,000 samples ours "
        f"is {100 * ours.loc[10_000, 'value']:.2g} % off, pymeshlab {100 * theirs.loc[10_000, 'value']:.2g} %, which "
        f"{same:,} of ours reach. There pymeshlab takes {plain.median():.1f} times as long (median of {len(speed)} "
        f"pairs of meshes, {plain.min():.1f} to {plain.max():.1f}), {whole.median():.1f} times where it measures the "
        "vertices too, as ours does; with a million "
        f"{theirs.loc[1_000_000, 'seconds'] / ours.loc[1_000_000, 'seconds']:.1f} times."
    )

"""Frozen networks on a real pressure array: accuracy against parameters, operations and milliseconds."""

from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.ticker import NullFormatter

from stages.kit.files import write_table
from stages.kit.split import Split
from stages.report.items import Figure
from stages.report.names import place_names
from stages.report.pareto import pareto_front, ticks
from stages.report.results import NotRun
from stages.report.style import INK, label, plt, save

from .rows import measured_lines

COSTS = {
    "parameters": ("parameters, millions", 1e6),
    "operations": ("multiply-adds an image, billions", 1e9),
    "milliseconds": ("milliseconds an image, one thread", 1.0),
}
SIZE = 96  # pixels a side at which the recorded touches are seen
SLACK = 0.02  # accuracy that the smallest network may lack of the best one's
SPLIT = Split.BLOCKS  # neighbouring touches held out together


def build(results):
    lines = measured_lines(results)
    wanted = {"data": "pressure", "split": SPLIT, "weights": "imagenet", "mode": "frozen", "size": SIZE}
    frame = lines[(lines[list(wanted)] == pd.Series(wanted)).all(axis=1)].rename(columns={"method": "network"})
    costs = results.bench("networks")
    frame = frame.merge(costs[costs["size"] == SIZE].drop(columns="size"), on="network")
    if frame.empty:
        raise NotRun("no frozen network on the pressure images", "transfer", runnable=False)
    enough = frame[frame["accuracy"] >= frame["accuracy"].max() - SLACK]
    smallest = label(enough.loc[enough["parameters"].idxmin(), "network"])
    figure, panels = plt.subplots(1, len(COSTS), figsize=(11.4, 3.8), sharey=True)
    for axes, (words, _) in zip(panels, COSTS.values(), strict=True):
        axes.set_xlabel(words)
    panels[0].set_ylabel("accuracy, %")
    figure.tight_layout()  # before names find their places
    for axes, (cost, (_, unit)) in zip(panels, COSTS.items(), strict=True):
        _draw(axes, frame.assign(cost=frame[cost] / unit))
    folder = results.reports / "tradeoff"
    write_table(folder / "network_sizes.csv", frame)
    return Figure(
        "The smallest network that is enough",
        "Accuracy of frozen networks on real pressure images against parameters, multiply-adds and milliseconds.",
        "Up and left is better; the line is the Pareto front, bars are 95 % intervals. ImageNet's weights, frozen, a "
        f"new head for 22 objects, images of {SIZE} pixels, neighbouring touches held out together. The smallest "
        f"network within {100 * SLACK:.0f} points of the best on average is {smallest}.",
        [save(figure, folder / "network_sizes.png"), folder / "network_sizes.csv"],
    )


def _draw(axes, frame):
    axes.set_xscale("log")
    front = frame[pareto_front(frame["cost"], frame["accuracy"])].sort_values("cost")
    axes.step(front["cost"], 100 * front["accuracy"], where="post", color=INK, lw=1, zorder=1)
    points, lines = [], []
    for (left, before), (right, after) in pairwise(zip(front["cost"], 100 * front["accuracy"], strict=True)):
        lines += [((left, before), (right, before)), ((right, before), (right, after))]
    for row in frame.itertuples():
        points.append((row.cost, 100 * row.accuracy))
        if np.isfinite(row.low):
            lines.append(((row.cost, 100 * row.low), (row.cost, 100 * row.high)))
            axes.plot(*zip(*lines[-1], strict=True), color="#0072B2", lw=1.2, alpha=0.5)
        axes.plot(*points[-1], "o", color="#0072B2", ms=6, mec="white")
    axes.margins(x=0.2)
    axes.grid(True)
    axes.xaxis.set_major_locator(ticks(frame["cost"].max() / frame["cost"].min()))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    names = [(label(row.network), point) for row, point in zip(frame.itertuples(), points, strict=True)]
    place_names(axes, names, np.array(points), lines)

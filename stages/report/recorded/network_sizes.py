"""Frozen networks on a real pressure array: accuracy against parameters, operations and milliseconds."""

from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from stages.kit.split import Split
from stages.report.items import Figure
from stages.report.names import place_names
from stages.report.pareto import pareto_front, ticks
from stages.report.results import NotRun, Results
from stages.report.style import INK, label, plt

from .rows import measured_lines

COSTS = {
    "parameters": ("parameters, millions", 1e6),
    "operations": ("multiply-adds an image, billions", 1e9),
    "milliseconds": ("milliseconds an image, one thread", 1.0),
}
SIZE = 96  # pixels a side at which the recorded touches are seen
SLACK = 0.02  # accuracy that the smallest network may lack of the best one's
SETTING = {"data": "pressure", "split": Split.BLOCKS, "weights": "imagenet", "mode": "frozen", "size": SIZE}


def build(results: Results) -> Figure:
    """A panel for each cost, with the Pareto front; neighbouring touches are held out together."""
    lines = measured_lines(results)
    frame = lines[(lines[list(SETTING)] == pd.Series(SETTING)).all(axis=1)].rename(columns={"method": "network"})
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
        percent = 100 * frame[["accuracy", "low", "high"]]
        _draw(axes, percent.assign(cost=frame[cost] / unit, name=frame["network"].map(label)))
    return Figure(figure, {"size": SIZE, "slack": 100 * SLACK, "smallest": smallest}, frame)


def _draw(axes: Axes, frame: pd.DataFrame) -> None:
    """frame: accuracy, low and high in per cent, cost and name."""
    axes.set_xscale("log")
    front = frame[pareto_front(frame["cost"], frame["accuracy"])].sort_values("cost")
    axes.step(front["cost"], front["accuracy"], where="post", color=INK, lw=1, zorder=1)
    lines = []
    for (left, before), (right, after) in pairwise(zip(front["cost"], front["accuracy"], strict=True)):
        lines += [((left, before), (right, before)), ((right, before), (right, after))]
    for cost, middle, low, high in frame[["cost", "accuracy", "low", "high"]].itertuples(index=False):
        if np.isfinite(low):
            lines.append(((cost, low), (cost, high)))
            axes.plot([cost] * 2, [low, high], color="#0072B2", lw=1.2, alpha=0.5)
        axes.plot(cost, middle, "o", color="#0072B2", ms=6, mec="white")
    axes.margins(x=0.2)
    axes.grid(True)
    axes.xaxis.set_major_locator(ticks(frame["cost"].max() / frame["cost"].min()))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    points = list(zip(frame["cost"], frame["accuracy"], strict=True))
    place_names(axes, zip(frame["name"], points, strict=True), np.array(points), lines)

"""T figure 3.32: how much each task's map agrees with where people look."""

import numpy as np

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import CYCLE, GREY, INK, PALE, label, plt, save

from .rows import (
    FUSED,
    MODELS,
    TASKS,
    network_text,
    networks,
    people,
    scores,
    sources,
    untrained,
)

LINES = (*TASKS, FUSED)
SPREAD = 0.72  # of a row that its networks fill


def build(results: Results) -> Figure:
    found = sources(results)
    methods = dict.fromkeys(method for rows in found.values() for method in networks(rows))
    methods = sorted(methods, key=untrained)
    height = 1.2 + len(LINES) * max(0.42, 0.14 * len(methods))
    figure, grid = plt.subplots(
        1, len(found), figsize=(4.0 * len(found) + 2.6, height), squeeze=False, sharey=True, sharex=True
    )
    paint = tints(methods)
    for axes, (source, rows) in zip(grid[0], found.items(), strict=True):
        _draw(axes, scores(rows, "pcc"), methods, paint)
        axes.set_title(source, fontsize=10, fontweight="normal")
        axes.set_xlabel("Pearson's correlation with people")
    grid[0, 0].set_yticks(range(len(LINES)), [MODELS.get(task, label(task)) for task in LINES])
    grid[0, 0].set_ylim(len(LINES) - 0.4, -0.6)
    for method in methods:
        grid[0, -1].plot([], [], color=paint[method], label=network_text(method), **form(method))
    grid[0, -1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    figure.tight_layout()
    return Figure(
        "Figure 3.32: which tasks' maps agree with people",
        f"Correlation of each task's map with {' and with '.join(found)}, a row a task, a colour a network.",
        "Over the vertices that a view sees, each weighing its area, mean of three views. Lines: 95 % interval over "
        f"the objects. Hollow: random weights. EWIGC fuses curvature, eccentricity and levels 1 and 2.{people(found)}",
        [save(figure, results.reports / "figures/figure_3_32.png")],
    )


def tints(methods):
    """dict method -> colour: one a network, grey for random weights."""
    names = list(dict.fromkeys(method.rpartition("-")[0] for method in methods))
    return {method: CYCLE[names.index(method.rpartition("-")[0]) % len(CYCLE)] for method in methods}


def form(method):
    """How the mark of a method looks: hollow for random weights, square where every layer learned."""
    hollow = {"mfc": "white"} if untrained(method) else {}
    return {"marker": "s" if method.endswith("-finetuned") else "o", "ms": 5, "ls": "", **hollow}


def _draw(axes, table, methods, paint):
    places = (np.arange(len(methods)) - (len(methods) - 1) / 2) * SPREAD / max(len(methods), 3)
    for y, task in enumerate(LINES):
        for down, method in zip(places, methods, strict=True):
            if (method, task) in table:
                mean, low, high = interval(table[method, task].dropna())
                axes.plot([low, high], [y + down] * 2, color=paint[method], lw=1.5, alpha=0.5)
                axes.plot(mean, y + down, color=paint[method], **form(method))
    axes.axvline(0, color=INK, lw=0.8)
    axes.axhline(len(TASKS) - 0.5, color=GREY, lw=0.6)
    axes.hlines(np.arange(len(TASKS) - 1) + 0.5, 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.5)
    axes.grid(axis="x")
    axes.tick_params(axis="y", length=0)

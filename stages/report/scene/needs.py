"""How many faces each object needs to be seen, to be felt and to be recognised by touch."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Figure, Table
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.style import CYCLE, INK, plain_logarithm, plt

STAGE = "face_needs"
TASKS = {  # words, what the condition is multiplied by in them, colour
    "seen": ("seen from {:g} m", 1, CYCLE[0]), "felt": ("felt, within {:g} % of full scale", 100, CYCLE[1]),
    "recognised": ("recognised by touch, within {:g} points", 100, CYCLE[2]),
}  # fmt: skip


def build(results: Results) -> Table:
    """A line for each task: the median over the objects with its interval, and the range of nine in ten."""
    rows, lines, frame = _rows(results), [], []
    full = rows[rows["task"] == "full"].set_index("item")["value"]
    for (task, condition), own in _tasks(rows):
        need = own.set_index("item")["value"]
        share = 100 * need / full[need.index]
        median, low, high = interval(need, statistic=np.median)
        ends = np.quantile(need, [0.05, 0.95])
        frame.append({"task": task, "condition": condition, "objects": len(need), "median": median, "low": low,
                      "high": high, "q05": ends[0], "q95": ends[1], "share": share.median()})  # fmt: skip
        lines.append({
            "task": words_of(task, condition), "faces, median": with_interval(median, low, high, places=0),
            "nine in ten objects": f"{ends[0]:,.0f} to {ends[1]:,.0f}",
            "of the full mesh, %": with_interval(*interval(share, statistic=np.median), places=1),
        })  # fmt: skip
    accuracy = 100 * _rows(results, "accuracy")["value"]
    together = _rows(results, "faces_together")["value"].iloc[0]
    words = {"objects": len(full), "full": f"{full.median():,.0f}", "together": f"{together:,.0f}",
             "accuracy": with_interval(*interval(accuracy), places=0)}  # fmt: skip
    return Table(pd.DataFrame(frame), pd.DataFrame(lines), words)


def figure(results: Results) -> Figure:
    """A dot an object and task, sorted by the faces that it needs, with the median and its interval."""
    rows = _rows(results)
    tasks = [(("full", np.nan), rows[rows["task"] == "full"]), *_tasks(rows)]
    drawing, axes = plt.subplots(figsize=(7.4, 0.42 * len(tasks) + 1.2))
    for place, ((task, _), own) in enumerate(reversed(tasks)):
        need = np.sort(own["value"])
        tint = TASKS[task][-1] if task in TASKS else INK
        axes.plot(
            need, place + 0.5 * (np.arange(len(need)) / len(need) - 0.5), "o", ms=3.5, mew=0, color=tint, alpha=0.6
        )
        median, low, high = interval(need, statistic=np.median)
        axes.plot([low, high], [place] * 2, color=INK, lw=1.6)
        axes.plot(median, place, "|", color=INK, ms=11, mew=2)
    axes.set_yticks(range(len(tasks)), [words_of(*key) for key, _ in reversed(tasks)])
    axes.set(xscale="log", xlabel="faces")
    plain_logarithm(axes.xaxis)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x")
    drawing.tight_layout()
    return Figure(drawing, {"objects": rows["item"].nunique()})


def words_of(task: str, condition: float) -> str:
    """A task in words: seen from 1 m."""
    if task not in TASKS:
        return "the full mesh"
    words, scale, _ = TASKS[task]
    return words.format(scale * condition)


def _rows(results: Results, metric: str = "faces") -> pd.DataFrame:
    return results.measured(STAGE, metric=metric)


def _tasks(rows: pd.DataFrame) -> list[tuple[tuple[str, float], pd.DataFrame]]:
    """[((task, condition), rows)] in the order of TASKS, from few faces to many."""
    rows, order = rows.dropna(subset=["condition"]), list(TASKS)
    keys = sorted({*zip(rows["task"], rows["condition"], strict=True)}, key=lambda key: (order.index(key[0]), -key[1]))
    return [(key, rows[(rows["task"] == key[0]) & (rows["condition"] == key[1])]) for key in keys]

"""The time of each kernel as a ratio to its peer, over the commits."""

import numpy as np
import pandas as pd

from stages.charts.drawing import CYCLE, MARKERS, plain_logarithm, plt
from stages.charts.items import Figure
from stages.charts.results import Results


def kernels(results: Results) -> Figure:
    """A line a kernel of the machine that measured last, shaded up to its limit; the commits go from old to new."""
    rows = results.bench("history").dropna(subset=["ratio"]).sort_values("date", kind="stable")
    rows = rows[rows["machine"] == rows["machine"].iloc[-1]]
    commits = list(dict.fromkeys(rows["commit"]))
    rows = rows.assign(place=rows["commit"].map(commits.index))
    drawing, axes = plt.subplots(figsize=(7.2, 4.8))
    last = rows.groupby("what")["ratio"].last().sort_values(ascending=False)
    for k, kernel in enumerate(last.index):
        form = MARKERS[(k + k // len(CYCLE)) % len(MARKERS)]  # another where the colours start again
        _draw(axes, rows[rows["what"] == kernel], CYCLE[k % len(CYCLE)], form)
    axes.axhline(1, color="black", lw=0.8, ls=":")
    axes.set_yscale("log")
    plain_logarithm(axes.yaxis)
    axes.set_xticks(range(len(commits)), commits, rotation=30, ha="right", fontsize=8)
    axes.set(xlim=(-0.5, len(commits) - 0.5), xlabel="commit", ylabel="time, as a ratio to the peer's")
    axes.grid(axis="y")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)
    peers = rows.drop_duplicates("what").set_index("what")["peer"]
    words = {"kernels": len(last), "commits": len(commits), "machine": rows["machine"].iloc[-1]}
    return Figure(drawing, words | {"names": ", ".join(f"{kernel} ({peers[kernel]})" for kernel in last.index)})


def _draw(axes, rows: pd.DataFrame, tint: str, form: str) -> None:
    middle, ends = rows["ratio"].to_numpy(), rows[["low", "high"]].to_numpy().T
    axes.errorbar(rows["place"], middle, np.abs(ends - middle), fmt=f"{form}-", color=tint, ms=5, mec="white", lw=1.4,
                  label=f"{rows['what'].iloc[0]} / {rows['peer'].iloc[-1]}")  # fmt: skip
    beside = np.array([-0.12, 0.12])[:, None] + rows["place"].to_numpy()  # a single commit has a width, too
    places, low, high = beside.T.ravel(), rows["ratio"].repeat(2), rows["limit"].repeat(2)
    axes.fill_between(places, low, high, color=tint, alpha=0.12, lw=0)

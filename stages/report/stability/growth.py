"""Time and memory of each stage as the number of objects grows, with the fitted exponents."""

import numpy as np
import pandas as pd
from scipy import stats

from stages.report.items import Figure
from stages.report.markdown import with_interval
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, MARKERS, plain_logarithm, plt

STATUS = "dvc status"
SHOWN = {"processor": "processor seconds", "main_mib": "memory, MiB"}
FITTED = 300  # objects from which the growth is fitted: below, the start of a stage counts


def exponent(objects: np.ndarray, cost: np.ndarray) -> tuple[float, float, float]:
    """(power, low, high) of cost ~ objects^power: least squares of the logarithms, 95 % interval of the slope."""
    (power, _), spread = np.polyfit(np.log(objects), np.log(cost), 1, cov=True)
    half = np.sqrt(spread[0, 0]) * stats.t.ppf(0.975, len(objects) - 2)
    return float(power), float(power - half), float(power + half)


def build(results: Results) -> Figure:
    """A panel each for time and memory, a line a stage; the legend has the exponents."""
    rows = results.bench("growth")
    rows, status = rows[rows["stage"] != STATUS], rows[rows["stage"] == STATUS].sort_values("objects")
    fitted = rows[rows["objects"] >= FITTED]
    if fitted["objects"].nunique() < 3 or status.empty:
        raise NotRun(f"fewer than three numbers of {FITTED} objects and more in bench/growth.csv", "bench", False)
    drawing, panels = plt.subplots(1, 2, figsize=(9.6, 4.2))
    for axes, (column, name) in zip(panels, SHOWN.items(), strict=True):
        for k, (stage, own) in enumerate(rows.groupby("stage", sort=False)):
            power = _said(fitted[fitted["stage"] == stage], column)
            axes.plot(own["objects"], own[column], f"{MARKERS[k % len(MARKERS)]}-", ms=4, lw=1.2,
                      color=CYCLE[k % len(CYCLE)], label=f"{stage}: {power}")  # fmt: skip
        axes.set(xscale="log", yscale="log", xlabel="objects", ylabel=name)
        plain_logarithm(axes.xaxis, (1.0, 3.0))
        plain_logarithm(axes.yaxis)
        axes.grid()
        axes.legend(fontsize=8, loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=2, columnspacing=1.0)
    total = fitted.groupby("objects")["processor"].sum()
    most, last = rows.groupby("objects")["main_mib"].max(), status.iloc[-1]
    words = {
        "largest": f"{last['objects']:,}", "from_": FITTED, "status": f"{last['seconds']:.1f}",
        "power": with_interval(*exponent(total.index.to_numpy(), total.to_numpy()), places=2),
        "memory": f"{most.iloc[-1]:.0f}", "memory_least": f"{most.iloc[0]:.0f}", "least": rows["objects"].min(),
        "machine": rows["machine"].iloc[-1],
    }  # fmt: skip
    return Figure(drawing, words)


def _said(own: pd.DataFrame, column: str) -> str:
    return with_interval(*exponent(own["objects"].to_numpy(), own[column].to_numpy()), places=2)

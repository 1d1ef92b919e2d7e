"""Simplification: error against the seconds to find the points to keep and to simplify."""

import pandas as pd

from stages.report.costs import looking_seconds
from stages.report.intervals import summary
from stages.report.lod_cells import PLAIN, paired_cells, size
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import WAYS, label

METHODS = [  # as many as have a colour of their own; the other methods are in figures 3.4 and 3.5
    PLAIN, "enhanced", "enhanced-soft", "itti", "thesis_ssim", "thesis_ssim-adaptive", "random", "heat_kernel",
]  # fmt: skip


def build(results):
    rows = paired_cells(results, ["metro_mean"], METHODS)
    rows = rows[rows["target"].str.endswith("%")]
    if not len(rows) or PLAIN not in set(rows["method"]):
        raise NotRun("no share of the faces that plain QEM and all methods reach on the same object", "lod")
    search = looking_seconds(results)
    frame = pd.DataFrame(summary(rows, ["method", "target"]))
    frame["looked"] = frame["method"].map(lambda method: _looking(method, search))
    frame = frame.dropna(subset=["looked"])
    frame["seconds"] += frame["looked"]
    for column in ("mean", "low", "high"):
        frame[column] *= 100
    frame["name"] = frame["method"].map(label) + ", " + frame["target"].astype(str)
    order = sorted(set(frame["target"]), key=size)
    frame = frame.sort_values("target", key=lambda column: column.map(order.index), kind="stable")
    return pareto_chart(
        frame, "seconds", "mean", "name", name="simplification", title="Simplifying a mesh to a share of its faces",
        reference=f"{label(PLAIN)}, {order[0]}", quality_label="Metro mean error, % of the diagonal", better="low",
        folder=results.reports / "tradeoff", colour="method", marker="target",
    )  # fmt: skip


def _looking(method, search):
    """Seconds to find the points that a method keeps; none for plain QEM, which looks for nothing."""
    base, _, way = method.rpartition("-")
    return 0.0 if method == PLAIN else search.get(base if way in WAYS else method, float("nan"))

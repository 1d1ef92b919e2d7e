"""Simplification: error against the seconds to find the points to keep and to simplify."""

import pandas as pd

from stages.report.costs import looking_seconds
from stages.report.intervals import summary
from stages.report.lod_cells import paired_cells
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label

METHODS = [  # as many as have a colour of their own; the combinations of channels are in figure 3.4
    "qem", "enhanced", "itti", "random", "thesis_ssim", "mesh_saliency", "salient_points", "heat_kernel",
]  # fmt: skip


def build(results):
    rows = paired_cells(results, ["metro_mean"], METHODS)
    rows = rows[rows["target"].str.endswith("%")]
    if not len(rows) or "qem" not in set(rows["method"]):
        raise NotRun("no share of the faces that plain QEM and all methods reach on the same object", "lod")
    search = looking_seconds(results)
    frame = pd.DataFrame(summary(rows, ["method", "target"]))
    frame = frame[frame["method"].isin(["qem", *search])]
    frame["seconds"] += frame["method"].map(search).fillna(0.0)  # plain QEM looks for nothing
    for column in ("mean", "low", "high"):
        frame[column] *= 100
    frame["name"] = frame["method"].map(label) + ", " + frame["target"].astype(str)
    order = sorted(set(frame["target"]), key=lambda target: -float(target.rstrip("%")))
    frame = frame.sort_values("target", key=lambda column: column.map(order.index), kind="stable")
    return pareto_chart(
        frame, "seconds", "mean", "name", name="simplification", title="Simplifying a mesh to a share of its faces",
        reference=f"{label('qem')}, {order[0]}", quality_label="Metro mean error, % of the diagonal", better="low",
        folder=results.reports / "tradeoff", colour="method", marker="target",
    )  # fmt: skip

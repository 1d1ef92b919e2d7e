"""Networks on imprints: accuracy against the seconds of training."""

import pandas as pd

from stages.kit.split import shared_by
from stages.report.grid import means
from stages.report.networks import FINE, measured
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label, start

REFERENCE = ("mobilenet_v2", "imagenet", "frozen")


def build(results):
    rows = measured(results)
    rows = rows[(rows["data"] == FINE) & (rows["split"] == "random")]
    frame = pd.DataFrame(means(rows, ["method", "weights", "mode"], shared_by("random"), top=1.0)).dropna(
        subset=["seconds"]
    )
    frame["name"] = [_name(row.method, row.weights, row.mode) for row in frame.itertuples()]
    reference = _name(*REFERENCE)
    if reference not in set(frame["name"]):
        raise NotRun(f"the reference {reference} is not measured", "transfer")
    return pareto_chart(
        frame, "seconds", "mean", "name", name="networks", title="From sight to touch: what training costs",
        reference=reference, quality_label="test accuracy, touches at random", folder=results.reports / "tradeoff",
    )  # fmt: skip


def _name(network, weights, mode):
    return f"{label(network)}, {start(weights)}, {label(mode)}"

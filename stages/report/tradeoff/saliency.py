"""Saliency: what a second spent on looking is worth to the touch that follows."""

import pandas as pd

from stages.report.costs import looking_seconds
from stages.report.intervals import HOLD_OUT, summary
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label

REFERENCE = "itti"


def build(results):
    where = {"object": "six", "classifier": "knn", "metric": "accuracy_holdout", "variant": "plain"}
    results.measured("classification", **where, method=REFERENCE)
    frame = pd.DataFrame(summary(results.measured("classification", **where), ["method"], HOLD_OUT, top=1.0))
    frame["seconds"] = frame["method"].map(looking_seconds(results))
    frame = frame.dropna(subset=["seconds"])
    if REFERENCE not in set(frame["method"]):
        raise NotRun(f"no seconds of {REFERENCE}", "salient_points")
    frame["name"] = frame["method"].map(label)
    return pareto_chart(
        frame, "seconds", "mean", "name", name="saliency",
        title=f"Looking before touching: {results.set_text('six')}, kNN", reference=label(REFERENCE),
        quality_label="hold-out accuracy", folder=results.reports / "tradeoff",
    )  # fmt: skip

"""Recognition by touch: accuracy against the seconds to fit and ask a classifier."""

import pandas as pd

from stages.report.intervals import HOLD_OUT, summary
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label
from stages.report.tables._touch import OURS

REFERENCE = ("knn", "random")  # the thesis's best classifier, where nobody looked first


def build(results):
    where = {"object": "six", "metric": "accuracy_holdout", "method": [*OURS.values(), "enhanced"], "variant": "plain"}
    results.measured("classification", **where | {"classifier": REFERENCE[0], "method": REFERENCE[1]})
    rows = results.measured("classification", **where)
    frame = pd.DataFrame(summary(rows, ["classifier", "method"], HOLD_OUT, top=1.0)).dropna(subset=["seconds"])
    frame["name"] = frame["classifier"].map(label) + ", " + frame["method"].map(label)
    reference = ", ".join(map(label, REFERENCE))
    if reference not in set(frame["name"]):
        raise NotRun(f"the reference {reference} is not measured", "classification")
    return pareto_chart(
        frame, "seconds", "mean", "name", name="touch", title=f"Recognising {results.set_text('six')} by one touch",
        reference=reference, quality_label="hold-out accuracy", folder=results.reports / "tradeoff",
        colour="classifier", marker="method",
    )  # fmt: skip

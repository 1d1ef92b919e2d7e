"""Recognition by touch: accuracy against seconds, over features, classifiers and the number of touches."""

import pandas as pd

from stages.report.intervals import HOLD_OUT, summary
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label
from stages.report.tables._touch import OURS

ENHANCED = OURS["enhanced_visual_attention"]
REFERENCE = "kNN, 41 features"
COUNTS = (1, 2, 5)  # touches; with the five kinds of features as many as there are colours
KINDS = {
    "plain": "41 features", "pixels": "pixels", "wavelet_features": "36 wavelet features",
    "image_features": "5 image features", "locations": "41 features and position",
    **{f"touches_{count}": f"{count} touch{'es' if count > 1 else ''}, map and position" for count in COUNTS},
}  # fmt: skip
MADE_OF = {"locations": "plain", **{f"touches_{count}": "plain" for count in COUNTS}}  # whose features they take


def build(results):
    where = {"object": "six", "method": ENHANCED}
    rows = results.measured("classification", **where, metric="accuracy_holdout", variant=list(KINDS))
    frame = pd.DataFrame(summary(rows, ["variant", "classifier"], HOLD_OUT, top=1.0)).dropna(subset=["seconds"])
    making = results.measured("classification", **where, metric="features").set_index("variant")["seconds"]
    frame["seconds"] += [making.get(MADE_OF.get(variant, variant), 0.0) for variant in frame["variant"]]
    frame["samples"] = frame["variant"].map(KINDS)
    frame["name"] = frame["classifier"].map(label) + ", " + frame["samples"]
    if REFERENCE not in set(frame["name"]):
        raise NotRun(f"the reference {REFERENCE} is not measured", "classification")
    return pareto_chart(
        frame, "seconds", "mean", "name", name="touches",
        title=f"Recognising {results.set_text('six')} by one touch and more", reference=REFERENCE,
        quality_label="hold-out accuracy", folder=results.reports / "tradeoff", colour="samples", marker="classifier",
    )  # fmt: skip

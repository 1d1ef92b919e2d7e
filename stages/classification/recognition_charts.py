"""Claims on recognition by touch (T4.2), and charts of its accuracy against seconds.

The claims are about points, classifiers, imprints and groups of objects: in the thesis's protocol on random sets of
objects, and in ours. The charts are about classifiers, about features and touches, and about the search for the points.
"""

from typing import Any

import pandas as pd

from haptic_glance.know.classifiers import TRAINING
from haptic_glance.know.split import Split, shared_by
from stages.charts.drawing import label
from stages.charts.items import Figure
from stages.charts.pareto import attention_seconds, pareto_chart
from stages.charts.results import Results
from stages.charts.tables import means
from stages.classification.recognition_tables import METHODS, MODEL, SSIM, STAGE

RIGHT: dict[str, Any] = {"metric": "accuracy", "split": Split.RANDOM}
EVERY, KNN = {"group": "six"} | RIGHT, {"classifier": "knn"} | RIGHT  # EVERY: the mean of all classifiers
SIX: dict[str, Any] = {"classifier": "knn"} | EVERY
FOUR, APART, NETWORK = SIX | {"group": "four"}, SIX | {"split": Split.REGIONS}, SIX | {"classifier": "deep_learning"}
ROWS = {"": SIX, "_mean": SIX, "_four": FOUR, "_all": EVERY, "_apart": APART, "_60": SIX}
ROWS |= {"_ours": ROWS[""], "_apart_ours": ROWS["_apart"]}  # of our protocol, not of the printed one


COUNTS = (1, 2, 5)  # touches; with the five kinds of features as many as there are colours
KINDS = {
    "plain": "41 features", "pixels": "pixels", "wavelet_features": "36 wavelet features",
    "image_features": "5 image features", "locations": "41 features and position",
    **{f"touches_{count}": f"{count} touch{'es' if count > 1 else ''}, map and position" for count in COUNTS},
}  # fmt: skip
MADE_OF = {"locations": "plain", **{f"touches_{count}": "plain" for count in COUNTS}}  # whose features they take


def by_classifier(results: Results) -> Figure:
    """Accuracy against the seconds to fit and ask a classifier; the reference is the thesis's best, blind."""
    by, title = ["classifier", "method"], f"Recognising {results.group_text('six')} by one touch"
    frame = _timed(results, by, variant="plain", method=[*METHODS.values(), SSIM, MODEL])
    return _chart(results, frame, title, by, f"{label('knn')}, {label('random')}", colour="classifier", marker="method")


def by_features(results: Results) -> Figure:
    """Accuracy against seconds over features, classifiers and the number of touches."""
    frame = _timed(results, ["variant", "classifier"], method=MODEL, variant=list(KINDS))
    making = results.measured(STAGE, group="six", method=MODEL, metric="features").groupby("variant")["seconds"].mean()
    frame["seconds"] += frame["variant"].replace(MADE_OF).map(making).fillna(0.0)  # the mean of several random sets
    frame["samples"] = frame["variant"].map(KINDS)
    title = f"Recognising {results.group_text('six')} by one touch and more"
    by = ["classifier", "samples"]
    return _chart(results, frame, title, by, "kNN, 41 features", colour="samples", marker="classifier")


def by_saliency(results: Results) -> Figure:
    """The worth of a second spent on saliency to the touch that follows."""
    frame = _timed(results, ["method"], classifier="knn", variant="plain")
    frame["seconds"] = frame["method"].map(attention_seconds(results))
    title = f"Looking before touching: {results.group_text('six')}, kNN"
    return _chart(results, frame, title, ["method"], label(MODEL))


def _timed(results: Results, by: list[str], **where: Any) -> pd.DataFrame:
    """Mean accuracies on touches of six objects drawn at random, and their seconds."""
    where |= {"metric": "accuracy", "split": Split.RANDOM, "group": "six", "scaling": TRAINING}
    rows = results.measured(STAGE, **where)
    return pd.DataFrame(means(rows, by, shared_by(Split.RANDOM), top=1.0))


def _chart(results: Results, frame: pd.DataFrame, title: str, named: list[str], reference: str, **style: Any) -> Figure:
    """named: columns that make up the name of a choice."""
    frame = frame.assign(name=frame[named].map(label).agg(", ".join, axis=1)).dropna(subset=["seconds"])
    return pareto_chart(frame, "mean", title=title, reference=reference, quality_label="hold-out accuracy",
                        clock=results.clock(STAGE),
                        legends={"method": "touched by", "samples": "a sample"}, **style)  # fmt: skip

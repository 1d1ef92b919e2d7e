"""Charts of accuracy by touch against seconds: classifiers, features and touches, and the search for the points."""

import pandas as pd

from stages.kit.split import shared_by
from stages.report.costs import attention_seconds
from stages.report.grid import means
from stages.report.items import Figure
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import ENHANCED, MODEL, OURS, STAGE, at_random

COUNTS = (1, 2, 5)  # touches; with the five kinds of features as many as there are colours
KINDS = {
    "plain": "41 features", "pixels": "pixels", "wavelet_features": "36 wavelet features",
    "image_features": "5 image features", "locations": "41 features and position",
    **{f"touches_{count}": f"{count} touch{'es' if count > 1 else ''}, map and position" for count in COUNTS},
}  # fmt: skip
MADE_OF = {"locations": "plain", **{f"touches_{count}": "plain" for count in COUNTS}}  # whose features they take


def by_classifier(results: Results) -> Figure:
    """Accuracy against the seconds to fit and ask a classifier; the reference is the thesis's best, blind."""
    at_random(results, group="six", variant="plain", classifier="knn", method="random")
    rows = at_random(results, group="six", variant="plain", method=[*OURS.values(), MODEL])
    frame = _timed(rows, ["classifier", "method"])
    frame["name"] = frame["classifier"].map(label) + ", " + frame["method"].map(label)
    title = f"Recognising {results.group_text('six')} by one touch"
    reference = f"{label('knn')}, {label('random')}"
    return _chart(results, frame, "touch", title, reference, colour="classifier", marker="method")


def by_features(results: Results) -> Figure:
    """Accuracy against seconds over features, classifiers and the number of touches."""
    where = {"group": "six", "method": ENHANCED}
    frame = _timed(at_random(results, **where, variant=list(KINDS)), ["variant", "classifier"])
    making = results.measured(STAGE, **where, metric="features").set_index("variant")["seconds"]
    frame["seconds"] += [making.get(MADE_OF.get(variant, variant), 0.0) for variant in frame["variant"]]
    frame["samples"] = frame["variant"].map(KINDS)
    frame["name"] = frame["classifier"].map(label) + ", " + frame["samples"]
    title = f"Recognising {results.group_text('six')} by one touch and more"
    return _chart(results, frame, "touches", title, "kNN, 41 features", colour="samples", marker="classifier")


def by_saliency(results: Results) -> Figure:
    """What a second spent on saliency is worth to the touch that follows."""
    where = {"group": "six", "classifier": "knn", "variant": "plain"}
    at_random(results, **where, method="itti")
    frame = _timed(at_random(results, **where), ["method"])
    frame["seconds"] = frame["method"].map(attention_seconds(results))
    frame["name"] = frame["method"].map(label)
    title = f"Looking before touching: {results.group_text('six')}, kNN"
    return _chart(results, frame.dropna(subset=["seconds"]), "saliency", title, label("itti"))


def _timed(rows, by):
    return pd.DataFrame(means(rows, by, shared_by("random"), top=1.0)).dropna(subset=["seconds"])


def _chart(results, frame, name, title, reference, **style):
    if reference not in set(frame["name"]):
        raise NotRun(f"the reference {reference} is not measured", STAGE)
    return pareto_chart(
        frame, "seconds", "mean", "name", name=name, title=title, reference=reference,
        quality_label="hold-out accuracy", folder=results.reports / "tradeoff", **style,
    )  # fmt: skip

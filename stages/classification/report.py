"""One glance by touch: which points, classifiers and imprints make simulated touch recognisable (T4.2)."""

from functools import partial
from typing import Any

import pandas as pd

from haptic_glance.know.classifiers import TRAINING
from haptic_glance.know.split import Split, shared_by
from stages.charts.datasets import SECTION_4_2
from stages.charts.drawing import label
from stages.charts.items import Figure, as_printed
from stages.charts.pareto import attention_seconds, pareto_chart
from stages.charts.results import Results
from stages.charts.tables import means
from stages.classification.recognition_tables import METHODS, MODEL, SSIM, STAGE

from . import recognition_tables, touch_pictures


def by_classifier(results: Results) -> Figure:
    """Accuracy against the seconds to fit and ask a classifier; the reference is the thesis's best, blind."""
    by, title = ["classifier", "method"], f"Recognising {results.group_text('six')} by one touch"
    frame = _timed(results, by, variant="plain", method=[*METHODS.values(), SSIM, MODEL])
    return _chart(results, frame, title, by, f"{label('knn')}, {label('random')}", colour="classifier", marker="method")


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
                        legends={"method": "touched by"}, **style)  # fmt: skip


PAGE = "touch"
TABLES = {
    "recognition": recognition_tables.recognition,
    "table_4_1": recognition_tables.table_4_1,
    "table_4_2": recognition_tables.table_4_2,
    "table_4_3": recognition_tables.table_4_3,
    "table_4_5": recognition_tables.table_4_5,
    "table_4_6": recognition_tables.table_4_6,
    "section_4_2_4": recognition_tables.section_4_2_4,
}
FIGURES = {
    "pipeline": touch_pictures.pipeline,
    "touch_one_mesh": touch_pictures.touch_one_mesh,
    "imprints": touch_pictures.imprints,
    "table_4_1": touch_pictures.figure_4_1,
    "figure_4_4": partial(as_printed, touch_pictures.figure_4_4, SECTION_4_2),
}
CHARTS = {
    "touch": by_classifier,
    "saliency": by_saliency,
}

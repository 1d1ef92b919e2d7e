"""T3.2.3: how often the SVM is right about a pixel, and what the background alone would give."""

from contextlib import suppress

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import NotRun, Results

from .rows import gaze_first

TRAINING = {"one_for_all": "one for all", "one_per_object": "one per object", "one_per_viewpoint": "one per viewpoint"}
VALIDATION = {"pixels": "random pixels", "views": "whole views", "objects": "whole objects"}
AREA = {"image": "whole image", "object": "the object"}
THESIS = {"one_for_all": "one_svm_for_all_objects", "one_per_object": "one_svm_per_object"}
NOTES = [
    "Per cent of pixels classified right, classes balanced, so that a coin gets 50. Left out for testing: tenths of "
    "the pixels at random (the thesis's ten folds: beside each test pixel lie pixels that were learned), whole views, "
    "or whole objects. Whole image: as in the thesis, the background counts as not salient.",
    "Background alone: what the rule `on the object, hence salient` gets on the same pixels. What lies beyond it is "
    "what an SVM knows of attention; within the object it is all.",
    "Ours: mean over objects or viewpoints [95 % interval over them]; of one SVM for all, plus or minus the deviation "
    "over its folds, as in the thesis.",
    "Thesis: 43 models with clicked points. Gaze: the peaks of the gaze of 32 people. Other sets: their own ground "
    "truth, for the household objects marks by a vision model.",
]
KEY = ["dataset", "area", "training", "validation"]


def build(results: Results) -> Table:
    parts = []
    for dataset in gaze_first(results.datasets("weights")):
        with suppress(NotRun):
            parts.append(results.measured("weights", dataset, metric="accuracy"))
    if not parts:
        raise NotRun("no SVM was trained", "weights")
    groups = pd.concat(parts).groupby(KEY, sort=False)
    thesis = results.thesis("section_3_2_3_svm_accuracy").set_index("training")
    frame = pd.DataFrame([dict(zip(KEY, key, strict=True)) | _line(group) for key, group in groups])
    frame = frame.sort_values(KEY, key=_place, kind="stable").reset_index(drop=True)
    for column in ("accuracy", "std"):
        frame[f"thesis_{column}"] = [_printed(thesis, column, row) for row in frame.itertuples()]
    return Table("Section 3.2.3: SVMs on pixels, beside the thesis", frame, [*_said(frame), *NOTES], _shown(frame))


def _place(column):
    order = [*AREA, *TRAINING, *VALIDATION]
    return column.map(lambda name: order.index(name) if name in order else 0)


def _line(group):
    mean, low, high = interval(group["value"])
    alone = {"deviation": group["deviation"].mean(), "background_alone": group["background_alone"].mean()}
    return {"accuracy": mean, "low": low, "high": high, "svms": len(group)} | alone


def _printed(thesis, column, row):
    """The thesis's figure, beside the row that follows its way."""
    its_way = row.area == "image" and row.validation == "pixels" and row.training in THESIS
    return thesis.loc[THESIS[row.training], column] if its_way else np.nan


def _said(frame):
    """What the background explains of the thesis's way, source by source."""
    rows = frame[(frame["area"] == "image") & (frame["validation"] == "pixels")]
    rows = rows[rows["training"].isin(THESIS)]
    return [
        f"{row.dataset}, {TRAINING[row.training]}, the thesis's way: {100 * row.accuracy:.1f} %; the background alone "
        f"gives {100 * row.background_alone:.1f} %."
        for row in rows.itertuples()
    ]


def _shown(frame):
    spread = [
        with_interval(row.accuracy, row.low, row.high, 100, 1)
        if row.low == row.low
        else f"{100 * row.accuracy:.1f} ± {100 * row.deviation:.1f}"
        for row in frame.itertuples()
    ]
    return pd.DataFrame(
        {
            "truth": frame["dataset"],
            "pixels of": frame["area"].map(AREA),
            "SVMs": frame["training"].map(TRAINING),
            "left out for testing": frame["validation"].map(VALIDATION),
            "ours, %": spread,
            "background alone, %": [f"{100 * value:.1f}" for value in frame["background_alone"]],
            "thesis, %": [
                f"{100 * row.thesis_accuracy:.1f} ± {100 * row.thesis_std:.1f}"
                if row.thesis_accuracy == row.thesis_accuracy
                else "–"
                for row in frame.itertuples()
            ],
            "number": frame["svms"],
        }
    )

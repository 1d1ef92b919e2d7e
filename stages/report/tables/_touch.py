"""The common shape of T tables 4.1 and 4.2: sampling times classifier, ours beside the thesis's."""

import numpy as np
import pandas as pd

from stages.report.intervals import HOLD_OUT, interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label

OURS = {
    "blind_touch": "random",
    "hks": "heat_kernel",
    "salient_points": "salient_points",
    "mesh_saliency": "mesh_saliency",
    "visual_attention": "itti",
    "enhanced_visual_attention": "thesis_ssim",
}
NOTES = [
    "Each cell: our hold-out accuracy in per cent [95 % interval], then the thesis's figure. A sampling whose "
    'detector this run did not have says "not run".',
    "Enhanced visual attention is the thesis's weighted average, with its SSIM weights (table 3.1). Samplings below "
    "the thesis's own are of this project alone: our model of gaze, and combinations of channels (section 3.1.5).",
    "Data: the thesis scanned toys (cow, dromedary, glasses, hand, plane, cup); these are everyday "
    "meshes of the like, touched by a simulated pressure array. Compare the order of rows and columns, not the digits.",
    "Protocol as in T4.2.4: z-transform, 12 principal components, 25 % held out, five-fold cross-validation on the "
    "rest, both repeated over seeds.",
    "In the CSV, accuracy_apart counts only those test touches that overlap no training touch of the same object: the "
    "difference is what a random hold-out flatters.",
    "The interval runs over repeated splits of the same imprints, widened for what they share (Nadeau and Bengio "
    "2003). It says what another draw of touches of these objects may give; it does not carry over to other objects.",
]


def twin(results, objects, thesis_table, title):
    """The Table of one set of objects beside the thesis's, then the samplings that only this run has.

    title: with {} where the objects are named; the set may hold others, and another number, than its name says.
    """
    rows = results.measured("classification", object=objects)
    left_out = [f"Not run: {note}." for note in results.notes("classification", object=objects)]
    thesis = results.thesis(thesis_table).set_index("sampling")
    extra = [method for method in dict.fromkeys(rows["method"]) if method not in OURS.values()]
    thesis = thesis.reindex([*thesis.index, *extra])
    cells = [
        _cell(rows, sampling, classifier, thesis.loc[sampling, classifier])
        for sampling in thesis.index
        for classifier in thesis.columns
    ]
    frame = pd.DataFrame(cells)
    return Table(title.format(results.set_text(objects)), frame, NOTES + left_out, _wide(frame, thesis))


def _cell(rows, sampling, classifier, printed):
    mine = rows[(rows["method"] == OURS.get(sampling, sampling)) & (rows["classifier"] == classifier)]
    by_metric = mine.groupby("metric")["value"]
    scores = {metric: values.to_numpy() for metric, values in by_metric}
    mean, low, high = interval(scores.get("accuracy_holdout", []), HOLD_OUT)
    others = {metric: interval(scores.get(metric, []))[0] for metric in ("accuracy_fivefold", "accuracy_apart")}
    return {
        "sampling": sampling, "classifier": classifier, "accuracy": mean,
        "low": np.maximum(low, 0.0), "high": np.minimum(high, 1.0),
        "repetitions": len(scores.get("accuracy_holdout", [])), "thesis": printed,
    } | others  # fmt: skip


def _wide(frame, thesis):
    text = [
        f"{with_interval(row.accuracy, row.low, row.high, 100, 0)} · {_percent(row.thesis)}"
        for row in frame.itertuples()
    ]
    wide = frame.assign(text=text).pivot(index="sampling", columns="classifier", values="text")
    wide = wide.loc[thesis.index, thesis.columns]
    wide = wide.rename(columns=lambda name: f"{label(name)}: ours · thesis, %").reset_index()
    names = [name.replace("_", " ") if name in OURS else label(name) for name in wide["sampling"]]
    return wide.assign(sampling=names)


def _percent(share):
    return f"{100 * share:.0f}" if share == share else "–"

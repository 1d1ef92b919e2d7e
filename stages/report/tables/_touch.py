"""The common shape of T tables 4.1, 4.2 and 4.5: sampling times classifier, ours beside the thesis's."""

import numpy as np
import pandas as pd

from stages.report.intervals import HOLD_OUT, interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import NotRun
from stages.report.style import label

OURS = {
    "blind_touch": "random",
    "hks": "heat_kernel",
    "salient_points": "salient_points",
    "mesh_saliency": "mesh_saliency",
    "visual_attention": "itti",
    "enhanced_visual_attention": "thesis_ssim",
}
FIRST = "first_15"  # variants of the classification stage on as many imprints as the thesis had
APART = (
    "Apart: one region of each object is held out, and only touches at least an array's width from it are trained on. "
    "The difference is mostly what a random hold-out flatters, since arrays that overlap feel nearly the same; in the "
    "CSV, accuracy_fewer is a random hold-out with as few touches to train on as apart has."
)
NOTES = [
    "Each cell: our hold-out accuracy in per cent [95 % interval], then our accuracy on regions that no training touch "
    'overlaps ("apart"), then the thesis\'s figure. A sampling whose detector this run did not have says "not run".',
    "Enhanced visual attention is the thesis's weighted average, with its SSIM weights (table 3.1). The sampling "
    "below the thesis's own, our model of gaze, is of this project alone.",
    "Data: the thesis scanned toys (cow, dromedary, glasses, hand, plane, cup); these are everyday "
    "meshes of the like, touched by a simulated pressure array. Compare the order of rows and columns, not the digits.",
    "Protocol as in T4.2.4: z-transform, 12 principal components, 25 % held out, five-fold cross-validation on the "
    "rest, both repeated over seeds.",
    APART,
    "The interval runs over repeated splits of the same imprints, widened for what they share (Nadeau and Bengio "
    "2003). It says what another draw of touches of these objects may give; it does not carry over to other objects.",
]
FEW = (
    "Rows of 15 imprints: only the first 15 of each object, most salient first. The shares of section 4.2.4 (a third, "
    "two fifths, a fifteenth of an object's imprints) say that the thesis had 15."
)


def twin(results, objects, thesis_table, title, variant="plain", few=FIRST):
    """The Table of one set of objects beside the thesis's, then the samplings that only this run has.

    title: with {} where the objects are named; the set may hold others, and another number, than its name says.
    variant, few: of the classification stage, on all imprints and on the first 15.
    """
    rows = results.measured("classification", object=objects, variant=variant)
    left_out = [f"Not run: {note}." for note in results.notes("classification", object=objects, variant=variant)]
    thesis = results.thesis(thesis_table).set_index("sampling")
    extra = [method for method in dict.fromkeys(rows["method"]) if method not in OURS.values()]
    thesis = thesis.reindex([*thesis.index, *extra])
    cells = _cells(rows, thesis)
    notes = NOTES + left_out
    try:
        rows = results.measured("classification", object=objects, variant=few)
    except NotRun as missing:
        notes = [*notes, f"15 imprints an object: not run ({missing})."]
    else:
        cells += [{**cell, "sampling": f"{cell['sampling']}, 15 imprints"} for cell in _cells(rows, thesis)]
        notes = [*notes, FEW]
    frame = pd.DataFrame(cells)
    return Table(title.format(results.set_text(objects)), frame, notes, _wide(frame, thesis))


def _cells(rows, thesis):
    return [
        _cell(rows, sampling, classifier, thesis.loc[sampling, classifier])
        for sampling in thesis.index
        for classifier in thesis.columns
    ]


def _cell(rows, sampling, classifier, printed):
    mine = rows[(rows["method"] == OURS.get(sampling, sampling)) & (rows["classifier"] == classifier)]
    return {"sampling": sampling, "classifier": classifier} | accuracies(mine) | {"thesis": printed}


def accuracies(rows):
    """accuracy, low, high, repetitions of the hold-out, and the means of the other metrics; NaN where not measured."""
    scores = {metric: values.to_numpy() for metric, values in rows.groupby("metric")["value"]}
    mean, low, high = interval(scores.get("accuracy_holdout", []), HOLD_OUT)
    scores.setdefault("accuracy_apart", scores.get("accuracy_side", []))  # where positions are features
    others = ("accuracy_fivefold", "accuracy_apart", "accuracy_fewer")
    return {
        "accuracy": mean, "low": np.maximum(low, 0.0), "high": np.minimum(high, 1.0),
        "repetitions": len(scores.get("accuracy_holdout", [])),
    } | {metric: interval(scores.get(metric, []))[0] for metric in others}  # fmt: skip


def cell_text(cell):
    """`62 [57, 67] · 50 · 51`: ours with its interval, ours apart, the thesis's; per cent. cell: a row of a frame."""
    ours = with_interval(cell.accuracy, cell.low, cell.high, 100, 0)
    return f"{ours} · {percent(cell.accuracy_apart)} · {percent(cell.thesis)}"


def percent(share):
    """A share in per cent, a dash where it is unknown."""
    return f"{100 * share:.0f}" if share == share else "–"


def _wide(frame, thesis):
    text = [cell_text(row) for row in frame.itertuples()]
    wide = frame.assign(text=text).pivot(index="sampling", columns="classifier", values="text")
    wide = wide.loc[list(dict.fromkeys(frame["sampling"])), thesis.columns]
    wide = wide.rename(columns=lambda name: f"{label(name)}: ours · apart · thesis, %").reset_index()
    return wide.assign(sampling=[_spoken(name) for name in wide["sampling"]])


def _spoken(name):
    base, _, few = name.partition(", ")
    spoken = base.replace("_", " ") if base in OURS else label(base)
    return f"{spoken}, {few}" if few else spoken

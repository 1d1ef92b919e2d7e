"""T tables 4.1, 4.2 and 4.5: sampling times classifier, ours beside the thesis's; table 4.1 is drawn as well."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from stages.report.grid import grid
from stages.report.items import Figure, Table
from stages.report.results import NotRun, Results
from stages.report.style import INK, label, plt, save

from .bars import SAMPLINGS, draw_bars
from .rows import OURS, STAGE, accuracies

REGIONS = (
    "Unseen regions: one region of each object is held out, and only touches at least an array's width from it are "
    "trained on. The difference is mostly what a random hold-out flatters, since arrays that overlap feel nearly the "
    "same; in the CSV, accuracy_random_fewer is a random hold-out with as few touches to train on."
)
NOTES = [
    "Each cell: our hold-out accuracy in per cent [95 % interval], then our accuracy on regions that no training touch "
    'overlaps, then the thesis\'s figure. A sampling whose detector this run did not have says "not run".',
    "Enhanced visual attention is the thesis's weighted average, with its SSIM weights (table 3.1). The sampling "
    "below the thesis's own, our model of gaze, is of this project alone.",
    "Data: the thesis scanned toys (cow, dromedary, glasses, hand, plane, cup); these are everyday "
    "meshes of the like, touched by a simulated pressure array. Compare the order of rows and columns, not the digits.",
    "Protocol as in T4.2.4: z-transform, 12 principal components, 25 % held out, five-fold cross-validation on the "
    "rest, both repeated over seeds.",
    "The interval runs over repeated splits of the same imprints, widened for what they share (Nadeau and Bengio "
    "2003). It says what another draw of touches of these objects may give; it does not carry over to other objects.",
]
FEW = (
    "Rows of 15 imprints: only the first 15 of each object, most salient first. The shares of section 4.2.4 (a third, "
    "two fifths, a fifteenth of an object's imprints) say that the thesis had 15."
)
LOCATIONS = [
    "The three coordinates join the 12 components behind the PCA, standardised. They presume that the object stands "
    "as it did in training and that its size and centre are known: all meshes here are centred and of one size.",
    "Unseen regions: here one side of the objects is held out, the same for all. With a region of each object's own, "
    "other objects were touched where this one was not, and its positions would point to them. Not run with 15 "
    "imprints.",
    "locations_turned in the measurements of classification: tested on objects turned about the vertical by an "
    "angle that training did not have.",
]
CLASSIFIERS = ["knn", "svm", "decision_tree", "naive_bayes", "deep_learning"]  # of the figure


def table_4_1(results: Results) -> Table:
    """One touch, six objects."""
    title = "Table 4.1: recognising {} by one touch, beside the thesis"
    return beside_thesis(results, "six", "table_4_1_six_virtual_objects", title)


def table_4_2(results: Results) -> Table:
    """One touch, four objects."""
    title = "Table 4.2: recognising {} by one touch, beside the thesis"
    return beside_thesis(results, "four", "table_4_2_four_virtual_objects", title)


def table_4_5(results: Results) -> Table:
    """One touch, six objects, with the position of the touch as a further feature."""
    title = "Table 4.5: recognising {} by one touch and its position, beside the thesis"
    variants, notes = ("locations", "first_15_locations"), [*LOCATIONS, *NOTES]
    return beside_thesis(results, "six", "table_4_5_six_objects_with_locations", title, variants, notes)


def beside_thesis(
    results: Results,
    group: str,
    printed: str,
    title: str,
    variants: tuple[str, str] = ("plain", "first_15"),
    notes: Sequence[str] = (*NOTES, REGIONS),
) -> Table:
    """The Table of one group of objects beside the thesis's, then the samplings that only this project has.

    title: with {} where the objects are named; the group may hold others, and another number, than its name says.
    variants: of the classification stage, on all imprints and on the first 15.
    """
    every, few = variants
    rows = results.measured(STAGE, group=group, variant=every)
    thesis = results.thesis(printed).set_index("sampling")
    extra = [method for method in dict.fromkeys(rows["method"]) if method not in OURS.values()]
    thesis = thesis.reindex([*thesis.index, *extra])
    cells = _cells(rows, thesis)
    said = [*notes, *(f"Not run: {note}." for note in results.notes(STAGE, group=group, variant=every))]
    try:
        cells += _cells(results.measured(STAGE, group=group, variant=few), thesis, ", 15 imprints")
        said.append(FEW)
    except NotRun as missing:
        said.append(f"15 imprints per object: not run ({missing}).")
    frame = pd.DataFrame(cells)
    shown = grid(
        frame, "sampling", "classifier", beside=("accuracy_regions", "thesis"), names={"sampling": sampling_text},
        head=lambda name: f"{label(name)}: ours · unseen regions · thesis, %",
    )  # fmt: skip
    return Table(title.format(results.group_text(group)), frame, said, shown)


def _cells(rows, thesis, few=""):
    return [
        {"sampling": f"{sampling}{few}", "classifier": classifier}
        | accuracies(rows[(rows["method"] == OURS.get(sampling, sampling)) & (rows["classifier"] == classifier)])
        | {"thesis": thesis.loc[sampling, classifier]}
        for sampling in thesis.index
        for classifier in thesis.columns
    ]


def sampling_text(name: str) -> str:
    """A sampling in words: the thesis's by its own name, ours by its label; `, 15 imprints` stays behind it."""
    base, comma, few = name.partition(", ")
    return (base.replace("_", " ") if base in OURS else label(base)) + comma + few


def figure_4_1(results: Results) -> Figure:
    """Table 4.1 as a picture."""
    frame = table_4_1(results).frame
    figure, axes = plt.subplots(figsize=(8.4, 4.2))
    places = draw_bars(axes, frame, CLASSIFIERS, chance=1 / results.classes("six"))
    for k, (method, place) in enumerate(places.items()):
        rows = frame[frame["sampling"] == SAMPLINGS[method]].set_index("classifier").loc[CLASSIFIERS]
        x, name = np.arange(len(CLASSIFIERS)) + place, None if k else "regions not touched before"
        axes.plot(x, 100 * rows["accuracy_regions"], "_", color=INK, ms=13, mew=2, label=name)
    axes.set_title(f"Recognising {results.group_text('six')} by one touch", pad=42)
    handles, names = axes.get_legend_handles_labels()
    order = sorted(range(len(names)), key=lambda k: names[k].startswith("the thesis"))
    axes.legend(
        [handles[k] for k in order], [names[k] for k in order], loc="lower left", bbox_to_anchor=(-0.01, 0.99),
        ncols=3, fontsize=9, columnspacing=1.4, handlelength=1.2,
    )  # fmt: skip
    return Figure(
        "Table 4.1, drawn",
        "Bars of hold-out accuracy by classifier and sampling, with the accuracy on regions not touched in training as "
        "dashes and the thesis's figures as white diamonds; the numbers are in table 4.1.",
        "Lines on the bars: 95 % intervals over repeated splits of the same imprints. Dashes: one region of each "
        "object is held out, and no training touch overlaps it. Diamonds: the thesis, with other objects.",
        [save(figure, results.reports / "figures/table_4_1.png")],
    )

"""T tables 4.1, 4.2 and 4.5: sampling times classifier, ours beside the thesis's; table 4.1 is drawn as well."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from stages.report.grid import grid
from stages.report.items import Figure, Table
from stages.report.prose import shared_notes
from stages.report.results import NotRun, Results
from stages.report.style import INK, colours, label, plt

from .rows import ENHANCED, MODEL, OURS, STAGE, accuracies, fifteen, sampling_text

DRAWN = {"random": "blind_touch", "itti": "visual_attention", ENHANCED: "enhanced_visual_attention", MODEL: MODEL}
CLASSIFIERS = ("knn", "svm", "decision_tree", "naive_bayes", "deep_learning")  # of the figure


def beside_thesis(results: Results, group: str, printed: str, variant: str = "plain") -> Table:
    """The Table of one group of objects beside the thesis's, then the samplings that only this project has."""
    rows = results.measured(STAGE, group=group, variant=variant)
    thesis = results.thesis(printed).set_index("sampling")
    extra = [method for method in dict.fromkeys(rows["method"]) if method not in OURS.values()]
    thesis = thesis.reindex([*thesis.index, *extra])
    cells = _cells(rows, thesis)
    try:
        cells += _cells(results.measured(STAGE, group=group, variant=fifteen(variant)), thesis, ", 15 imprints")
        few = shared_notes(__package__, "fifteen")
    except NotRun as missing:
        few = f"15 imprints per object: not run ({missing})."
    frame = pd.DataFrame(cells)
    shown = grid(
        frame, "sampling", "classifier", beside=("accuracy_regions", "thesis"), names={"sampling": sampling_text},
        head=lambda name: f"{label(name)}: ours · unseen regions · thesis, %",
    )  # fmt: skip
    words = {name: shared_notes(__package__, name) for name in ("cells", "regions")} | {"fifteen": few}
    words |= {"group": results.group_text(group), "not_run": results.left_out(STAGE, group=group, variant=variant)}
    return Table(frame, shown, words)


def _cells(rows: pd.DataFrame, thesis: pd.DataFrame, few: str = "") -> list[dict]:
    return [
        {"sampling": f"{sampling}{few}", "classifier": classifier}
        | accuracies(rows[(rows["method"] == OURS.get(sampling, sampling)) & (rows["classifier"] == classifier)])
        | {"thesis": thesis.loc[sampling, classifier]}
        for sampling in thesis.index
        for classifier in thesis.columns
    ]


table_4_1 = partial(beside_thesis, group="six", printed="table_4_1_six_virtual_objects")
table_4_2 = partial(beside_thesis, group="four", printed="table_4_2_four_virtual_objects")
table_4_5 = partial(
    beside_thesis, group="six", printed="table_4_5_six_objects_with_locations", variant="locations"
)  # the position of the touch is a further feature


def draw_bars(axes: Axes, frame: pd.DataFrame, classifiers: Sequence[str], chance: float) -> dict[str, float]:
    """Draws the samplings of DRAWN that were run; returns dict method -> its place about the middle of a group.

    frame: the tidy table 4.1 or 4.2 (sampling, classifier, accuracy, low, high, thesis).
    """
    measured = set(frame.dropna(subset=["accuracy"])["sampling"])
    paint = colours([method for method, sampling in DRAWN.items() if sampling in measured])
    width = 0.8 / max(len(paint), 1)
    places = {method: (k - (len(paint) - 1) / 2) * width for k, method in enumerate(paint)}
    for k, (method, place) in enumerate(places.items()):
        rows, x = _drawn(frame, method, classifiers), np.arange(len(classifiers)) + place
        diamonds = None if k else "the thesis's figure"
        axes.bar(x, 100 * rows["accuracy"], width * 0.92, color=paint[method], label=label(method))
        axes.vlines(x, 100 * rows["low"], 100 * rows["high"], color=INK, lw=1)
        axes.plot(x, 100 * rows["thesis"], "D", color="white", mec=INK, ms=5, mew=1.1, label=diamonds)
    axes.axhline(100 * chance, color=INK, lw=0.9, ls=":")
    axes.text(1.01, 100 * chance, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.set_xticks(range(len(classifiers)), [label(name) for name in classifiers])
    axes.set(ylim=(0, 100), ylabel="accuracy, %")
    axes.grid(axis="y")
    axes.tick_params(axis="x", length=0)
    return places


def figure_4_1(results: Results) -> Figure:
    """Table 4.1 as a picture."""
    frame = table_4_1(results).frame
    figure, axes = plt.subplots(figsize=(8.4, 4.2))
    places = draw_bars(axes, frame, CLASSIFIERS, chance=1 / results.classes("six"))
    for k, (method, place) in enumerate(places.items()):
        x, dashes = np.arange(len(CLASSIFIERS)) + place, None if k else "regions not touched before"
        regions = 100 * _drawn(frame, method, CLASSIFIERS)["accuracy_regions"]
        axes.plot(x, regions, "_", color=INK, ms=13, mew=2, label=dashes)
    axes.set_title(f"Recognising {results.group_text('six')} by one touch", pad=42)
    named = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    order = sorted(named, key=lambda name: name.startswith("the thesis"))
    axes.legend(
        [named[name] for name in order], order, loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=3, fontsize=9,
        columnspacing=1.4, handlelength=1.2,
    )  # fmt: skip
    return Figure(figure)


def _drawn(frame: pd.DataFrame, method: str, classifiers: Sequence[str]) -> pd.DataFrame:
    """The rows of one sampling, a classifier each."""
    return frame[frame["sampling"] == DRAWN[method]].set_index("classifier").loc[list(classifiers)]

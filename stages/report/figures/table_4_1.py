"""T table 4.1 as a picture."""

import numpy as np

from stages.report.items import Figure
from stages.report.style import INK, plt, save
from stages.report.tables import table_4_1

from ._bars import SAMPLINGS, draw_bars

CLASSIFIERS = ["knn", "svm", "decision_tree", "naive_bayes", "deep_learning"]


def build(results):
    frame = table_4_1.build(results).frame
    figure, axes = plt.subplots(figsize=(8.4, 4.2))
    places = draw_bars(axes, frame, CLASSIFIERS, chance=1 / results.classes("six"))
    draw_apart(axes, frame, places)
    axes.set_title(f"Recognising {results.set_text('six')} by one touch", pad=42)
    handles, names = axes.get_legend_handles_labels()
    order = sorted(range(len(names)), key=lambda k: names[k].startswith("the thesis"))
    axes.legend(
        [handles[k] for k in order],
        [names[k] for k in order],
        loc="lower left",
        bbox_to_anchor=(-0.01, 0.99),
        ncols=3,
        fontsize=9,
        columnspacing=1.4,
        handlelength=1.2,
    )
    path = save(figure, results.reports / "figures/table_4_1.png")
    return Figure(
        "Table 4.1, drawn",
        "Bars of hold-out accuracy by classifier and sampling, with the accuracy on regions not touched in training as "
        "dashes and the thesis's figures as white diamonds; the numbers are in table 4.1.",
        "Lines on the bars: 95 % intervals over repeated splits of the same imprints. Dashes: one region of each "
        "object is held out, and no training touch overlaps it. Diamonds: the thesis, with other objects.",
        [path],
    )


def draw_apart(axes, frame, places):
    """A dash on each bar: the accuracy on regions that no training touch overlaps. places: of `draw_bars`."""
    for k, (method, place) in enumerate(places.items()):
        rows = frame[frame["sampling"] == SAMPLINGS[method]].set_index("classifier").loc[CLASSIFIERS]
        x = np.arange(len(CLASSIFIERS)) + place
        name = None if k else "regions not touched before"
        axes.plot(x, 100 * rows["accuracy_apart"], "_", color=INK, ms=13, mew=2, label=name)

"""Accuracy by sampling and classifier, as bars, with the thesis's figures as markers."""

import numpy as np

from stages.report.style import INK, colours, label

SAMPLINGS = {
    "random": "blind_touch",
    "itti": "visual_attention",
    "thesis_ssim": "enhanced_visual_attention",
    "enhanced": "enhanced",
}


def draw_bars(axes, frame, classifiers, chance):
    """Draws the samplings of SAMPLINGS that were run; returns dict method -> its place about the middle of a group.

    frame: the tidy table 4.1 or 4.2 (sampling, classifier, accuracy, low, high, thesis).
    """
    measured = set(frame.dropna(subset=["accuracy"])["sampling"])
    shown = [method for method in SAMPLINGS if SAMPLINGS[method] in measured]
    paint, width = colours(shown), 0.8 / max(len(shown), 1)
    places = {method: (k - (len(shown) - 1) / 2) * width for k, method in enumerate(shown)}
    for method, place in places.items():
        rows = frame[frame["sampling"] == SAMPLINGS[method]].set_index("classifier").loc[classifiers]
        x = np.arange(len(classifiers)) + place
        axes.bar(x, 100 * rows["accuracy"], width * 0.92, color=paint[method], label=label(method))
        axes.vlines(x, 100 * rows["low"], 100 * rows["high"], color=INK, lw=1)
        axes.plot(x, 100 * rows["thesis"], "D", color="white", mec=INK, ms=5, mew=1.1, label=thesis_label(method))
    axes.axhline(100 * chance, color=INK, lw=0.9, ls=":")
    axes.text(1.01, 100 * chance, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.set_xticks(range(len(classifiers)), [label(name) for name in classifiers])
    axes.set_ylim(0, 100)
    axes.set_ylabel("accuracy, %")
    axes.grid(axis="y")
    axes.tick_params(axis="x", length=0)
    return places


def thesis_label(method):
    """The name of the markers in the legend, for the first method alone."""
    return "the thesis's figure" if method == next(iter(SAMPLINGS)) else None

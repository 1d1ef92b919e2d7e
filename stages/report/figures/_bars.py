"""Accuracy by sampling and classifier, as bars, with the thesis's figures as markers."""

import numpy as np

from stages.report.style import INK, colours, label

SAMPLINGS = {"random": "blind_touch", "itti": "visual_attention", "enhanced": "enhanced_visual_attention"}


def draw_bars(axes, frame, classifiers, chance):
    """frame: the tidy table of stages.report.tables (sampling, classifier, accuracy, low, high, thesis)."""
    paint = colours(list(SAMPLINGS))
    width = 0.8 / len(SAMPLINGS)
    for place, (method, sampling) in enumerate(SAMPLINGS.items()):
        rows = frame[frame["sampling"] == sampling].set_index("classifier").loc[classifiers]
        x = np.arange(len(classifiers)) + (place - (len(SAMPLINGS) - 1) / 2) * width
        axes.bar(x, 100 * rows["accuracy"], width * 0.92, color=paint[method], label=label(method))
        axes.vlines(x, 100 * rows["low"], 100 * rows["high"], color=INK, lw=1)
        axes.plot(
            x, 100 * rows["thesis"], "D", color="white", mec=INK, ms=5, mew=1.1, ls="none", label=thesis_once(place)
        )
    axes.axhline(100 * chance, color=INK, lw=0.9, ls=":")
    axes.text(1.01, 100 * chance, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.set_xticks(range(len(classifiers)), [label(name) for name in classifiers])
    axes.set_ylim(0, 100)
    axes.set_ylabel("accuracy, %")
    axes.grid(axis="y")
    axes.tick_params(axis="x", length=0)


def thesis_once(place):
    """The markers' name in the legend, once."""
    return "the thesis's figure" if place == 0 else None

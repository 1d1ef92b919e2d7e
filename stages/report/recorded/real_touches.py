"""Accuracy on real touches against the number of real touches in training, with and without simulated imprints."""

from stages.report.items import Figure
from stages.report.style import CYCLE, GREY, INK, MARKERS, label, plt, save

from .simulated_to_real import SIMULATIONS, accuracies

PANELS = ("knn", "deep_learning")  # the best on real touches, and the one that simulation might help to train


def build(results):
    frame = accuracies(results)
    figure, panels = plt.subplots(1, 2, figsize=(9.4, 4.0), sharey=True)
    kinds = [kind for kind in SIMULATIONS if kind in set(frame["simulation"])]
    ticks = sorted(set(frame["touches"]))
    for axes, classifier in zip(panels, PANELS, strict=True):
        for kind, marker in zip(kinds, MARKERS, strict=False):
            own = (frame["simulation"] == kind) & (frame["aligned"] == (kind != "none"))
            mine = frame[own & (frame["classifier"] == classifier)].sort_values("touches")
            place = [ticks.index(count) for count in mine["touches"]]
            tint = INK if kind == "none" else CYCLE[kinds.index(kind) - 1]
            name = "real touches alone" if kind == "none" else SIMULATIONS[kind]
            width = 2.2 if kind == "none" else 1.3
            axes.plot(place, 100 * mine["accuracy"], marker=marker, color=tint, lw=width, ms=4.5, label=name)
            if kind == "none":
                axes.fill_between(place, 100 * mine["low"], 100 * mine["high"], color=tint, alpha=0.12, lw=0)
        axes.axhline(10, color=GREY, lw=0.9, ls=":")
        axes.text(1.01, 10, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
        axes.set_xticks(range(len(ticks)), ticks)
        axes.set_xlabel("real touches of each class in training")
        axes.set_title(label(classifier))
        axes.grid(axis="y")
        axes.set_ylim(0, 100)
    panels[0].set_ylabel("accuracy on real touches, %")
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="lower center", bbox_to_anchor=(0.5, 0.97), ncols=3, fontsize=9)
    return Figure(
        "Do simulated imprints help to recognise real touches?",
        "Accuracy against the number of real touches a class in training, with and without simulated imprints; the "
        "numbers are in the table of the same name.",
        "Ten classes; features aligned where simulated imprints come in; the band is the 95 % interval of real touches "
        "alone. At 0 only simulated imprints were trained on.",
        [save(figure, results.reports / "figures/real_touches.png")],
    )

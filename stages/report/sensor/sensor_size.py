"""The pressure array: accuracy on unseen objects against the number of sensels, for each distance between them."""

import numpy as np
from matplotlib.ticker import FixedLocator, NullLocator

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import CYCLE, MARKERS, label, plain_logarithm, plt, save

from .claims import UNSEEN
from .figure_4_11 import STAGE, cells


def build(results: Results) -> Figure:
    found = cells(results.measured(STAGE, **UNSEEN))
    costs = results.measured(STAGE, metric="seconds_a_touch").set_index(["cells", "pitch"])["value"]
    names = list(dict.fromkeys(found["classifier"]))
    figure, panels = plt.subplots(1, len(names) + 1, figsize=(1.95 * (len(names) + 1), 3.4))
    pitches = sorted(set(found["pitch"]))
    for axes, name in zip(panels, names, strict=False):
        for k, pitch in enumerate(pitches):
            rows = found[(found["classifier"] == name) & (found["pitch"] == pitch)].sort_values("cells")
            x = rows["cells"] * 1.03 ** (k - (len(pitches) - 1) / 2)  # apart, so that no interval hides another
            axes.vlines(x, 100 * rows["low"], 100 * rows["high"], color=CYCLE[k], lw=1, alpha=0.5)
            axes.plot(x, 100 * rows["accuracy"], color=CYCLE[k], marker=MARKERS[k], ms=5, lw=1.3, label=f"{pitch:g}")
        axes.set_title(label(name))
        axes.set_ylim(0, min(100 * found["high"].fillna(found["accuracy"]).max() + 5, 100))
    _costs(panels[-1], costs, pitches)
    sizes = sorted(set(found["cells"]))
    for axes in panels:
        axes.set_xscale("log", base=2)
        axes.xaxis.set_major_locator(FixedLocator(sizes))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xticklabels([f"{size}²" for size in sizes])
        axes.grid(axis="y")
    chance = 100 / results.measured(STAGE, **UNSEEN)["group"].nunique()
    for axes in panels[:-1]:
        axes.axhline(chance, color="#767676", lw=0.8, ls=":")
    for axes in panels[1:-1]:
        axes.tick_params(labelleft=False)
    panels[0].set_ylabel("accuracy on unseen objects, %")
    handles, texts = panels[0].get_legend_handles_labels()
    figure.supxlabel("sensels", fontsize=10, y=0.09)
    figure.tight_layout(w_pad=1.2, rect=(0, 0.09, 1, 1))
    figure.legend(handles, [f"{text} apart" for text in texts], loc="lower center", ncol=len(pitches), fontsize=9)
    path = save(figure, results.reports / "tradeoff/sensor_size.png")
    return Figure(
        "The sensor's size: accuracy against sensels and their distance",
        "A panel a classifier: accuracy against the number of sensels, one line a distance between sensels; the last "
        "panel shows what a simulated touch costs.",
        "One touch of an object that was never touched in training. Lines: 95 % interval over the objects; dotted: "
        "guessing. Distances in units of the mesh, which fits a sphere of diameter 1. Right: seconds of a simulated "
        "touch, those of the cheapest array being 1.",
        [path],
    )


def _costs(axes, costs, pitches):
    """The cost of a simulated touch, as a ratio to the cheapest array's."""
    for k, pitch in enumerate(pitches):
        own = costs.xs(pitch, level="pitch").sort_index() / costs.min()
        axes.plot(own.index, own, color=CYCLE[k], marker=MARKERS[k], ms=5, lw=1.3)
    axes.set_yscale("log")
    plain_logarithm(axes.yaxis)
    axes.set_title("cost of a touch")
    axes.set_ylim(top=np.ceil(costs.max() / costs.min()) * 1.2)

"""The course of the trainings of T table 5.4: accuracy on touches that are learned and on validation touches."""

import pandas as pd
from matplotlib.axes import Axes

from stages.report.drawing import GREY, INK, label, plt, start
from stages.report.items import Figure
from stages.report.networks import FINE, MODES, SPLITS, STARTS, everywhere
from stages.report.results import Results, some

PRINTED_PASSES = 10  # of T tables 5.3 and 5.4
SIDES = {"curve_train_accuracy": "touches that are learned", "curve_validation_accuracy": "validation touches"}
TINTS = dict(zip(SIDES, ("#0072B2", "#D55E00"), strict=True))


def build(results: Results) -> Figure:
    """A panel for each network, start and mode with trainings until nothing improves; a line for each split."""
    where = {"metric": list(SIDES), "data": FINE, "split": "random"}
    rows = pd.concat(everywhere(results, "converged", **where).values())
    order = {name: k for k, name in enumerate((*STARTS, *MODES))}
    kinds = sorted(set(zip(rows["method"], rows["weights"], rows["mode"], strict=True)),
                   key=lambda kind: (order[kind[1]], kind[0], order.get(kind[2], 9), kind[2]))  # fmt: skip
    some(kinds, "no curve of a training until nothing improves", "transfer")
    columns = min(4, len(kinds))
    height = -(-len(kinds) // columns)
    size = (2.7 * columns + 0.6, 2.3 * height + 0.7)
    figure, panels = plt.subplots(height, columns, figsize=size, squeeze=False, sharey=True)
    for axes, (network, weights, mode) in zip(panels.flat, kinds, strict=False):
        mine = rows[(rows["method"] == network) & (rows["weights"] == weights) & (rows["mode"] == mode)]
        _draw(axes, mine)
        axes.set_title(f"{label(network)}, {label(mode)},\n{start(weights)}", fontsize=9)
    for axes in panels.flat[len(kinds) :]:
        axes.set_axis_off()
    panels[0, 0].legend(fontsize=7.5, loc="lower right")
    figure.supxlabel("passes over the touches", fontsize=9)
    figure.supylabel("accuracy, %", fontsize=9)
    figure.tight_layout()
    return Figure(figure, {"splits": SPLITS["random"], "passes": PRINTED_PASSES})


def _draw(axes: Axes, rows: pd.DataFrame) -> None:
    for metric, side in rows.groupby("metric", sort=False):
        for number, (_, one) in enumerate(side.groupby(["dataset", "repetition"])):
            words = SIDES[str(metric)] if number == 0 else None
            axes.plot(one["epoch"], 100 * one["value"], color=TINTS[str(metric)], lw=1, alpha=0.75, label=words)
    axes.axvline(PRINTED_PASSES, color=GREY, lw=0.9, ls="--")
    axes.set_ylim(0, 102)
    axes.tick_params(colors=INK, labelsize=8)
    axes.grid(True)

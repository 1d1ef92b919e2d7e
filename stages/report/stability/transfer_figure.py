"""Accuracy of MobileNetV2 on disturbed imprints, against severity: a panel a perturbation."""

import numpy as np

from stages.report.items import Figure
from stages.report.networks import FINE, mean, measured
from stages.report.results import NotRun, Results
from stages.report.style import GREY, label, save, start

from .panels import bars, finish, panels
from .transfer import KINDS, NETWORK, UNITS

TINTS = dict(zip(KINDS, ("#0072B2", "#56B4E9", "#767676", "#c4c4c4"), strict=True))


def build(results: Results) -> Figure:
    rows = results.table("transfer", "stability.csv")
    rows = rows[(rows["method"] == NETWORK) & (rows["metric"] == "accuracy")]
    found = [name for name in UNITS if name in set(rows["perturbation"])]
    if not found:
        raise NotRun("no disturbed imprints", "transfer")
    clean = measured(results)
    clean = clean[(clean["method"] == NETWORK) & (clean["data"] == FINE) & (clean["split"] == "random")]
    chance = results.measured("transfer", metric="chance", data=FINE, split="random")["value"].mean()
    figure, grid, legend = panels(found, "accuracy, %", 10.2, 2.4)
    for name, axes in grid.items():
        _draw(axes, name, rows[rows["perturbation"] == name], clean)
        axes.axhline(100 * chance, color=GREY, lw=1.2, ls=":")
    for (weights, mode), tint in TINTS.items():
        legend.plot([], [], "o-", color=tint, ms=4, lw=1.4, label=f"{start(weights)}, {label(mode)}")
    legend.plot([], [], ":", color=GREY, lw=1.2, label="guessing")
    legend.legend(loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    return Figure(
        "How recognition by networks degrades",
        f"Line charts of accuracy against the severity of {len(found)} perturbations of imprints, for MobileNetV2.",
        "MobileNetV2 on imprints of 128 x 128, touches at random, learned from clean ones. Each panel goes from no "
        "change (left) to the harshest. Bars: 95 % intervals over repeated splits.",
        [save(figure, results.reports / "figures/transfer_stability.png")],
    )


def _draw(axes, name, rows, clean):
    steps = list(dict.fromkeys(rows["severity"]))
    for (weights, mode), tint in TINTS.items():
        sides = [frame[(frame["weights"] == weights) & (frame["mode"] == mode)] for frame in (clean, rows)]
        if any(side.empty for side in sides):
            continue
        values = [sides[0]["value"], *(sides[1].loc[sides[1]["severity"] == step, "value"] for step in steps)]
        means = np.array([mean(each, "random") for each in values])
        axes.plot(100 * means[:, 0], color=tint, marker="o", ms=3.5, lw=1.4)
        bars(axes, enumerate(means[:, 1:]), tint)
    finish(axes, name, UNITS[name], steps)

"""Accuracy of MobileNetV2 on disturbed imprints, against severity: a panel a perturbation."""

from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import GREY, label, plt, save, start
from stages.report.tables._hybrid import mean
from stages.report.tables._transfer import FINE, measured
from stages.report.tables.transfer_stability import KINDS, NETWORK, UNITS

TINTS = dict(zip(KINDS, ("#0072B2", "#56B4E9", "#767676", "#c4c4c4"), strict=True))
COLUMNS = 4


def build(results):
    rows = results.table("transfer", "stability.csv")
    rows = rows[(rows["method"] == NETWORK) & (rows["metric"] == "accuracy")]
    found = [name for name in UNITS if name in set(rows["perturbation"])]
    if not found:
        raise NotRun("no disturbed imprints", "transfer")
    clean = measured(results)
    clean = clean[(clean["method"] == NETWORK) & (clean["data"] == FINE) & (clean["split"] == "random")]
    chance = results.measured("transfer", metric="chance", data=FINE, split="random")["value"].mean()
    down = -(-(len(found) + 1) // COLUMNS)
    figure, grid = plt.subplots(down, COLUMNS, figsize=(10.2, 2.4 * down), squeeze=False, sharey=True)
    for axes, name in zip(grid.flat, found, strict=False):
        _draw(axes, rows[rows["perturbation"] == name], clean)
        axes.axhline(100 * chance, color=GREY, lw=1.2, ls=":")
        axes.set_title(label(name), fontsize=10)
        axes.set_xlabel(UNITS[name], fontsize=8)
    for axes in grid[:, 0]:
        axes.set_ylabel("accuracy, %")
    for axes in grid.flat[len(found) :]:
        axes.set_axis_off()
    for (weights, mode), tint in TINTS.items():
        grid.flat[len(found)].plot([], [], "o-", color=tint, ms=4, lw=1.4, label=f"{start(weights)}, {label(mode)}")
    grid.flat[len(found)].plot([], [], ":", color=GREY, lw=1.2, label="guessing")
    grid.flat[len(found)].legend(loc="center left", fontsize=9)
    figure.tight_layout(h_pad=1.2, w_pad=0.6)
    return Figure(
        "How recognition by networks degrades",
        f"Line charts of accuracy against the severity of {len(found)} perturbations of imprints, for MobileNetV2.",
        "MobileNetV2 on imprints of 128 x 128, touches at random, learned from clean ones. Each panel goes from no "
        "change (left) to the harshest. Bars: 95 % intervals over repeated splits.",
        [save(figure, results.reports / "figures/transfer_stability.png")],
    )


def _draw(axes, rows, clean):
    steps = list(dict.fromkeys(rows["severity"]))
    for (weights, mode), tint in TINTS.items():
        sides = [frame[(frame["weights"] == weights) & (frame["mode"] == mode)] for frame in (clean, rows)]
        if any(side.empty for side in sides):
            continue
        values = [sides[0]["value"], *(sides[1].loc[sides[1]["severity"] == step, "value"] for step in steps)]
        bars = [mean(each, "random") for each in values]
        axes.plot([100 * bar[0] for bar in bars], color=tint, marker="o", ms=3.5, lw=1.4)
        for place, (_, low, high) in enumerate(bars):
            axes.plot([place, place], [100 * low, 100 * high], color=tint, lw=0.9, alpha=0.4)
    axes.set_xticks(range(len(steps) + 1), ["none", *(f"{step:g}" for step in steps)], fontsize=8)
    axes.set_ylim(0, 100)
    axes.grid(axis="y")

"""T figure 5.3: what fine-tuning adds to frozen filters, network by network."""

import numpy as np

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.networks import COARSE, FINE, PRINTED, SPLITS, everywhere, shared
from stages.report.results import NotRun
from stages.report.style import GREY, INK, PALE, label, plt, save
from stages.report.words import dataset_text

TINTS = {("random", FINE): "#0072B2", ("objects", FINE): "#56B4E9", ("random", COARSE): "#D55E00",
         ("objects", COARSE): "#E69F00"}  # fmt: skip
THESIS = {FINE: "table_5_4_simulated_fsr_128x128", COARSE: "table_5_3_fsr_16x16"}
CELLS = {FINE: "128 x 128", COARSE: "16 x 16"}


def build(results):
    found = {source: _gains(rows) for source, rows in everywhere(results).items()}
    found = {source: gains for source, gains in found.items() if gains}
    if not found:
        raise NotRun("no network was both fine-tuned and frozen", "transfer")
    networks = list(dict.fromkeys(network for gains in found.values() for network, *_ in gains))
    figure, grid = plt.subplots(
        1, len(found), figsize=(4.6 * len(found) + 2.2, 1.0 * len(networks) + 1.9), squeeze=False, sharey=True
    )
    for axes, (source, gains) in zip(grid[0], found.items(), strict=True):
        _draw(axes, gains, networks, results)
        axes.set_title(dataset_text(source))
    grid[0, 0].set_yticks(range(len(networks)), [label(name) for name in networks])
    grid[0, 0].set_ylim(len(networks) - 0.4, -0.6)
    _legend(grid[0, -1])
    figure.tight_layout()
    return Figure(
        "Figure 5.3: what fine-tuning adds",
        "Accuracy of fine-tuned minus frozen networks in points, one row per network, by array and split.",
        "Accuracy of the network with all layers tuned on imprints minus that with frozen filters, ImageNet's weights. "
        "Lines: 95 % interval of the paired difference, over repeated splits (touches at random) or folds of objects "
        "left out. Diamonds: the thesis's figures, of touches at random.",
        [save(figure, results.reports / "figures/figure_5_3.png")],
    )


def _gains(rows):
    """{(network, split, data): (mean, low, high) in points} of the pairs that were measured."""
    seen, found = rows[rows["weights"] == "imagenet"], {}
    for (network, split, data), group in seen.groupby(["method", "split", "data"], sort=False):
        sides = group.pivot_table(index="repetition", columns="mode", values="value")
        if (split, data) in TINTS and {"finetuned", "frozen"} <= set(sides):
            gain = (sides["finetuned"] - sides["frozen"]).dropna()
            if len(gain):
                found[network, split, data] = interval(100 * gain, shared(split, group["dataset"].iloc[0]))
    return found


def _draw(axes, gains, networks, results):
    for (network, split, data), (mean, low, high) in gains.items():
        place = networks.index(network) + 0.17 * (list(TINTS).index((split, data)) - 1.5)
        axes.plot([low, high], [place] * 2, color=TINTS[split, data], lw=1.6, alpha=0.5)
        axes.plot(mean, place, "o", color=TINTS[split, data], ms=5, mec="white", mew=0.5)
        if split == "random" and network in PRINTED:
            row = results.thesis(THESIS[data]).set_index("network").loc[PRINTED[network]]
            gap = 100 * (row["acc_finetuned"] - row["acc_frozen"])
            axes.plot(gap, place, "D", color="white", mec=TINTS[split, data], ms=5, mew=1.2)
    axes.axvline(0, color=INK, lw=0.8)
    axes.hlines(np.arange(len(networks) - 1) + 0.5, 0, 1, transform=axes.get_yaxis_transform(), color=PALE, lw=0.5)
    axes.set_xlabel("fine-tuned minus frozen, points of accuracy")
    axes.grid(axis="x")
    axes.tick_params(axis="y", length=0)


def _legend(axes):
    for (split, data), tint in TINTS.items():
        axes.plot([], [], "o", color=tint, ms=5, label=f"{CELLS[data]}, {SPLITS[split]}")
    axes.plot([], [], "D", color="white", mec=GREY, ms=5, mew=1.2, label="the thesis's figure")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8.5)

"""Whether a stated belief is to be believed: accuracy against stated confidence."""

from stages.report.intervals import interval, shared_by
from stages.report.items import Figure
from stages.report.style import GREY, colours, label, plt, save
from stages.report.tables._exploration import LIKELIHOODS

SET, WAY = "six", "random"
SPLITS = ("anywhere", "apart")
SHOWN = ("imprint", "imprint_product")


def build(results):
    rows = results.measured("exploration", object=SET, way=WAY, stop="fixed", metric="accuracy")
    methods = list(dict.fromkeys(rows["method"]))
    figure, grid = plt.subplots(1, len(SPLITS), figsize=(8.4, 4.0), sharex=True, sharey=True)
    for axes, split in zip(grid, SPLITS, strict=True):
        axes.plot([0, 1], [0, 1], color=GREY, lw=0.8)
        for likelihood in SHOWN:
            _draw(axes, rows[(rows["split"] == split) & (rows["likelihood"] == likelihood)], likelihood, methods)
        axes.set_title(f"places held out {split}")
        axes.set_xlabel("stated belief in the likeliest object")
        axes.set_xlim(0.3, 1.0)
        axes.set_ylim(0.3, 1.0)
        axes.set_aspect("equal")
        axes.grid()
    grid[0].set_ylabel("rate of right answers")
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9)
    figure.tight_layout()
    most = int(rows["level"].max())
    return Figure(
        "How far the stated belief is to be believed",
        "Accuracy against stated belief, with the diagonal of perfect calibration: of the corrected belief and of the "
        "product of likelihoods, with held-out touches anywhere and apart.",
        f"Each line goes from one touch to {most}, in random order; {results.set_text(SET)}; bars are 95 % intervals. "
        "On the grey line a stated 95 % means 95 %; below it the robot is too sure, above it too careful. Solid: with "
        "the exponent fitted on training touches; dotted: likelihoods multiplied as if touches were independent.",
        [save(figure, results.reports / "figures/exploration_calibration.png")],
    )


def _draw(axes, panel, likelihood, methods):
    solid = likelihood == SHOWN[0]
    for method, tint in colours(methods).items():
        lines = [group for _, group in panel[panel["method"] == method].groupby("level")]
        stated = [group["belief"].mean() for group in lines]
        values = [interval(group["value"], shared_by(group["split"].iloc[0])) for group in lines]
        axes.plot(
            stated, [mean for mean, _, _ in values], "-" if solid else ":", marker="o" if solid else "^", ms=3.5,
            lw=1.3, color=tint, label=f"{label(method)},\n{LIKELIHOODS[likelihood]}",
        )  # fmt: skip
        for x, (_, low, high) in zip(stated, values, strict=True):
            axes.plot([x, x], [low, high], color=tint, lw=0.8, alpha=0.35)

"""Whether a stated belief is to be believed: accuracy against stated confidence."""

from stages.kit.split import Split
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import GREY, colours, label, plt

from .rows import GROUP, LIKELIHOODS, STAGE, points

SPLITS = (Split.RANDOM, Split.REGIONS)
SHOWN = ("imprint", "imprint_product")


def build(results: Results) -> Figure:
    """Accuracy against stated belief, for a fixed number of touches in random order."""
    rows = results.measured(STAGE, group=GROUP, way="random", stop="fixed", metric="accuracy")
    frame = points(rows, ["split", "likelihood", "method", "level"])
    methods = list(dict.fromkeys(rows["method"]))
    figure, grid = plt.subplots(1, len(SPLITS), figsize=(8.4, 4.0), sharex=True, sharey=True)
    for axes, split in zip(grid, SPLITS, strict=True):
        axes.plot([0, 1], [0, 1], color=GREY, lw=0.8)
        for likelihood in SHOWN:
            _draw(axes, frame[(frame["split"] == split) & (frame["likelihood"] == likelihood)], likelihood, methods)
        axes.set_title(split.words)
        axes.set_xlabel("stated belief in the likeliest object")
        axes.set_xlim(0.3, 1.0)
        axes.set_ylim(0.3, 1.0)
        axes.set_aspect("equal")
        axes.grid()
    grid[0].set_ylabel("rate of right answers")
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9)
    figure.tight_layout()
    return Figure(figure, {"most": int(rows["level"].max()), "group": results.group_text(GROUP)})


def _draw(axes, panel, likelihood, methods):
    solid = likelihood == SHOWN[0]
    for method, tint in colours(methods).items():
        line = panel[panel["method"] == method].sort_values("level")
        axes.plot(
            line["stated"], line["accuracy"], "-" if solid else ":", marker="o" if solid else "^", ms=3.5,
            lw=1.3, color=tint, label=f"{label(method)},\n{LIKELIHOODS[likelihood]}",
        )  # fmt: skip
        axes.vlines(line["stated"], line["low"], line["high"], color=tint, lw=0.8, alpha=0.35)

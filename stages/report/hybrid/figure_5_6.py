"""T figure 5.6: what the hybrid network takes for what, by sight and by touch."""

from itertools import product

from stages.report.confusion import draw_matrix
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import plt

from .section_5_5 import ITEMS, MIDDLE, SENSES


def build(results: Results) -> Figure:
    """Confusion matrices, senses in columns and splits in rows."""
    frame = results.measured("transfer", method="hybrid", metric="confusion", mode=MIDDLE)
    splits = [split for split in ITEMS if split in set(frame["split"])]
    classes = list(frame["group"].unique())
    side, count = 0.3 * len(classes) + 0.5, len(classes)
    size = (side * len(SENSES) + 1.4, side * len(splits) + 0.8)
    figure, grid = plt.subplots(len(splits), len(SENSES), figsize=size, squeeze=False)
    for axes, (split, sense) in zip(grid.flat, product(splits, SENSES), strict=True):
        draw_matrix(axes, frame[(frame["split"] == split) & (frame["sense"] == sense)], classes)
    for axes, split in zip(grid[:, 0], splits, strict=True):
        axes.set_yticks(range(count), [f"{one} {k + 1}" for k, one in enumerate(classes)], fontsize=7.5)
        axes.set_ylabel(ITEMS[split], fontsize=9)
    for top, bottom, word in zip(grid[0], grid[-1], SENSES.values(), strict=True):
        top.set_title(f"by {word}", pad=6)
        bottom.set_xticks(range(count), range(1, count + 1), fontsize=7.5)
    figure.subplots_adjust(wspace=0.06, hspace=0.08)
    said = ", ".join(ITEMS[split] for split in splits)
    return Figure(figure, {"count": count, "classes": ", ".join(classes), "splits": said})

"""T figure 5.6: what the hybrid network takes for what, by sight and by touch."""

from stages.report.confusion import draw_matrix
from stages.report.items import Figure
from stages.report.networks import SPLITS
from stages.report.results import NotRun
from stages.report.style import plt, save

from .rows import MIDDLE, SENSES


def build(results):
    frame = results.table("transfer", "hybrid/confusion.csv")
    middle = MIDDLE.replace(":", "-")
    parts = frame["trial"].str.split(".", expand=True)
    frame = frame.assign(middle=parts[1], split=parts[2])
    frame = frame[frame["middle"] == middle]
    splits = [split for split in SPLITS if split in set(frame["split"])]
    if not splits:
        raise NotRun("no confusion matrices of the hybrid network", "transfer")
    classes = list(dict.fromkeys(frame["true"]))
    side = 0.3 * len(classes) + 0.5
    figure, grid = plt.subplots(
        len(splits), len(SENSES), figsize=(side * len(SENSES) + 1.4, side * len(splits) + 0.8), squeeze=False
    )
    for down, split in enumerate(splits):
        for along, sense in enumerate(SENSES):
            draw_matrix(grid[down, along], frame[(frame["split"] == split) & (frame["sense"] == sense)], classes)
        names = [f"{one} {k + 1}" for k, one in enumerate(classes)]
        grid[down, 0].set_yticks(range(len(classes)), names, fontsize=7.5)
        grid[down, 0].set_ylabel(SPLITS[split].replace("touches", "items"), fontsize=9)
    for axes, word in zip(grid[0], SENSES.values(), strict=True):
        axes.set_title(f"by {word}", pad=6)
    for axes in grid[-1]:
        axes.set_xticks(range(len(classes)), range(1, len(classes) + 1), fontsize=7.5)
    figure.subplots_adjust(wspace=0.06, hspace=0.08)
    return Figure(
        "Figure 5.6: what the hybrid network takes for what",
        f"Confusion matrices of {len(classes)} classes ({', '.join(classes)}), by sight and by touch in columns; "
        + ", ".join(SPLITS[split] for split in splits)
        + " in rows.",
        "Rows: the class of the object; columns: the class that was answered; per cent of the row, all repetitions "
        "together. Numbers below 1 are left out.",
        [save(figure, results.reports / "figures/figure_5_6.png")],
    )

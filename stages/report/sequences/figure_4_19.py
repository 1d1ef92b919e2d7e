"""T figure 4.19: which classes are taken for which, blindly and guided."""

from stages.report.confusion import draw_matrix
from stages.report.items import Figure
from stages.report.style import label, plt, save

from .rows import BLIND, CLASSIFIERS, GUIDED, PRINTED, SPLITS


def build(results):
    frame = results.table("sequences", "confusion.csv")
    classes = list(dict.fromkeys(frame["true"]))
    here = set(zip(frame["split"], frame["method"], strict=True))
    lines = [(split, method) for split in SPLITS for method in (BLIND, GUIDED) if (split, method) in here]
    names = [name for name in PRINTED if name in set(frame["classifier"])]
    side = 0.3 * len(classes) + 0.5
    figure, grid = plt.subplots(
        len(lines), len(names), figsize=(side * len(names) + 1.4, side * len(lines) + 0.8), squeeze=False
    )
    for down, (split, method) in enumerate(lines):
        for along, name in enumerate(names):
            rows = frame[(frame["split"] == split) & (frame["method"] == method) & (frame["classifier"] == name)]
            draw_matrix(grid[down, along], rows, classes)
        grid[down, 0].set_yticks(range(len(classes)), [f"{one} {k + 1}" for k, one in enumerate(classes)], fontsize=7.5)
        grid[down, 0].set_ylabel(f"{label(method)}\n{SPLITS[split]}", fontsize=9)
    for axes, name in zip(grid[0], names, strict=True):
        axes.set_title(CLASSIFIERS[name], pad=6)
    for axes in grid[-1]:
        axes.set_xticks(range(len(classes)), range(1, len(classes) + 1), fontsize=7.5)
    figure.subplots_adjust(wspace=0.06, hspace=0.08)
    path = save(figure, results.reports / "figures/figure_4_19.png")
    return Figure(
        "Figure 4.19: what is taken for what",
        f"Confusion matrices of {len(classes)} classes ({', '.join(classes)}): "
        + "; ".join(f"{label(method)}, {SPLITS[split]}" for split, method in lines)
        + " in rows, "
        + ", ".join(CLASSIFIERS[name] for name in names)
        + " in columns.",
        "Rows: the class that was touched; columns: the class that was answered; per cent of the row, all rounds "
        "together. Numbers below 1 are left out.",
        [path],
    )

"""T figure 4.19: which classes are taken for which, blindly and guided."""

from stages.report.confusion import draw_matrix
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import label, plt

from .rows import BLIND, CLASSIFIERS, GUIDED, PRINTED, SPLITS, STAGE


def build(results: Results) -> Figure:
    """Confusion matrices: a row for each split and strategy, a column for each classifier of the thesis."""
    frame = results.measured(STAGE, metric="confusion")
    classes, here = list(dict.fromkeys(frame["group"])), set(zip(frame["split"], frame["method"], strict=True))
    lines = [(split, method) for split in SPLITS for method in (BLIND, GUIDED) if (split, method) in here]
    names = [name for name in PRINTED if name in set(frame["classifier"])]
    side = 0.3 * len(classes) + 0.5
    size = (side * len(names) + 1.4, side * len(lines) + 0.8)
    figure, grid = plt.subplots(len(lines), len(names), figsize=size, squeeze=False)
    for panels, (split, method) in zip(grid, lines, strict=True):
        mine = frame[(frame["split"] == split) & (frame["method"] == method)]
        for axes, name in zip(panels, names, strict=True):
            draw_matrix(axes, mine[mine["classifier"] == name], classes)
        numbered = [f"{one} {k}" for k, one in enumerate(classes, start=1)]
        panels[0].set_yticks(range(len(classes)), numbered, fontsize=7.5)
        panels[0].set_ylabel(f"{label(method)}\n{SPLITS[split]}", fontsize=9)
    for top, bottom, name in zip(grid[0], grid[-1], names, strict=True):
        top.set_title(CLASSIFIERS[name], pad=6)
        bottom.set_xticks(range(len(classes)), range(1, len(classes) + 1), fontsize=7.5)
    figure.subplots_adjust(wspace=0.06, hspace=0.08)
    rows = "; ".join(f"{label(method)}, {SPLITS[split]}" for split, method in lines)
    columns = ", ".join(CLASSIFIERS[name] for name in names)
    return Figure(figure, {"count": len(classes), "classes": ", ".join(classes), "rows": rows, "columns": columns})

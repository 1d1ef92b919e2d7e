"""T figure 3.29: where a network looks for the object itself, from three sides."""

from stages.report.drawing import colour_bar, picture, square_grid
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import label, save
from stages.report.tables._fixation import spoken_network, stored, stored_networks, stored_tasks, untrained

from .figure_3_30 import ROWS, VIEWS, large, sizes, veiled

TASK = "level_3"


def build(results):
    name = results.choose(results.settings.figure_objects, 1, "fixation")[0]
    arrays, mesh, tasks = stored(results, name), results.mesh(name), stored_tasks(results)
    methods = [method for method in stored_networks(arrays) if not untrained(method)]
    if not methods or TASK not in tasks:
        raise NotRun(f"no network named {name} itself", "fixation", runnable=False)
    place = list(tasks).index(TASK)
    renders = [picture(mesh, viewpoint=viewpoint, rows=ROWS) for viewpoint in VIEWS]
    figure, grid = square_grid(len(methods), len(VIEWS), side=1.9, right=0.9)
    for row, method in zip(grid, methods, strict=True):
        for axes, render, cams in zip(row, renders, arrays[f"{method}.maps"], strict=True):
            axes.imshow(veiled(render, large(cams, method.rpartition("-")[0])[place]))
            axes.set_axis_off()
        row[0].text(-0.05, 0.5, spoken_network(method).replace(", ", "\n"), rotation=90, va="center", ha="right",
                    fontsize=8.5, transform=row[0].transAxes)  # fmt: skip
    colour_bar(figure, [0.93, 0.15, 0.014, 0.7], "over its maximum")
    return Figure(
        "Figure 3.29: where networks look from three sides",
        f"Three views of {name} under the Grad-CAM maps of {label(TASK)}, the object itself, a row each for "
        f"{'; '.join(map(spoken_network, methods))}; dark is low, yellow high.",
        f"Maps of {sizes(arrays, methods)} pixels of the task of {label(TASK)}: to name the object itself among all. "
        "Untrained networks are left out.",
        [save(figure, results.reports / "figures/figure_3_29.png")],
    )

"""T figure 3.12: saliency by the classical model, by equal and learned weights, and by our model, beside the truth."""

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from stages.report.drawing import show, square_grid, vivid
from stages.report.items import Figure
from stages.report.style import GREY, MAP, label, save

METHODS = ("itti", "VisAttAll", "guided_ed", "guided_ssim", "enhanced")
COUNT = 4


def build(results):
    names = results.taught(results.settings.figure_objects, COUNT)
    methods = results.saliency(names[0]).those_of(METHODS)
    figure, grid = square_grid(len(names), len(methods) + 1, side=1.7, right=0.9)
    for row, name in zip(grid, names, strict=True):
        mesh, lesson, found = results.mesh(name), results.lesson(name), results.saliency(name)
        for axes, method in zip(row, methods, strict=False):
            show(axes, mesh, vivid(found[method]))
        show(row[-1], mesh, vivid(lesson["density"]), points=lesson["points"])
        row[0].text(-0.04, 0.5, name, rotation=90, va="center", ha="right", transform=row[0].transAxes)
    for axes, title in zip(grid[0], [*map(label, methods), "ground truth"], strict=True):
        axes.set_title(title, fontsize=10, fontweight="normal", loc="center")
    bar = figure.colorbar(ScalarMappable(Normalize(0, 1), MAP), cax=figure.add_axes([0.945, 0.2, 0.012, 0.6]))
    bar.set_label("over the 98 % quantile")
    bar.outline.set_edgecolor(GREY)
    path = save(figure, results.reports / "figures/figure_3_12.png")
    return Figure(
        "Figure 3.12: saliency by equal weights, by learned ones, and by our model",
        f"Meshes of {', '.join(names)}, coloured by saliency from dark (low) to yellow (high): "
        f"{', '.join(map(label, methods))}, and the ground truth with its points.",
        "Each map over its own 98 % quantile. Weights were learned from the other objects. Ground truth: red, the "
        "points that were marked (for the household objects by a vision model, no human subjects); yellow, the same "
        "spread along the surface.",
        [path],
    )

"""Meshes coloured by saliency, with the points."""

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from stages.report.drawing import show, square_grid, vivid
from stages.report.items import Figure
from stages.report.style import GREY, MAP, label, save

METHODS = ("itti", "enhanced")
COUNT = 6


def build(results):
    names = results.choose(results.settings.figure_objects, COUNT)
    methods = results.saliency(names[0]).those_of(METHODS)
    figure, grid = square_grid(len(methods), len(names), side=1.7, right=0.9)
    for down, method in enumerate(methods):
        for across, name in enumerate(names):
            axes = grid[down, across]
            values, points = vivid(results.saliency(name)[method]), results.strong_points(name)[method]
            show(axes, results.mesh(name), values, points=points)
            if down == 0:
                axes.set_title(name, fontsize=10, fontweight="normal", loc="center")
        grid[down, 0].text(-0.04, 0.5, label(method), rotation=90, va="center", ha="right",
                           transform=grid[down, 0].transAxes)  # fmt: skip
    bar = figure.colorbar(ScalarMappable(Normalize(0, 1), MAP), cax=figure.add_axes([0.945, 0.15, 0.012, 0.7]))
    bar.set_label("saliency over its 98 % quantile")
    bar.outline.set_edgecolor(GREY)
    path = save(figure, results.reports / "figures/saliency.png")
    return Figure(
        "Saliency and the points worth touching",
        f"Meshes of {', '.join(names)}, coloured by saliency from dark (low) to yellow (high), with the strongest "
        "points marked; " + " above ".join(map(label, methods)) + ".",
        "Red: the strongest points, those that pass the method's own threshold, on the side that is seen.",
        [path],
    )

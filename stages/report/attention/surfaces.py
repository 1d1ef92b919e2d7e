"""Meshes coloured by saliency: with the strongest points, and beside the truth (T figure 3.12)."""

from stages.report.drawing import colour_bar, show, square_grid, vivid
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import label, save

METHODS = ("itti", "enhanced")
BESIDE_TRUTH = ("itti", "VisAttAll", "guided_ed", "guided_ssim", "enhanced")
COUNT, FEW = 6, 4  # objects of the two figures
SIDE = {"rotation": 90, "va": "center", "ha": "right"}


def saliency(results: Results) -> Figure:
    """Saliency and the strongest points."""
    names = results.choose(results.settings.figure_objects, COUNT)
    methods = results.saliency(names[0]).those_of(METHODS)
    figure, grid = square_grid(len(methods), len(names), side=1.7, right=0.9)
    for row, method in zip(grid, methods, strict=True):
        for axes, name in zip(row, names, strict=True):
            values, points = vivid(results.saliency(name)[method]), results.strong_points(name)[method]
            show(axes, results.mesh(name), values, points=points)
        row[0].text(-0.04, 0.5, label(method), transform=row[0].transAxes, **SIDE)
    _titles(grid, names)
    colour_bar(figure, [0.945, 0.15, 0.012, 0.7], "saliency over its 98 % quantile")
    return Figure(
        "Saliency and the points worth touching",
        f"Meshes of {', '.join(names)}, coloured by saliency from dark (low) to yellow (high), with the strongest "
        "points marked; " + " above ".join(map(label, methods)) + ".",
        "Red: the strongest points, those that pass the method's own threshold, on the side that is seen.",
        [save(figure, results.reports / "figures/saliency.png")],
    )


def figure_3_12(results: Results) -> Figure:
    """Saliency by the classical model, by equal and learned weights, and by our model, beside the truth."""
    names = results.with_ground_truth(results.settings.figure_objects, FEW)
    methods = results.saliency(names[0]).those_of(BESIDE_TRUTH)
    figure, grid = square_grid(len(names), len(methods) + 1, side=1.7, right=0.9)
    for row, name in zip(grid, names, strict=True):
        mesh, ground_truth, found = results.mesh(name), results.ground_truth(name), results.saliency(name)
        for axes, method in zip(row, methods, strict=False):
            show(axes, mesh, vivid(found[method]))
        show(row[-1], mesh, vivid(ground_truth["density"]), points=ground_truth["points"])
        row[0].text(-0.04, 0.5, name, transform=row[0].transAxes, **SIDE)
    _titles(grid, [*map(label, methods), "ground truth"])
    colour_bar(figure, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile")
    return Figure(
        "Figure 3.12: saliency by equal weights, by learned ones, and by our model",
        f"Meshes of {', '.join(names)}, coloured by saliency from dark (low) to yellow (high): "
        f"{', '.join(map(label, methods))}, and the ground truth with its points.",
        "Each map over its own 98 % quantile. Weights were learned from the other objects. Ground truth: red, the "
        "points that were marked (for the household objects by a vision model, no human subjects); yellow, the same "
        "spread along the surface.",
        [save(figure, results.reports / "figures/figure_3_12.png")],
    )


def _titles(grid, titles):
    for axes, title in zip(grid[0], titles, strict=True):
        axes.set_title(title, fontsize=10, fontweight="normal", loc="center")

"""Meshes coloured by saliency: with the strongest points, and beside the truth (T figure 3.12)."""

from collections.abc import Iterable

import numpy as np

from stages.report.drawing import colour_bar, show, square_grid, vivid
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import label

METHODS = ("itti", "enhanced")
BESIDE_TRUTH = ("itti", "VisAttAll", "guided_ed", "guided_ssim", "enhanced")
COUNT, FEW = 6, 4  # objects of the two figures


def saliency(results: Results) -> Figure:
    """Saliency and the strongest points."""
    names = results.choose(results.settings.figure_objects, COUNT)
    methods = results.saliency(names[0]).those_of(METHODS)
    figure, grid = square_grid(len(methods), len(names), side=1.7, right=0.9)
    for row, method in zip(grid, methods, strict=True):
        for axes, name in zip(row, names, strict=True):
            values, points = vivid(results.saliency(name)[method]), results.strong_points(name)[method]
            show(axes, results.mesh(name), values, points=points)
    _titles(grid, names, map(label, methods))
    colour_bar(figure, [0.945, 0.15, 0.012, 0.7], "saliency over its 98 % quantile")
    return Figure(figure, {"objects": ", ".join(names), "methods": " above ".join(map(label, methods))})


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
    _titles(grid, [*map(label, methods), "ground truth"], names)
    colour_bar(figure, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile")
    return Figure(figure, {"objects": ", ".join(names), "methods": ", ".join(map(label, methods))})


def _titles(grid: np.ndarray, above: Iterable[str], beside: Iterable[str]) -> None:
    """Words over each column and, upright, before each row."""
    for axes, title in zip(grid[0], above, strict=True):
        axes.set_title(title, fontsize=10, fontweight="normal", loc="center")
    for axes, text in zip(grid[:, 0], beside, strict=True):
        axes.text(-0.04, 0.5, text, transform=axes.transAxes, rotation=90, va="center", ha="right")

"""T figure 3.8: an object, its points, levels of detail, and where each level is wrong."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize

from stages.kit import Mesh
from stages.lod.metro import vertex_errors
from stages.report.drawing import VIEWPOINT, show, square_grid, squared
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import GREY, label, save
from stages.views import render

from .lod_detectors import short
from .rows import PLAIN, size

METHODS = ("VisAttCurvSymCon", "thesis_ssim", "enhanced")  # the thesis's, or the next that was run
LEVELS = 3
# T figure 3.8 and CloudCompare: blue perfect, then green, yellow, red.
COLOURS = LinearSegmentedColormap.from_list("error", ["#2c4fd8", "#35b46a", "#f2d530", "#d7261e"])
TOP = 0.98  # quantile of all errors shown that is red
ROWS = 330


def build(results: Results) -> Figure:
    name, method = _shown(results)
    mesh, points = results.mesh(name), results.strong_points(name)[method]
    levels = [dict(results.lods(name, way)) for way in (method, PLAIN)]
    targets = sorted(set(levels[0]) & set(levels[1]), key=size)[-LEVELS:]
    fields = [[_error(mesh, level[target]) for target in targets] for level in levels]
    top = float(np.quantile(np.concatenate(sum(fields, [])), TOP)) or 1.0
    figure, grid = square_grid(3, len(targets) + 1, side=1.9, right=0.9, gap=0.25)
    show(grid[0, 0], mesh, points=points, rows=ROWS)
    _titled(grid[0, 0], f"original: {len(mesh.faces):,} faces, {len(points)} points")
    for across, target in enumerate(targets, start=1):
        show(grid[0, across], levels[0][target], wires=True, rows=ROWS)
        _titled(grid[0, across], f"{len(levels[0][target].faces):,} faces")
        for down in (1, 2):
            _coloured(grid[down, across], mesh, fields[down - 1][across - 1] / top)
    for down, words in ((1, f"error,\n{short(method)} kept"), (2, f"error,\n{label(PLAIN)}")):
        grid[down, 0].text(0.95, 0.5, words, ha="right", va="center", transform=grid[down, 0].transAxes)
        grid[down, 0].set_axis_off()
    scale = ScalarMappable(Normalize(0, 100 * top), COLOURS)
    bar = figure.colorbar(scale, cax=figure.add_axes([0.93, 0.1, 0.012, 0.5]), extend="max")
    bar.set_label("distance, % of the diagonal")
    bar.outline.set_edgecolor(GREY)
    path = save(figure, results.reports / "figures/figure_3_8.png", dpi=80)
    worst = ", ".join(f"{100 * field.max():.2g} %" for field in fields[0])
    return Figure(
        "Figure 3.8: levels of detail, and where they are wrong",
        f"{name}: the original with its points, {len(targets)} levels with the points of {label(method)} kept, and the "
        "original coloured by its distance to each level, above with points kept and below by plain QEM.",
        f"{name}. Colours: distance from each place of the original to the simplified surface, blue none, green small, "
        f"yellow medium, red large (from the {100 * TOP:.0f} % quantile of all). Largest with points kept: {worst} of "
        "the diagonal, most faces first.",
        [path],
    )


def _shown(results):
    """(object, method): the first figure object with levels of one of the methods and of plain QEM."""
    names = results.choose(results.settings.figure_objects, len(results.objects), stage="lod")
    for method in METHODS:
        for name in names:
            folder = results.folder("lod") / name
            if list(folder.glob(f"{method}_*.npz")) and list(folder.glob(f"{PLAIN}_*.npz")):
                return name, method
    raise NotRun(f"no levels of detail of {' or '.join(METHODS)} beside plain QEM", "lod", runnable=False)


def _error(mesh, level):
    """(n,) distance of the original's vertices to the simplified surface, as a share of the original's diagonal."""
    return vertex_errors(level, mesh) / mesh.diagonal


def _coloured(axes, mesh, values):
    """The mesh in colours of values (n,) in 0..1, under the head light."""
    colours = np.rint(255 * COLOURS(np.clip(values, 0, 1))[:, :3]).astype(np.uint8)
    shape = (ROWS * 2, ROWS * 2)
    image = render(Mesh(mesh.vertices, mesh.faces, colours), VIEWPOINT, shape, "raycast", background="white").rgb
    image = image.reshape(ROWS, 2, ROWS, 2, 3).mean(axis=(1, 3)) / 255
    axes.imshow(squared(image)[0])
    axes.set_axis_off()


def _titled(axes, words):
    axes.set_title(words, fontsize=9.5, fontweight="normal", loc="center")

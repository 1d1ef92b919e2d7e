"""T figure 3.8: an object, its points, levels of detail, and where each level is wrong."""

from itertools import product

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize

from stages.kit import Mesh
from stages.lod.metro import vertex_errors
from stages.report.drawing import VIEWPOINT, show, square_grid, squared
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import GREY, label
from stages.views import render

from .methods import ENHANCED, OURS, PLAIN, short
from .rows import size

METHODS = ("VisAttCurvSymCon", ENHANCED, OURS)  # the thesis's, or the next that was run
LEVELS = 3
# T figure 3.8 and CloudCompare: blue perfect, then green, yellow, red.
COLOURS = LinearSegmentedColormap.from_list("error", ["#2c4fd8", "#35b46a", "#f2d530", "#d7261e"])
TOP = 0.98  # quantile of all errors shown that is red
ROWS = 330
TITLE = {"fontsize": 9.5, "fontweight": "normal", "loc": "center"}


def build(results: Results) -> Figure:
    """The original with its points, levels that keep them, and the original coloured by its distance to each level."""
    name, method = _shown(results)
    mesh, points = results.mesh(name), results.strong_points(name)[method]
    kept, plain = (dict(results.lods(name, way)) for way in (method, PLAIN))
    targets = sorted(set(kept) & set(plain), key=size)[-LEVELS:]
    fields = [[errors(mesh, level[target]) for target in targets] for level in (kept, plain)]
    top = float(np.quantile(np.concatenate(sum(fields, [])), TOP)) or 1.0
    drawing, grid = square_grid(3, len(targets) + 1, side=1.9, right=0.9, gap=0.25)
    show(grid[0, 0], mesh, points=points, rows=ROWS)
    grid[0, 0].set_title(f"original: {len(mesh.faces):,} faces, {len(points)} points", **TITLE)
    for axes, target in zip(grid[0, 1:], targets, strict=True):
        show(axes, kept[target], wires=True, rows=ROWS)
        axes.set_title(f"{len(kept[target].faces):,} faces", **TITLE)
    for row, field, way in zip(grid[1:], fields, (f"{short(method)} kept", label(PLAIN)), strict=True):
        row[0].text(0.95, 0.5, f"error,\n{way}", ha="right", va="center", transform=row[0].transAxes)
        row[0].set_axis_off()
        for axes, values in zip(row[1:], field, strict=True):
            _show_coloured(axes, mesh, values / top)
    scale = ScalarMappable(Normalize(0, 100 * top), COLOURS)
    bar = drawing.colorbar(scale, cax=drawing.add_axes((0.93, 0.1, 0.012, 0.5)), extend="max")
    bar.set_label("distance, % of the diagonal")
    bar.outline.set_edgecolor(GREY)
    worst = ", ".join(f"{100 * field.max():.2g} %" for field in fields[0])
    words = {"name": name, "levels": len(targets), "method": label(method), "top": f"{100 * TOP:.0f} %", "worst": worst}
    return Figure(drawing, words, dpi=80)


def _shown(results: Results) -> tuple[str, str]:
    """(object, method): the first figure object with levels of one of the methods and of plain QEM."""
    names = results.choose(results.settings.figure_objects, len(results.objects), stage="lod")
    for method, name in product(METHODS, names):
        folder = results.folder("lod") / name
        if all(any(folder.glob(f"{one}_*.npz")) for one in (method, PLAIN)):
            return name, method
    raise NotRun(f"no levels of detail of {' or '.join(METHODS)} beside plain QEM", "lod", runnable=False)


def errors(mesh: Mesh, level: Mesh) -> np.ndarray:
    """(n,) distance of the original's vertices to the simplified surface, as a share of the original's diagonal."""
    return vertex_errors(level, mesh) / mesh.diagonal


def _show_coloured(axes: Axes, mesh: Mesh, values: np.ndarray) -> None:
    """The mesh in colours of values (n,) in 0..1, under the head light."""
    colours = np.rint(255 * COLOURS(np.clip(values, 0, 1))[:, :3]).astype(np.uint8)
    mesh = Mesh(mesh.vertices, mesh.faces, colours)
    image = render(mesh, VIEWPOINT, (2 * ROWS, 2 * ROWS), "raycast", background="white").rgb
    axes.imshow(squared(image.reshape(ROWS, 2, ROWS, 2, 3).mean(axis=(1, 3)) / 255)[0])
    axes.set_axis_off()

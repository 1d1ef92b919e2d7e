"""T figure 3.30: where a network looks on one object in each of its tasks."""

import cv2
import numpy as np

from stages.fixation import fuse, sphere
from stages.fixation.cam import to_size
from stages.networks.grid import GRIDS
from stages.report.drawing import colour_bar, colour_map, picture, square_grid, squared
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import label, save
from stages.report.tables._fixation import CHOSEN, TASKS, spoken_network, stored, stored_networks, stored_tasks

VIEWS = sphere(1, 3)[:3]  # the three views whose maps are stored, whatever the settings
ROWS = 420  # pixels a side of a picture
VEIL = 0.72  # of a map's colour over the picture


def build(results):
    name = results.choose(results.settings.figure_objects, 1, "fixation")[0]
    arrays, mesh, tasks = stored(results, name), results.mesh(name), stored_tasks(results)
    methods = stored_networks(arrays)
    if not methods:
        raise NotRun(f"no network looked at {name}", "fixation", runnable=False)
    view = int((arrays["visible"] @ mesh.vertex_areas).argmax())  # what shows most of the object
    shown = [task for task in TASKS if task in tasks]
    render = picture(mesh, viewpoint=VIEWS[view], rows=ROWS)
    figure, grid = square_grid(len(methods), len(shown) + 1, side=1.6, right=0.9)
    for row, method in zip(grid, methods, strict=True):
        cams = large(arrays[f"{method}.maps"][view], method.rpartition("-")[0])
        maps = dict(zip(tasks, cams, strict=True))
        maps["together"] = together(maps)
        for axes, task in zip(row, [*shown, "together"], strict=True):
            axes.imshow(veiled(render, maps[task]))
            axes.set_axis_off()
        row[0].text(-0.05, 0.5, spoken_network(method).replace(", ", "\n"), rotation=90, va="center", ha="right",
                    fontsize=8.5, transform=row[0].transAxes)  # fmt: skip
    for axes, task in zip(grid[0], [*shown, "fused (EWIGC)"], strict=True):
        axes.set_title(label(task), fontsize=9.5, fontweight="normal", loc="center")
    colour_bar(figure, [0.945, 0.15, 0.012, 0.7], "Grad-CAM over its maximum")
    return Figure(
        "Figure 3.30: where networks look, task by task",
        f"A view of {name} under the Grad-CAM maps of {', '.join(map(label, shown))} and their fusion, a row each for "
        f"{'; '.join(map(spoken_network, methods))}; dark is low, yellow high.",
        f"Maps of {sizes(arrays, methods)} pixels, over the whole picture like the thesis's: what lies beside the "
        "object is lost when they are put on the surface. All dark: nothing speaks for the class. Level 1: living or "
        "not; level 2: category; level 3: the object itself. Fused: curvature, eccentricity, levels 1 and 2.",
        [save(figure, results.reports / "figures/figure_3_30.png")],
    )


def sizes(arrays, methods):
    """The sizes of the networks' maps in words: `7 x 7 or 14 x 14`."""
    shapes = {arrays[f"{method}.maps"].shape[2:] for method in methods}
    return " or ".join(f"{rows} x {columns}" for rows, columns in sorted(shapes))


def large(cams, network):
    """(t, ROWS, ROWS) f4: Grad-CAM maps (t, i, j) of a network as it sees them, each over its maximum or zero."""
    seen = to_size(cams, GRIDS[network][0] * cams.shape[1], network)
    return np.stack([cv2.resize(cam, (ROWS, ROWS), interpolation=cv2.INTER_LINEAR) for cam in seen])


def together(maps):
    """(h, w): EWIGC of the tasks' maps, over its maximum like them; zero where no task that is fused has a map."""
    parts = [maps[task] for task in CHOSEN if task in maps]
    fused = fuse(np.stack(parts)) if parts else np.zeros((ROWS, ROWS))
    return fused / (fused.max() or 1)


def veiled(render, values):
    """The part of a picture (h, w, 3) that holds the object, under the colours of a map (h, w) in 0..1."""
    part, (top, left) = squared(render, margin=14)
    window = values[top : top + part.shape[0], left : left + part.shape[1]]
    colours = colour_map(window.ravel()).reshape(*window.shape, 3)
    return VEIL * colours + (1 - VEIL) * part

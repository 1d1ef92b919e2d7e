"""T figures 3.29, 3.30 and 3.34: where networks look, on this run's objects and on meshes with human gaze."""

from collections.abc import Callable

import cv2
import numpy as np

from stages.fixation import fuse
from stages.fixation.cam import resize_cams
from stages.kit.files import read_json, write_json
from stages.networks.grid import GRIDS
from stages.report.drawing import colour_bar, colour_map, picture, show, square_grid, squared, vivid
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import label, save

from .rows import (
    CHOSEN,
    MODELS,
    NARROWED,
    TASKS,
    VIEWPOINTS,
    network_text,
    stored,
    stored_networks,
    stored_tasks,
    untrained,
)  # fmt: skip

ITSELF = "level_3"
ROWS = 420  # pixels a side of a picture; of the small ones of figure 3.34:
SMALL = 260
VEIL = 0.72  # of a map's colour over the picture
RIVALS = ("enhanced", "mesh_saliency")  # of stages.salient_points
COUNT = 4  # objects of figure 3.34
Build = Callable[[Results, str | None], Figure]


def on_gaze(build: Build, name: str) -> Callable[[Results], Figure]:
    """A build(results) of the figure on the meshes with human gaze; without their data, as it was drawn last time."""

    def kept(results: Results) -> Figure:
        path = results.reports / "figures" / f"{name}.png"
        words = path.with_suffix(".json")
        if (results.data / "gaze/fixation").is_dir():
            figure = build(results, "gaze")
            said = {"title": f"{figure.title}, on meshes with human gaze", "alt": figure.alt, "caption": figure.caption}
            write_json(words, said)
        elif not path.exists() or not words.exists():
            why = f"no figures/{path.name}: run the stage fixation where the data set gaze is"
            raise NotRun(why, "fixation", runnable=False)
        return Figure(**read_json(words), paths=[path, words])

    return kept


def path_of(results: Results, number: str, dataset: str | None):
    """The picture of a figure, on a set."""
    return results.reports / "figures" / f"figure_{number}{f'_{dataset}' if dataset else ''}.png"


def figure_3_29(results: Results, dataset: str | None = None) -> Figure:
    """Where a network looks for the object itself, from three sides."""
    name = ready(results, dataset)[0]
    arrays, mesh, tasks = stored(results, name, dataset), results.mesh(name, dataset), stored_tasks(results, dataset)
    methods = [method for method in stored_networks(arrays) if not untrained(method)]
    if not methods or ITSELF not in tasks:
        raise NotRun(f"no network named {name} itself", "fixation", runnable=False)
    renders = [picture(mesh, viewpoint=viewpoint, rows=ROWS) for viewpoint in VIEWPOINTS]
    figure, grid = square_grid(len(methods), len(VIEWPOINTS), side=1.9, right=0.9)
    for row, method in zip(grid, methods, strict=True):
        for axes, render, cams in zip(row, renders, arrays[f"{method}.maps"], strict=True):
            axes.imshow(veiled(render, large(cams, method.rpartition("-")[0])[tasks.index(ITSELF)]))
        _name(row, network_text(method).replace(", ", "\n"))
    colour_bar(figure, [0.93, 0.15, 0.014, 0.7], "over its maximum")
    return Figure(
        "Figure 3.29: where networks look from three sides",
        f"Three views of {name} under the Grad-CAM maps of {label(ITSELF)}, the object itself, a row each for "
        f"{'; '.join(map(network_text, methods))}; dark is low, yellow high.",
        f"Maps of {sizes(arrays, methods)} pixels of the task of {label(ITSELF)}: to name the object itself among all. "
        "Untrained networks are left out.",
        [save(figure, path_of(results, "3_29", dataset))],
    )


def figure_3_30(results: Results, dataset: str | None = None) -> Figure:
    """Where a network looks on one object in each of its tasks."""
    name = ready(results, dataset)[0]
    arrays, mesh, tasks = stored(results, name, dataset), results.mesh(name, dataset), stored_tasks(results, dataset)
    methods = stored_networks(arrays)
    if not methods:
        raise NotRun(f"no network looked at {name}", "fixation", runnable=False)
    view = int((arrays["visible"] @ mesh.vertex_areas).argmax())  # what shows most of the object
    shown = [task for task in TASKS if task in tasks]
    render = picture(mesh, viewpoint=VIEWPOINTS[view], rows=ROWS)
    figure, grid = square_grid(len(methods), len(shown) + 1, side=1.6, right=0.9)
    for row, method in zip(grid, methods, strict=True):
        maps = dict(zip(tasks, large(arrays[f"{method}.maps"][view], method.rpartition("-")[0]), strict=True))
        for axes, values in zip(row, [*(maps[task] for task in shown), together(maps)], strict=True):
            axes.imshow(veiled(render, values))
        _name(row, network_text(method).replace(", ", "\n"))
    _titles(grid, [*map(label, shown), "fused (EWIGC)"], 9.5)
    colour_bar(figure, [0.945, 0.15, 0.012, 0.7], "Grad-CAM over its maximum")
    return Figure(
        "Figure 3.30: where networks look, task by task",
        f"A view of {name} under the Grad-CAM maps of {', '.join(map(label, shown))} and their fusion, a row each for "
        f"{'; '.join(map(network_text, methods))}; dark is low, yellow high.",
        f"Maps of {sizes(arrays, methods)} pixels, over the whole picture like the thesis's: what lies beside the "
        "object is lost when they are put on the surface. All dark: nothing speaks for the class. Level 1: living or "
        "not; level 2: category; level 3: the object itself. Fused: curvature, eccentricity, levels 1 and 2.",
        [save(figure, path_of(results, "3_30", dataset))],
    )


def figure_3_34(results: Results, dataset: str | None = None) -> Figure:
    """The fused attention of networks on the surface, beside people and other models."""
    names, truth = with_truth(results, dataset)
    files = {name: stored(results, name, dataset) for name in names}
    methods = [each for each in stored_networks(files[names[0]]) if f"{each}.{NARROWED}" in files[names[0]]]
    if not methods:
        raise NotRun(f"no fused maps of {names[0]}", "fixation", runnable=False)
    rivals = results.saliency(names[0], dataset).those_of(RIVALS)
    titles = [truth] if truth else []
    titles += [f"EWIGC_L4\n{network_text(each).replace(', ', chr(10))}" for each in methods] + list(map(label, rivals))
    figure, grid = square_grid(len(names), len(titles), side=1.6, right=0.9)
    for row, name in zip(grid, names, strict=True):
        mesh, saliency = results.mesh(name, dataset), results.saliency(name, dataset)
        values = [results.ground_truth(name, dataset)["density"]] if truth else []
        values += [files[name][f"{method}.{NARROWED}"] for method in methods] + [saliency[rival] for rival in rivals]
        for axes, one in zip(row, values, strict=True):
            show(axes, mesh, vivid(one.astype(float)), rows=SMALL)
        _name(row, name, 10)
    _titles(grid, titles, 9)
    colour_bar(figure, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile")
    said = " Random weights: a control." if any(map(untrained, methods)) else ""
    said += " Marks: by a vision model, no human subjects; spread along the surface." if truth == "marks" else ""
    return Figure(
        "Figure 3.34: fused attention on the surface",
        f"Meshes of {', '.join(names)}, coloured from dark (low) to yellow (high): "
        f"{', '.join(title.replace(chr(10), ' ') for title in titles)}.",
        f"{MODELS[NARROWED]}: the highest of four levels of four tasks' maps, fused (T eq. 3.25), the mean over the "
        f"views that see a vertex. Each map over its own 98 % quantile.{said}",
        [save(figure, path_of(results, "3_34", dataset), dpi=115)],
    )


def ready(results: Results, dataset: str | None) -> list[str]:
    """Names of the objects of a set at which networks looked, the settings' own first."""
    found = sorted(path.stem for path in results.folder("fixation", dataset).glob("*.npz"))
    if not found:
        raise NotRun("no objects in fixation", "fixation")
    first = [name for name in results.settings.figure_objects if name in found]
    return [*first, *(name for name in found if name not in first)]


def with_truth(results: Results, dataset: str | None) -> tuple[list[str], str | None]:
    """(names, what their truth is called): those with people's attention first; without any, None."""
    names = ready(results, dataset)
    try:
        folder = results.folder("weights", dataset) / "ground_truth"
        of = results.rows("fixation", dataset)["dataset"].iloc[0]
    except NotRun:
        return names[:COUNT], None
    marked = [name for name in names if (folder / f"{name}.npz").exists()]
    return (marked[:COUNT], "human gaze" if of == "gaze" else "marks") if marked else (names[:COUNT], None)


def sizes(arrays: dict[str, np.ndarray], methods: list[str]) -> str:
    """The sizes of the networks' maps in words: `7 x 7 or 14 x 14`."""
    shapes = {arrays[f"{method}.maps"].shape[2:] for method in methods}
    return " or ".join(f"{rows} x {columns}" for rows, columns in sorted(shapes))


def large(cams: np.ndarray, network: str) -> np.ndarray:
    """(t, ROWS, ROWS) f4: Grad-CAM maps (t, i, j) of a network as it sees them, each over its maximum or zero."""
    seen = resize_cams(cams, GRIDS[network][0] * cams.shape[1], network)
    return np.stack([cv2.resize(cam, (ROWS, ROWS), interpolation=cv2.INTER_LINEAR) for cam in seen])


def together(maps: dict[str, np.ndarray]) -> np.ndarray:
    """(h, w): EWIGC of the tasks' maps, over its maximum like them; zero where no task that is fused has a map."""
    parts = [maps[task] for task in CHOSEN if task in maps]
    fused = fuse(np.stack(parts)) if parts else np.zeros((ROWS, ROWS))
    return fused / (fused.max() or 1)


def veiled(render: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The part of a picture (h, w, 3) that holds the object, under the colours of a map (h, w) in 0..1."""
    part, (top, left) = squared(render, margin=14)
    window = values[top : top + part.shape[0], left : left + part.shape[1]]
    return VEIL * colour_map(window.ravel()).reshape(*window.shape, 3) + (1 - VEIL) * part


def _name(row, text, size=8.5):
    row[0].text(-0.05, 0.5, text, rotation=90, va="center", ha="right", fontsize=size, transform=row[0].transAxes)
    for axes in row:
        axes.set_axis_off()


def _titles(grid, titles, size):
    for axes, title in zip(grid[0], titles, strict=True):
        axes.set_title(title, fontsize=size, fontweight="normal", loc="center")

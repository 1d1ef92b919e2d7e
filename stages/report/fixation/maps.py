"""T figures 3.29, 3.30 and 3.34: where networks look, on this run's objects and on meshes with human gaze."""

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from matplotlib.figure import Figure as Drawing

from stages.fixation import fuse
from stages.fixation.cam import resize_cams
from stages.fixation.tasks import FUSED_TASKS
from stages.kit import Mesh
from stages.kit.files import read_json, write_json
from stages.networks.grid import GRIDS
from stages.report.drawing import colour_bar, colour_map, picture, square_grid, squared, vivid
from stages.report.items import Figure
from stages.report.prose import add_words
from stages.report.results import NotRun, Results
from stages.report.style import label

from .detectors import MODELS, NARROWED, TASKS, network_text, untrained
from .rows import VIEWPOINTS, stored, stored_networks

ITSELF = "level_3"
ROWS = 420  # pixels a side of a picture; of the small ones of figure 3.34:
SMALL = 260
VEIL = 0.72  # of a map's colour over the picture
RIVALS = ("enhanced", "mesh_saliency")  # of stages.salient_points
COUNT = 4  # objects of figure 3.34
Images = Mapping[str, Sequence[np.ndarray]]


class Kept(Figure):
    """A figure whose words stand beside it in NAME.json, so that both outlast the data; drawing empty: they did."""

    def write(self, folder: Path) -> None:
        """Writes NAME.png and NAME.json, where there is something new."""
        words = folder / f"{self.name}.json"
        if self.drawing.axes:
            super().write(folder)
            write_json(words, {"title": self.title, "alt": self.alt, "caption": self.caption})
        self.paths = [words.with_suffix(".png"), words]


def on_gaze(build: Callable[..., Figure], results: Results) -> Kept:
    """The figure on the meshes with human gaze; without their data, as it was drawn last time."""
    name = build.__name__
    if (results.data / "gaze/fixation").is_dir():
        figure = build(results, "gaze")
        add_words(figure, sys.modules[__package__ or ""], "figures", name)
        title = f"{figure.title}, on meshes with human gaze"
        return Kept(figure.drawing, {"title": title, "alt": figure.alt, "caption": figure.caption}, dpi=figure.dpi)
    words = results.reports / f"figures/{name}_gaze.json"
    if not words.exists() or not words.with_suffix(".png").exists():
        why = f"no figures/{name}_gaze.png: run the stage fixation where the data set gaze is"
        raise NotRun(why, "fixation", runnable=False)
    return Kept(Drawing(), read_json(words))


def figure_3_29(results: Results, dataset: str | None = None) -> Figure:
    """Where a network looks for the object itself, from three sides."""
    look = _look(results, dataset)
    maps = {method: views for method, views in look.maps.items() if not untrained(method) and ITSELF in views[0]}
    if not maps:
        raise NotRun(f"no network named {look.name} itself", "fixation", runnable=False)
    renders = [picture(look.mesh, viewpoint=viewpoint, rows=ROWS) for viewpoint in VIEWPOINTS]
    images = {
        network_text(method): [_veiled(render, seen[ITSELF]) for render, seen in zip(renders, views, strict=True)]
        for method, views in maps.items()
    }
    figure = _panels(images, 1.9, [0.93, 0.15, 0.014, 0.7], "over its maximum")
    words = {"name": look.name, "task": label(ITSELF), "networks": "; ".join(images), "sizes": look.sizes}
    return Figure(figure, words)


def figure_3_30(results: Results, dataset: str | None = None) -> Figure:
    """Where a network looks on one object in each of its tasks."""
    look = _look(results, dataset)
    if not look.maps:
        raise NotRun(f"no network looked at {look.name}", "fixation", runnable=False)
    view = int((look.visible @ look.mesh.vertex_areas).argmax())  # what shows most of the object
    render = picture(look.mesh, viewpoint=VIEWPOINTS[view], rows=ROWS)
    images = {}
    for method, views in look.maps.items():
        layers = {label(task): views[view][task] for task in TASKS if task in views[view]}
        layers["fused (EWIGC)"] = _fused(views[view])
        images[network_text(method)] = [_veiled(render, layer) for layer in layers.values()]
    figure = _panels(images, 1.6, [0.945, 0.15, 0.012, 0.7], "Grad-CAM over its maximum", list(layers))
    words = {"name": look.name, "tasks": ", ".join(list(layers)[:-1]), "networks": "; ".join(images)}
    return Figure(figure, words | {"sizes": look.sizes})


def figure_3_34(results: Results, dataset: str | None = None) -> Figure:
    """The fused attention of networks on the surface, beside people and other models."""
    names, marked = _ready(results, dataset), {}
    for name in names:
        with suppress(NotRun):
            marked[name] = results.ground_truth(name, dataset)["density"]
    names = list(marked or names)[:COUNT]
    files = {name: stored(results, name, dataset) for name in names}
    methods = [each for each in stored_networks(files[names[0]]) if f"{each}.{NARROWED}" in files[names[0]]]
    if not methods:
        raise NotRun(f"no fused maps of {names[0]}", "fixation", runnable=False)
    rivals, images = results.saliency(names[0], dataset).those_of(RIVALS), {}
    for name in names:
        mesh, saliency = results.mesh(name, dataset), results.saliency(name, dataset)
        values = [marked[name]] if marked else []
        values += [files[name][f"{method}.{NARROWED}"] for method in methods] + [saliency[rival] for rival in rivals]
        pictures = (picture(mesh, vivid(one.astype(float)), rows=SMALL) for one in values)
        images[name] = [squared(image)[0] for image in pictures]
    truth = "human gaze" if results.folder("fixation", dataset).parent.name == "gaze" else "marks"
    titles = [truth] if marked else []
    titles += [f"{MODELS[NARROWED]}\n{network_text(each)}" for each in methods] + list(map(label, rivals))
    figure = _panels(images, 1.6, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile", titles, (10, 9))
    words = {
        "names": ", ".join(names),
        "columns": ", ".join(title.replace("\n", " ").replace(", ", " ") for title in titles),
        "control": " Random weights: a control." if any(map(untrained, methods)) else "",
        "marks": " Marks: by a vision model, no human subjects; spread along the surface." if "marks" in titles else "",
    }
    return Figure(figure, words, dpi=115)


class Look(NamedTuple):
    """What networks saw of one object."""

    name: str
    mesh: Mesh
    visible: np.ndarray  # (3, n): the vertices that each view sees
    maps: dict[str, list[dict[str, np.ndarray]]]  # {method: for each view {task: (ROWS, ROWS) map}}
    sizes: str  # of the maps as the networks gave them: `7 x 7 or 14 x 14`


def _look(results: Results, dataset: str | None) -> Look:
    """At the first object of a set."""
    name = _ready(results, dataset)[0]
    arrays, tasks = stored(results, name, dataset), results.rows("fixation", dataset, metric="class")["task"].unique()
    cams = {method: arrays[f"{method}.maps"] for method in stored_networks(arrays)}
    maps = {name: [dict(zip(tasks, large(view, name), strict=True)) for view in own] for name, own in cams.items()}
    sizes = " or ".join(f"{rows} x {columns}" for rows, columns in sorted({own.shape[2:] for own in cams.values()}))
    return Look(name, results.mesh(name, dataset), arrays["visible"], maps, sizes)


def _ready(results: Results, dataset: str | None) -> list[str]:
    """Names of the objects of a set at which networks looked, the settings' own first."""
    found = sorted(path.stem for path in results.folder("fixation", dataset).glob("*.npz"))
    if not found:
        raise NotRun("no objects in fixation", "fixation")
    first = [name for name in results.settings.figure_objects if name in found]
    return list(dict.fromkeys([*first, *found]))


def large(cams: np.ndarray, method: str) -> np.ndarray:
    """(t, ROWS, ROWS) f4: Grad-CAM maps (t, i, j) of a network as it sees them, each over its maximum or zero."""
    network = method.rpartition("-")[0]
    seen = resize_cams(cams, GRIDS[network][0] * cams.shape[1], network)
    return np.stack([cv2.resize(cam, (ROWS, ROWS), interpolation=cv2.INTER_LINEAR) for cam in seen])


def _fused(maps: Mapping[str, np.ndarray]) -> np.ndarray:
    """(h, w): EWIGC of the tasks' maps, over its maximum like them; zero where no task that is fused has a map."""
    parts = [maps[task] for task in FUSED_TASKS if task in maps]
    fused = fuse(np.stack(parts)) if parts else np.zeros((ROWS, ROWS))
    return fused / (fused.max() or 1)


def _veiled(render: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The part of a picture (h, w, 3) that holds the object, under the colours of a map (h, w) in 0..1."""
    part, (top, left) = squared(render, margin=14)
    window = values[top : top + part.shape[0], left : left + part.shape[1]]
    return VEIL * colour_map(window.ravel()).reshape(*window.shape, 3) + (1 - VEIL) * part


def _panels(
    images: Images, side: float, box: list[float], scale: str, titles: Sequence[str] = (), letters: tuple = (8.5, 9.5)
) -> Drawing:
    """A row of images by name, with titles above; letters: of names and of titles; box: of the bar of colours."""
    figure, grid = square_grid(len(images), len(next(iter(images.values()))), side=side, right=0.9)
    for axes, (name, row) in zip(grid, images.items(), strict=True):
        axes[0].text(-0.05, 0.5, name.replace(", ", "\n"), rotation=90, va="center", ha="right", fontsize=letters[0],
                     transform=axes[0].transAxes)  # fmt: skip
        for one, image in zip(axes, row, strict=True):
            one.imshow(image)
            one.set_axis_off()
    for axes, title in zip(grid[0], titles, strict=False):
        axes.set_title(title.replace(", ", "\n"), fontsize=letters[1], fontweight="normal", loc="center")
    colour_bar(figure, box, scale)
    return figure

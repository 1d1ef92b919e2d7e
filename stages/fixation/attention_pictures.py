"""T figures 3.29, 3.30 and 3.34: where networks look, on this run's objects and on meshes with human gaze."""

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import chain

import cv2
import numpy as np
from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import object_files, read_arrays
from haptic_glance.deep.resize import GRIDS, resize_cams
from haptic_glance.mesh.mesh import Mesh
from stages.charts.drawing import colour_bar, colour_map, label, name_panels, picture, square_grid, squared, vivid
from stages.charts.items import Figure, Kept, add_words, last_drawn
from stages.charts.results import NotRun, Results, require_rows
from stages.fixation.agreement_rows import (
    LEE,
    NARROWED,
    OURS,
    RIVALS,
    TASKS,
    VIEWPOINTS,
    network_text,
    stored,
    task_text,
)
from stages.fixation.fusion import fuse
from stages.fixation.places import ITSELF
from stages.fixation.tasks import FUSED_TASKS
from stages.salient_points.measure import read_saliency

ROWS, SMALL = 420, 260  # pixels a side of a picture; of the small ones of figure 3.34
MOST_TAUGHT = ("last_block", "finetuned", "frozen")  # modes of networks that learned, the thesis's first
VEIL = 0.72  # of a map's colour over the picture
Images = Mapping[str, Sequence[np.ndarray]]
Views = dict[str, list[dict[str, np.ndarray]]]


def on_gaze(build: Callable[..., Figure], results: Results) -> Kept:
    """The figure on the meshes with human gaze; without their data, as it was drawn last time."""
    name = build.__name__
    if (results.data / "gaze/fixation").is_dir():
        figure = build(results, "gaze")
        add_words(figure, sys.modules[__package__ or ""], "figures", name)
        title = f"{figure.title}, on meshes with human gaze"
        return Kept(figure.drawing, {"title": title, "alt": figure.alt, "caption": figure.caption}, dpi=figure.dpi)
    results.read.add("gaze")
    return last_drawn(results, f"{name}_gaze", "fixation")


def figure_3_29(results: Results, dataset: str | None = None) -> Figure:
    """Draws where a network looks for the object itself, from three sides."""
    mesh, _, maps, name = _look(results, dataset)
    by_method = {method: views for method, views in maps.items() if ITSELF in views[0]}
    require_rows(by_method, f"no network named {name} itself", "fixation", runnable=False)
    renders = [picture(mesh, viewpoint=viewpoint, rows=ROWS) for viewpoint in VIEWPOINTS]
    images = {
        network_text(method): [_veiled(render, layers[ITSELF]) for render, layers in zip(renders, views, strict=True)]
        for method, views in by_method.items()
    }
    figure = _panels(images, 1.9, [0.93, 0.15, 0.014, 0.7], "over its maximum")
    return Figure(figure)


def figure_3_30(results: Results, dataset: str | None = None) -> Figure:
    """Draws where a network looks on one object in each of its tasks."""
    mesh, visible, maps, name = _look(results, dataset)
    require_rows(maps, f"no network looked at {name}", "fixation", runnable=False)
    view = int((visible @ mesh.vertex_areas).argmax())  # what shows most of the object
    render = picture(mesh, viewpoint=VIEWPOINTS[view], rows=ROWS)
    images, layers = {}, {}
    for method, views in maps.items():
        layers = {label(task): views[view][task] for task in TASKS if task in views[view]}
        layers["fused (EWIGC)"] = _fused(views[view])
        images[network_text(method)] = [_veiled(render, layer) for layer in layers.values()]
    figure = _panels(images, 1.6, [0.945, 0.15, 0.012, 0.7], "Grad-CAM over its maximum", list(layers))
    return Figure(figure, dpi=95)


def figure_3_34(results: Results, dataset: str | None = None) -> Figure:
    """The fused attention of networks on the surface, beside people and other models."""
    names, marked = _ready(results, dataset), {}
    for name in names:
        with suppress(NotRun):
            marked[name] = read_arrays(results.file("weights", f"ground_truth/{name}.npz", dataset))["density"]
    names = list(marked or names)[:4]
    files = {name: stored(results, name, dataset) for name in names}
    methods = _networks(files[names[0]], NARROWED)
    require_rows(methods, f"no fused maps of {names[0]}", "fixation", runnable=False)
    truth = "human gaze" if results.folder("fixation", dataset).parent.name == "gaze" else "marks"
    models = (LEE.task, *RIVALS.values(), OURS.task)
    rivals, images, columns = (
        results.by_method("salient_points", read_saliency, names[0], dataset).those_of(models),
        {},
        {},
    )
    for name, arrays in files.items():
        mesh, saliency = results.mesh(name, dataset), results.by_method("salient_points", read_saliency, name, dataset)
        columns = {truth: marked[name]} if marked else {}
        columns |= {
            f"{task_text(NARROWED)}\n{network_text(method)}": arrays[f"{method}.{NARROWED}"] for method in methods
        }
        columns |= {label(rival): saliency[rival] for rival in rivals}
        pictures = (picture(mesh, vivid(values.astype(float)), rows=SMALL) for values in columns.values())
        images[name] = [squared(image)[0] for image in pictures]
    figure = _panels(images, 1.6, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile", list(columns), (9, 10))
    return Figure(figure, dpi=115)


def _look(results: Results, dataset: str | None) -> tuple[Mesh, np.ndarray, Views, str]:
    """(mesh, visible (3, n), {method: for each view {task: (ROWS, ROWS) map}}, name) of the first object of a set.

    visible: the vertices that each view sees.
    """
    name = _ready(results, dataset)[0]
    arrays, tasks = stored(results, name, dataset), results.rows("fixation", dataset, metric="class")["task"].unique()
    cams = {method: arrays[f"{method}.maps"] for method in _networks(arrays, "maps")}
    maps = {key: [dict(zip(tasks, large(view, key), strict=True)) for view in views] for key, views in cams.items()}
    return results.mesh(name, dataset), arrays["visible"], maps, name


def _ready(results: Results, dataset: str | None) -> list[str]:
    """Names of the objects of a set at which networks looked, the settings' own first."""
    names = object_files(results.folder("fixation", dataset))
    require_rows(names, "no objects in fixation", "fixation")
    return sorted(names, key=lambda name: [*results.settings.figure_objects, name].index(name))


def _networks(arrays: dict[str, np.ndarray], suffix: str) -> list[str]:
    """The networks with METHOD.suffix in a file, each in its most taught form; no controls."""
    networks = dict.fromkeys(key.rpartition("-")[0] for key in arrays if key.endswith(f".{suffix}"))
    groups = ([f"{base}-{mode}" for mode in MOST_TAUGHT if f"{base}-{mode}.{suffix}" in arrays] for base in networks)
    return [methods[0] for methods in groups if methods]


def large(cams: np.ndarray, method: str) -> np.ndarray:
    """(t, ROWS, ROWS) f4: Grad-CAM maps (t, i, j) of a network as it sees them, each over its maximum or zero."""
    network = method.rpartition("-")[0]
    resized = resize_cams(cams, GRIDS[network][0] * cams.shape[1], network)
    return np.stack([cv2.resize(cam, (ROWS, ROWS), interpolation=cv2.INTER_LINEAR) for cam in resized])


def _fused(maps: Mapping[str, np.ndarray]) -> np.ndarray:
    """(h, w): EWIGC of the tasks' maps, over its maximum like them; zero where no task that is fused has a map."""
    parts = [maps[task] for task in FUSED_TASKS if task in maps]
    fused = fuse(np.stack(parts)) if parts else np.zeros((ROWS, ROWS))
    return fused / (fused.max() or 1)


def _veiled(render: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The part of a picture (h, w, 3) that holds the object, under the colours of a map (h, w) in 0..1."""
    part, (top, left) = squared(render, margin=14)
    window = values[top : top + part.shape[0], left : left + part.shape[1]]
    return VEIL * colour_map(window) + (1 - VEIL) * part


def _panels(
    images: Images, side: float, box: list[float], scale: str, titles: Sequence[str] = (), letters: tuple = (9.5, 8.5)
) -> Drawing:
    """A row of images by name, with titles above; letters: of titles and of names; box: of the bar of colours."""
    figure, grid = square_grid(len(images), len(next(iter(images.values()))), side=side, right=0.9)
    above, beside = ([name.replace(", ", "\n") for name in names] for names in (titles, images))
    name_panels(grid, above, beside, letters, away=0.05)
    for axes, image in zip(grid.flat, chain.from_iterable(images.values()), strict=True):
        axes.imshow(image)
        axes.set_axis_off()
    colour_bar(figure, box, scale)
    return figure

"""Pictures of touch: the whole pipeline, the imprints at each method's points, and those of one mesh."""

from itertools import zip_longest

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.touch import Surface, distances, normalise, sensor_axes, sensor_normals, touchable
from haptic_glance.touch.pictures import draw
from stages.report.drawing import GREY, INK, PALE, label, plt, show, vivid
from stages.report.items import Figure
from stages.report.results import OWN_FOLDER, NotRun, Results

from .rows import MODEL, STAGE
from .touches import draw_bars, table_4_1, table_4_2

STEPS = ["1  See it", "2  Find what stands out", "3  Spend the faces there", "4  Touch it there", "5  Know what it is"]
NEEDED = ["random", MODEL]  # bars
LEFT = [0.0, 0.2, 0.41, 0.63, 0.84]  # of the panels, as parts of the figure's width
WIDTH, SIDE, SIZE = 0.17, 3, (16, 3.9)  # of a panel; imprints a side; of the figure in inches
METHODS = ("random", MODEL)
COUNT, TOUCHES = 4, 6
CELLS, PITCH = (16, 16), 0.01  # as the command has them by default


def pipeline(results: Results) -> Figure:
    """The whole pipeline on one object, for the README."""
    if results.own_meshes:
        raise NotRun("the whole pipeline is shown on a published object", OWN_FOLDER, runnable=False)
    name = results.choose([results.settings.hero_object], 1, stage="imprints")[0]
    mesh, (_, coarse) = results.mesh(name), results.lods(name, f"{MODEL}-soft")[-1]
    accuracy, classes = _accuracy(results)
    points = results.strong_points(name)[MODEL]
    figure = plt.figure(figsize=SIZE)
    becomes = f"{len(mesh.faces):,} faces become {len(coarse.faces):,}"
    below = (name, "saliency, and where to touch", becomes, "what a pressure array feels (black: first)", "")
    for left, step, caption in zip(LEFT, STEPS, below, strict=True):
        figure.text(left, 0.92, step, fontsize=13, fontweight="bold", color=INK)
        figure.text(left, 0.03, caption, fontsize=10, color=GREY)
    panels = [figure.add_axes((left, 0.12, WIDTH, WIDTH * SIZE[0] / SIZE[1])) for left in LEFT]
    show(panels[0], mesh, rows=800)
    show(panels[1], mesh, vivid(results.saliency(name)[MODEL]), points=points, rows=800)
    show(panels[2], coarse, wires=True, rows=800)
    panels[3].set_axis_off()
    for (down, across), image in zip(np.ndindex(SIDE, SIDE), results.imprints(name)[MODEL], strict=False):
        _draw_imprint(panels[3].inset_axes((across / SIDE, 1 - (down + 1) / SIDE, 0.94 / SIDE, 0.94 / SIDE)), image)
    places = draw_bars(panels[4], accuracy, ["knn"], chance=1 / classes)
    names = [label(method).partition(" (")[0].replace(" ", "\n") for method in places]
    panels[4].set_xticks(list(places.values()), names, fontsize=9)
    panels[4].set_title(f"kNN, one touch, {classes} objects", fontsize=9.5, fontweight="normal", color=GREY, pad=4)
    return Figure(figure, {"name": name, "classes": classes}, dpi=120)


def _accuracy(results: Results) -> tuple[pd.DataFrame, int]:
    """(tidy table, number of objects): of the group six, or of four where there is no six."""
    try:
        name, frame = "six", table_4_1(results).frame
    except NotRun:
        name, frame = "four", table_4_2(results).frame
    for method in NEEDED:  # a picture of only some of them would mislead
        results.measured(STAGE, group=name, classifier="knn", variant="plain", method=method, split="random")
    return frame[frame["protocol"] == "ours"], results.classes(name)


def imprints(results: Results) -> Figure:
    """Draws the imprints at the points of each method, an object a row."""
    names = results.choose(results.settings.figure_objects, COUNT, stage="imprints")
    methods = results.imprints(names[0]).those_of(METHODS)
    width = len(methods) * TOUCHES
    figure, grid = plt.subplots(len(names), width, figsize=(0.82 * width + 0.6, 0.92 * len(names) + 0.3), squeeze=False)
    figure.subplots_adjust(wspace=0.06, hspace=0.06)
    for k, (method, block) in enumerate(zip(methods, np.split(grid, len(methods), axis=1), strict=True)):
        for row, name in zip(block, names, strict=True):
            for axes, image in zip_longest(row, results.imprints(name)[method][:TOUCHES]):
                _draw_imprint(axes, image)
                axes.set_position(axes.get_position().translated(0.012 * (k > 0), 0))
        block[0, 0].set_title(f"{label(method)}, first {TOUCHES} points", pad=6)
    for axes, name in zip(grid[:, 0], names, strict=True):
        axes.set_ylabel(name, rotation=0, ha="right", va="center", labelpad=8)
    rows, columns = results.imprints(names[0])[methods[0]].shape[1:]
    words = {"names": ", ".join(names), "methods": " beside ".join(map(label, methods))}
    return Figure(figure, words | {"rows": rows, "columns": columns})


def _draw_imprint(axes: Axes, image: np.ndarray | None) -> None:
    """An imprint (rows, columns) in 0..1 in grey, framed; None: an empty frame."""
    if image is not None:
        axes.imshow(image, cmap="gray", vmin=0, vmax=1)
    axes.set(xticks=[], yticks=[])
    axes.spines[:].set(visible=True, color=PALE, linewidth=0.6)


def touch_one_mesh(results: Results) -> Figure:
    """Draws the output of `haptic-glance touch MESH`: of one object, or of each object of a folder of one's own."""
    own_meshes, settings = results.own_meshes, results.settings
    names = results.choose(() if own_meshes else [settings.hero_object], settings.viewer_count if own_meshes else 1)
    figure = plt.figure(figsize=(12, 5.4 * len(names)))
    most_points = 0
    for part, name in zip(figure.subfigures(len(names), 1, squeeze=False).flat, names, strict=True):
        mesh, points = results.mesh(name), results.points(name)[MODEL]
        points = points[touchable(mesh, points)][:TOUCHES]
        most_points = max(most_points, len(points))
        raw = distances(Surface(mesh), points, CELLS, PITCH)
        axes = sensor_axes(sensor_normals(mesh, points))
        draw(part, mesh, mesh.vertices[points], axes, normalise(raw, PITCH), np.ptp(raw, axis=(1, 2)), PITCH)
        if own_meshes:
            part.suptitle(name, fontweight="bold", y=0.995)
    title = "Where to touch, and what is felt there" if own_meshes else "Touching one mesh"
    words = {"title": title, "name": ", ".join(names), "count": most_points, "rows": CELLS[0], "columns": CELLS[1]}
    return Figure(figure, words | {"pitch": PITCH}, dpi=110)

"""Pictures of touch: the whole pipeline, the imprints at each method's points, and those of one mesh."""

from itertools import combinations, zip_longest

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.base.files import read_arrays
from haptic_glance.know.features import SIMILARITY_THRESHOLD, similarity
from haptic_glance.touch import Surface, distances, normalise, sensor_axes, sensor_normals, touchable
from haptic_glance.touch.imprint_pictures import draw
from stages.charts.datasets import dataset_text
from stages.charts.drawing import GREY, INK, PALE, colours, label, plt, show, vivid
from stages.charts.items import Figure
from stages.charts.results import OWN_FOLDER, NotRun, Results, require_rows
from stages.charts.tables import CLASSIFIERS
from stages.classification.recognition_tables import EQUAL, MODEL, PRINTED, SSIM, STAGE, added, table_4_1, table_4_2
from stages.imprints.imprints import read_images
from stages.lod.levels import levels_of
from stages.salient_points.measure import read_points, read_saliency, read_strong_points

STEPS = ["1  See it", "2  Find what stands out", "3  Spend the faces there", "4  Touch it there", "5  Know what it is"]
NEEDED = ["random", MODEL]  # bars
DRAWN = ("random", "itti", EQUAL, SSIM, MODEL)  # samplings
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
    mesh, (_, coarse) = results.mesh(name), levels_of(results, name, f"{MODEL}-soft")[-1]
    accuracy, classes = _accuracy(results)
    points = results.by_method("salient_points", read_strong_points, name)[MODEL]
    figure = plt.figure(figsize=SIZE)
    becomes = f"{len(mesh.faces):,} faces become {len(coarse.faces):,}"
    below = (name, "saliency, and where to touch", becomes, "what a pressure array feels (black: first)", "")
    for left, step, caption in zip(LEFT, STEPS, below, strict=True):
        figure.text(left, 0.92, step, fontsize=13, fontweight="bold", color=INK)
        figure.text(left, 0.03, caption, fontsize=10, color=GREY)
    panels = [figure.add_axes((left, 0.12, WIDTH, WIDTH * SIZE[0] / SIZE[1])) for left in LEFT]
    show(panels[0], mesh, rows=800)
    show(
        panels[1], mesh, vivid(results.by_method("salient_points", read_saliency, name)[MODEL]), points=points, rows=800
    )
    show(panels[2], coarse, wires=True, rows=800)
    panels[3].set_axis_off()
    for (down, across), image in zip(
        np.ndindex(SIDE, SIDE), results.by_method("imprints", read_images, name)[MODEL], strict=False
    ):
        _draw_imprint(panels[3].inset_axes((across / SIDE, 1 - (down + 1) / SIDE, 0.94 / SIDE, 0.94 / SIDE)), image)
    places = draw_bars(panels[4], accuracy, ["knn"], chance=1 / classes)
    names = [label(method).partition(" (")[0].replace(" ", "\n") for method in places]
    panels[4].set_xticks(list(places.values()), names, fontsize=9)
    panels[4].set_title(f"kNN, one touch, {classes} objects", fontsize=9.5, fontweight="normal", color=GREY, pad=4)
    return Figure(figure, dpi=120)


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
    methods = results.by_method("imprints", read_images, names[0]).those_of(METHODS)
    width = len(methods) * TOUCHES
    figure, grid = plt.subplots(len(names), width, figsize=(0.82 * width + 0.6, 0.92 * len(names) + 0.3), squeeze=False)
    figure.subplots_adjust(wspace=0.06, hspace=0.06)
    for k, (method, block) in enumerate(zip(methods, np.split(grid, len(methods), axis=1), strict=True)):
        for row, name in zip(block, names, strict=True):
            for axes, image in zip_longest(row, results.by_method("imprints", read_images, name)[method][:TOUCHES]):
                _draw_imprint(axes, image)
                axes.set_position(axes.get_position().translated(0.012 * (k > 0), 0))
        block[0, 0].set_title(f"{label(method)}, first {TOUCHES} points", pad=6)
    for axes, name in zip(grid[:, 0], names, strict=True):
        axes.set_ylabel(name, rotation=0, ha="right", va="center", labelpad=8)
    return Figure(figure)


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
        mesh, points = results.mesh(name), results.by_method("salient_points", read_points, name)[MODEL]
        points = points[touchable(mesh, points)][:TOUCHES]
        most_points = max(most_points, len(points))
        raw = distances(Surface(mesh), points, CELLS, PITCH)
        axes = sensor_axes(sensor_normals(mesh, points))
        draw(part, mesh, mesh.vertices[points], axes, normalise(raw, PITCH), np.ptp(raw, axis=(1, 2)), PITCH)
        if own_meshes:
            part.suptitle(name, fontweight="bold", y=0.995)
    return Figure(figure, dpi=110)


def draw_bars(
    axes: Axes, frame: pd.DataFrame, classifiers: list[str], chance: float, regions: bool = False
) -> dict[str, float]:
    """Draws the samplings of DRAWN that were run; returns dict method -> its place about the middle of a group.

    frame: the tidy table 4.1 or 4.2. regions: whether accuracies on unseen regions are drawn too.
    """
    samplings = set(frame.dropna(subset=["accuracy"])["sampling"])
    paint = colours([method for method in DRAWN if method in samplings])
    width = 0.8 / max(len(paint), 1)
    places = {method: (k - (len(paint) - 1) / 2) * width for k, method in enumerate(paint)}
    for k, (method, place) in enumerate(places.items()):
        rows, x = frame[frame["sampling"] == method].set_index("classifier"), np.arange(len(classifiers)) + place
        cells = 100 * rows.loc[classifiers, ["accuracy", "low", "high", "accuracy_regions", "thesis"]]
        diamonds, dashes = (None, None) if k else ("the thesis's figure", "regions not touched before")
        axes.bar(x, cells["accuracy"], width * 0.92, color=paint[method], label=label(method))
        axes.vlines(x, cells["low"], cells["high"], color=INK, lw=1)
        axes.plot(x, cells["thesis"], "D", color="white", mec=INK, ms=5, mew=1.1, label=diamonds)
        if regions:
            axes.plot(x, cells["accuracy_regions"], "_", color=INK, ms=13, mew=2, label=dashes)
    axes.axhline(100 * chance, color=INK, lw=0.9, ls=":")
    axes.text(1.01, 100 * chance, "chance", transform=axes.get_yaxis_transform(), va="center", fontsize=8.5)
    axes.set_xticks(range(len(classifiers)), [label(name) for name in classifiers])
    axes.set(ylim=(0, 100), ylabel="accuracy, %")
    axes.grid(axis="y")
    axes.tick_params(axis="x", length=0)
    return places


def figure_4_1(results: Results) -> Figure:
    """Table 4.1 as a picture, a panel a protocol."""
    table = table_4_1(results).frame
    parts = list(table[~table["protocol"].str.contains(": ")].groupby("protocol", sort=False))
    figure, panels = plt.subplots(len(parts), 1, figsize=(8.4, 4.1 * len(parts)), squeeze=False)
    figure.subplots_adjust(hspace=0.52)
    for axes, (protocol, frame) in zip(panels[:, 0], parts, strict=True):
        draw_bars(
            axes, frame, [*CLASSIFIERS, *added(frame["classifier"])], chance=1 / results.classes("six"), regions=True
        )
        axes.set_title(f"Recognising {results.group_text('six')} by one touch, {protocol}", pad=42)
        handles, names = axes.get_legend_handles_labels()
        axes.legend(
            handles[1:] + handles[:1], names[1:] + names[:1], loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=3,
            fontsize=9, columnspacing=1.4, handlelength=1.2,
        )  # fmt: skip
    return Figure(figure)


def figure_4_4(results: Results) -> Figure:
    """Correlations of the imprints of each two objects, for blind touch and the thesis's attention."""
    folder = results.folder("classification")
    dataset = folder.parent.name
    best = EQUAL if dataset == PRINTED else SSIM
    groups = sorted(folder.glob("six.*.npz")) or sorted(folder.glob("four.*.npz"))
    first = require_rows(groups, "no groups in data/classification", "classification")[0]
    pairs = list(combinations(map(str, read_arrays(first)["objects"]), 2))
    images = {name: results.by_method("imprints", read_images, name, dataset) for pair in pairs for name in pair}
    samplings = {method: label(method) for method in ("random", best)}
    likeness = {way: [similarity(images[a][way], images[b][way]) for a, b in pairs] for way in samplings}
    order = np.argsort([np.median(values) for values in likeness[best]], kind="stable")
    paint = colours(list(samplings))
    figure, axes = plt.subplots(figsize=(7.6, 0.42 * len(pairs) + 1.2))
    for offset, (method, words) in zip((0.18, -0.18), samplings.items(), strict=True):
        tint, correlations = paint[method], [likeness[method][k] for k in order]
        axes.boxplot(
            [values.ravel() for values in correlations], positions=np.arange(len(pairs)) + offset, widths=0.3,
            orientation="horizontal", whis=(5, 95), showfliers=False, patch_artist=True,
            boxprops={"facecolor": tint, "edgecolor": tint, "alpha": 0.75}, medianprops={"color": INK},
            whiskerprops={"color": tint}, capprops={"color": tint}, label=words,
        )  # fmt: skip
        for k, values in enumerate(correlations):
            share = (values.max(axis=1) >= SIMILARITY_THRESHOLD).mean()
            axes.text(1.03, k + offset, f"{100 * share:.0f} %", va="center", fontsize=8, color=INK)
    axes.axvline(SIMILARITY_THRESHOLD, color=GREY, lw=1, ls="--")
    axes.text(1.03, len(pairs) - 0.35, "share", fontsize=8, color=INK)
    axes.set_yticks(range(len(pairs)), [" – ".join(pairs[k]) for k in order])
    axes.set(xlim=(-1, 1), xlabel="normalised cross-correlation of two imprints")
    axes.tick_params(axis="y", length=0)
    axes.set_title("How alike the imprints of two objects are", pad=26)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=2, fontsize=9)
    return Figure(figure, {"threshold": SIMILARITY_THRESHOLD, "set": dataset_text(dataset)})

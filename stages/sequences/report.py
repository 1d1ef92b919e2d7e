"""Contours: recognising classes of objects by following them (T4.4)."""

from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.base.files import object_files
from haptic_glance.know.split import Split
from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.touch import SectionCurve, contour
from stages.charts.datasets import dataset_text
from stages.charts.drawing import CYCLE, INK, PALE, VIEWPOINT, draw_matrices, label, name_panels, picture, plt, squared
from stages.charts.items import Figure, Table, as_printed
from stages.charts.pareto import pareto_chart
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import WHOSE, Ranking, beside_thesis, everywhere, grid, percent, records, within
from stages.contours.contours import Sequences, read_sequences

THESIS_WORDS = {
    ("cnn_images", "conv1"): "kernel 5, 5, 5; padding 2, 2, 2; stride 2, 2, 5; 8 filters",
    ("cnn_images", "norm"): "batch normalisation",
    ("cnn_images", "conv2"): "kernel 5, 5, 3; padding 1, 1, 0; stride 1, 1, 1; tanh; 16 filters",
    ("cnn_images", "fc1"): "tanh; dropout 0.8",
    ("cnn_images", "fc2"): "tanh",
    ("cnn_images", "scores"): "softmax",
    ("cnn_normals", "conv1"): "kernel 1, 3, 5; ReLU; padding 0; stride 1; 32 filters",
    ("cnn_normals", "norm"): "batch normalisation",
    ("cnn_normals", "conv2"): "kernel 1, 3, 3; ReLU; padding 0; max pooling 1, 1, 0.2; dropout 0.5; 32 filters",
    ("cnn_normals", "fc1"): "ReLU; dropout 0.8",
    ("cnn_normals", "fc2"): "ReLU",
    ("cnn_normals", "scores"): "softmax",
}
NETWORKS = {"cnn_images": "3D, images (4.7)", "cnn_normals": "1D, normals (4.8)"}


def table_4_7(results: Results) -> Table:
    """The layers of both networks, without dropout, beside what the thesis prints of each."""
    rows = results.measured(STAGE, metric="parameters").query("kind != 'Dropout'").reset_index(drop=True)
    frame = rows.rename(columns={"classifier": "network", "value": "parameters"}).astype({"parameters": int})
    frame["thesis"] = [THESIS_WORDS.get(key, "") for key in zip(frame["network"], frame["layer"], strict=True)]
    frame = frame[["network", "layer", "thesis", "kind", "output", "parameters"]]
    text_table = frame.assign(network=frame["network"].map(NETWORKS))
    text_table = text_table.rename(columns={"kind": "ours", "output": "output of ours"})
    totals = frame.groupby("network")["parameters"].sum()
    return Table(frame, text_table, {name: totals[name] for name in NETWORKS})  # no ranking: layers do not compete


def table_4_9(results: Results) -> Table:
    """Accuracy by data set, split, classifier and strategy, beside the thesis's two columns."""
    thesis = results.thesis("table_4_9_sequences").set_index("classifier")
    printed = thesis.rename(columns={"blind": BLIND, "guided": GUIDED}).stack().to_dict()
    by_set = everywhere(results, STAGE, metric=list(METRICS.values()))
    lines = []
    for source, rows in by_set.items():
        rows = rows[(rows[SIZE] == rows[SIZE].max()).all(axis=1)]  # with all their frames and cells
        splits = [split for split in SPLITS if split in set(rows["split"])]
        strategies = sorted(rows["method"].unique(), key=lambda method: (method != BLIND, method != GUIDED))
        for split, classifier, method in product(splits, CLASSIFIERS, strategies):
            runs = rows[(rows["method"] == method) & (rows["classifier"] == classifier)]
            lines.append({
                "objects": source, "split": split, "classifier": classifier, "strategy": method,
                **dict(zip(("accuracy", "low", "high", "values"), accuracy(runs, split), strict=True)),
                "thesis": printed.get((classifier, method), np.nan) if split == Split.RANDOM else np.nan,
                "chance": 1 / runs["classes"].max(), "sequences": runs["sequences"].max(),
                "seconds": runs.loc[(runs["split"] == split) & (runs["metric"] == "accuracy"), "seconds"].median(),
            })  # fmt: skip
    frame = pd.DataFrame(lines)
    cells = frame.assign(tested=frame["objects"].map(dataset_text) + ", " + frame["split"].map(SPLITS))
    cells = cells.sort_values("objects", key=lambda names: names != THESIS_CLASSES, kind="stable", ignore_index=True)
    down, heads = ["tested", "classifier", WHOSE], [f"{label(name)}, %" for name in frame["strategy"].unique()]
    text_table = grid(
        beside_thesis(cells, down[:-1]), down, "strategy", {"classifier": CLASSIFIERS.get},
        lambda name: f"{label(name)}, %", places=1,
    )  # fmt: skip
    sizes = frame.groupby("objects", sort=False)[["sequences", "chance"]].max()
    count_text = ", ".join(f"{int(row.sequences):,} ({dataset_text(row.Index)})" for row in records(sizes))
    chance = ", ".join(f"{dataset_text(row.Index)} {percent(row.chance, 1)} %" for row in records(sizes))
    words = {"not_run": results.left_out(STAGE), "counted": count_text, "chance": chance, "trained": trained(results)}
    return Table(frame, text_table, words, Ranking(heads), split="tested")


def trained(results: Results) -> str:
    """Passes of both networks and the share of training sequences that they know, of the sets that measured it."""
    texts = []
    for dataset in results.datasets(STAGE):
        rows = results.rows(STAGE, dataset)
        rows = rows[rows["metric"].isin(["passes", "train_accuracy"])]
        rows = rows[(rows[SIZE] == rows[SIZE].max()).all(axis=1)]
        if len(rows):
            median = rows.groupby(["classifier", "metric"])["value"].median()
            parts = (
                f"{median[name, 'passes']:.0f} of the {words[:2]} network ({percent(median[name, 'train_accuracy'])} %)"
                for name, words in NETWORKS.items()
            )
            texts.append(f"{dataset_text(dataset)} {', '.join(parts)}")
    return "; ".join(texts) or "not measured"


STAGE = "sequences"
SPLITS = {Split.RANDOM: "sequences drawn at random", Split.OBJECTS: "unseen objects"}
METRICS = {Split.RANDOM: "accuracy", Split.OBJECTS: "accuracy_object"}
SHARED = {Split.RANDOM: 0.2 / 0.8, Split.OBJECTS: 0.0}  # test over training share; of the random splits T4.4.10
CLASSIFIERS = {
    "cnn": "CNNs", "cnn_images": "CNN, images alone", "cnn_normals": "CNN, normals alone", "knn": "kNN", "svm": "SVM",
    "knn_no_som": "kNN, without the map", "svm_no_som": "SVM, without the map",
}  # fmt: skip
PRINTED_METHODS = ("cnn", "knn", "svm")  # those of T table 4.9
BLIND, GUIDED = "random", "thesis_ssim"  # the two columns of T table 4.9
SIZE = ["frames", "cells"]


def accuracy(rows: pd.DataFrame, split: Split) -> tuple[float, float, float, int]:
    """(mean, low, high, values) of one strategy, classifier and size: over random splits, or objects left out."""
    rows = rows[(rows["split"] == split) & (rows["metric"] == METRICS[split])]
    values = rows.groupby(["group", "repetition"], dropna=False)["value"].mean()  # several trainings for one object
    return *within(values, SHARED[split]), len(values)


OBJECTS, PATHS, FRAMES = 4, 3, 6
REACH = 0.09  # units that a normal is drawn long
ROWS = 420
STROKES: list[dict[str, Any]] = [{"lw": 0.8, "alpha": 0.45, "ls": (0, (2, 2))}, {"lw": 2.0}]  # hidden, seen
CLEAR = 2e-3  # units along the view to come off the surface, before asking what hides a point


def figure_4_14(results: Results) -> Figure:
    """The first contours of each strategy on pictures of some objects."""
    items = _chosen(results, OBJECTS)
    strategies = list(next(iter(items.values()))[1])
    size = (2.7 * len(items), 2.9 * len(strategies))
    figure, grid = plt.subplots(len(strategies), len(items), figsize=size, squeeze=False)
    for column, (name, (mesh, contours)) in zip(grid.T, items.items(), strict=True):
        column[0].set_title(label(name), loc="center")
        for axes, strategy in zip(column, strategies, strict=True):
            canvas, sequences = Canvas(axes, mesh), contours[strategy]
            for pair, start, tint in zip(sequences.planes[:PATHS], sequences.positions[:, 0], CYCLE, strict=False):
                canvas.follow(mesh, pair, tint)
                axes.plot(*canvas.pixels(start[None]), "o", mfc="white", mec=tint, mew=1.6, ms=5)
    name_panels(grid, [], map(label, strategies))
    figure.subplots_adjust(wspace=0.03, hspace=0.03)
    words = {"names": ", ".join(map(label, items)), "count": PATHS, "strategies": " and ".join(map(label, strategies))}
    words["on"] = dataset_text(results.folder("contours").parent.name)
    return Figure(figure, words)


def figure_4_15(results: Results) -> Figure:
    """Imprints along the first contour of an object, the contour with the normals of the array, and their parts."""
    ((name, (mesh, contours)),) = _chosen(results, 1).items()
    strategy, sequences = list(contours.items())[-1]
    figure = plt.figure(figsize=(9.6, 5.4))
    grid = figure.add_gridspec(2, FRAMES, height_ratios=[1, 2.4], hspace=0.22, wspace=0.08)
    frames = np.linspace(0, len(sequences.images[0]) - 1, FRAMES).round().astype(int)  # at equal steps
    for column, frame in enumerate(frames):
        axes = figure.add_subplot(grid[0, column])
        axes.imshow(sequences.images[0, frame], cmap="gray", vmin=0, vmax=255)
        axes.set(xticks=[], yticks=[])
        axes.spines[:].set(visible=True, color=PALE)
        share = sequences.pitches[0, frame] / sequences.pitches.max()
        axes.set_title(f"{frame + 1}" + (f", {share:.0%} size" if share < 0.995 else ""), fontsize=9, loc="center")
    _draw_normals(figure.add_subplot(grid[1, :3]), mesh, sequences)
    axes, normals = figure.add_subplot(grid[1, 3:]), sequences.normals[0]
    for part, tint, letter in zip(normals.T, CYCLE, "xyz", strict=False):
        axes.plot(np.arange(1, len(normals) + 1), part, "o-", color=tint, ms=3.5, lw=1.4, label=letter)
    axes.set(xlabel="frame", ylim=(-1.08, 1.08), yticks=[-1, 0, 1])
    axes.grid(axis="y")
    axes.set_ylabel("normal", labelpad=0)
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 0.98))
    return Figure(figure)


def followed(mesh: Mesh, pair: np.ndarray) -> SectionCurve:
    """The curve that was followed on the plane through the object's centre and a pair (2,) of vertices."""
    vertices = mesh.vertices[np.unique(mesh.faces)]
    return contour(mesh, [(vertices.min(axis=0) + vertices.max(axis=0)) / 2, *mesh.vertices[pair]])


class Canvas:
    """Axes with an object's picture, on which contours can be drawn: behind the object faintly."""

    def __init__(self, axes: Axes, mesh: Mesh, viewpoint: Viewpoint = VIEWPOINT) -> None:
        image, (self.top, self.left) = squared(picture(mesh, viewpoint=viewpoint, rows=ROWS), margin=24)
        axes.imshow(image)
        axes.set_axis_off()
        self.axes, self.viewpoint, self.scene = axes, viewpoint, RayScene(mesh)

    def pixels(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(columns, rows) of points (k, 3) in the axes."""
        down, across, _ = project(points, self.viewpoint, (ROWS, ROWS))
        return across - self.left, down - self.top

    def follow(self, mesh: Mesh, pair: np.ndarray, colour: str) -> None:
        """Draws the contour of a pair (2,) of vertices."""
        curve = followed(mesh, pair)
        points = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
        back = self.viewpoint.axes[2]
        middles = (points[:-1] + points[1:]) / 2 + CLEAR * back
        is_hidden = self.scene.cast(middles, np.broadcast_to(back, middles.shape)).hit
        across, down = self.pixels(points)
        for mask, style in zip((is_hidden, ~is_hidden), STROKES, strict=True):
            # One stroke a run of segments that are alike, so that dashes do not start anew at each.
            bounds = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(int)))
            for start, stop in bounds.reshape(-1, 2):
                self.axes.plot(across[start : stop + 1], down[start : stop + 1], color=colour, **style)


def _draw_normals(axes: Axes, mesh: Mesh, sequences: Sequences) -> None:
    """The first contour and the normals of its frames, seen as its plane is seen in full."""
    positions = sequences.positions[0]
    canvas = Canvas(axes, mesh, _facing(positions))
    canvas.follow(mesh, sequences.planes[0], CYCLE[0])
    (across, down), (right, bottom) = canvas.pixels(positions), canvas.pixels(positions + REACH * sequences.normals[0])
    axes.plot([across, right], [down, bottom], color=INK, lw=1.1, solid_capstyle="round")
    axes.plot(across, down, "o", color=CYCLE[0], ms=3.2)
    axes.plot(across[0], down[0], "o", mfc="white", mec=CYCLE[0], mew=1.6, ms=7)
    wide, tall = np.r_[axes.get_xlim(), right], np.r_[axes.get_ylim(), bottom]
    axes.set(xlim=(wide.min(), wide.max()), ylim=(tall.max(), tall.min()))


def _facing(positions: np.ndarray) -> Viewpoint:
    """The Viewpoint that looks at a contour's plane, from above where it is level or slanted."""
    normal = np.linalg.svd(positions - positions.mean(axis=0))[2][2]
    x, y, z = normal if normal[2] >= 0 else -normal
    return Viewpoint(np.degrees(np.arctan2(y, x)) % 360, np.degrees(np.arcsin(np.clip(z, -1, 1))))


def _chosen(results: Results, count: int) -> dict[str, tuple[Mesh, dict[str, Sequences]]]:
    """{name: (Mesh, {strategy: Sequences})}: the preferred objects, then evenly by the alphabet, so by class.

    Blind contours and, where there is one, the thesis's guided strategy or else another.
    """
    folder = results.folder("contours")
    names = require_rows(object_files(folder), "no data/contours", "contours")
    first = [name for name in results.settings.figure_objects if name in names]
    other_names = [name for name in names if name not in first]
    places = np.linspace(0, len(other_names) - 1, OBJECTS).round().astype(int) if other_names else []
    selection = [*first, *dict.fromkeys(other_names[place] for place in places)][:count]
    items = {}
    for name in selection:
        sequences = read_sequences(folder / f"{name}.npz")
        guided = sorted(sequences.keys() - {BLIND}, key=lambda method: (method != GUIDED, method))
        contours = {strategy: sequences[strategy] for strategy in (BLIND, *guided[:1]) if strategy in sequences}
        items[name] = results.mesh(name, folder.parent.name), contours
    return items


THESIS_CLASSES = "princeton_eight"
SHOWN = ("cnn", "cnn_images", "cnn_normals", "knn", "svm", "svm_no_som")
TESTED = {Split.OBJECTS: "objects never touched", Split.RANDOM: "sequences drawn at random"}


def figure_4_19(results: Results) -> Figure:
    """Confusion matrices: a row for each split and strategy, a column for each classifier of the thesis."""
    try:
        frame = results.measured(STAGE, THESIS_CLASSES, metric="confusion")
    except NotRun:
        frame = results.measured(STAGE, metric="confusion")
    pairs = set(zip(frame["split"], frame["method"], strict=True))
    lines = [(split, method) for split in SPLITS for method in (BLIND, GUIDED) if (split, method) in pairs]
    rows = {(split, method): f"{label(method)}\n{SPLITS[split]}" for split, method in lines}
    names = {name: CLASSIFIERS[name] for name in PRINTED_METHODS if name in set(frame["classifier"])}
    figure, words = draw_matrices(frame, rows, names, ["split", "method"], "classifier")
    texts = {"rows": "; ".join(rows.values()).replace("\n", ", "), "columns": ", ".join(names.values())}
    texts["on"] = dataset_text(str(frame["dataset"].iloc[0]))
    return Figure(figure, words | texts)


def chart(results: Results) -> Figure:
    """Accuracy against seconds for each classifier, number of frames and number of cells, of the strategy with most."""
    rows = results.measured(STAGE, metric=list(METRICS.values()), classifier=list(SHOWN))
    split = next(split for split in TESTED if split in set(rows["split"]))
    rows = rows[rows["split"] == split]
    strategy = rows.groupby("method")["frames"].nunique().idxmax()
    rows = rows[rows["method"] == strategy]
    rows = rows.astype(dict.fromkeys(SIZE, int))
    frames, cells = rows[SIZE].max()
    rows = rows[(rows["classifier"] != "cnn_normals") | (rows["cells"] == cells)]  # normals have no cells
    lines = []
    for (classifier, number, side), part in rows.groupby(["classifier", *SIZE]):
        mean, low, high, _ = accuracy(part, split)
        lines.append({
            "classifier": classifier, "of": CLASSIFIERS[classifier], "frames": number, "cells": side,
            "film": f"{number} frames", "name": f"{CLASSIFIERS[classifier]}, {number} x {side} x {side}",
            "mean": mean, "low": low, "high": high, "cost": part.loc[part["metric"] == "accuracy", "seconds"].median(),
        })  # fmt: skip
    frame = pd.DataFrame(lines).sort_values(SIZE, ascending=False, ignore_index=True)
    reference = f"{CLASSIFIERS['knn']}, {frames} x {cells} x {cells}"
    title = f"{int(rows['classes'].max())} classes by following contours, {label(strategy)}, frames x cells x cells"
    return pareto_chart(
        frame, "mean", title=title, reference=reference, quality_label=f"accuracy, {TESTED[split]}", cost="cost",
        clock=results.clock(STAGE),
        colour="of", marker="film", legends={"of": "classifier", "film": "length of a contour"},
    )  # fmt: skip


PAGE = "know"
TABLES = {
    "table_4_7": table_4_7,
    "table_4_9": table_4_9,
}
FIGURES = {
    "figure_4_14": partial(as_printed, figure_4_14, THESIS_CLASSES, stage="contours"),
    "figure_4_15": figure_4_15,
    "figure_4_19": figure_4_19,
}
CHARTS = {
    "sequences": chart,
}

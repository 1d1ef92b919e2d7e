"""T figures 4.14 and 4.15: contours on objects, blind and guided, and what is felt along one."""

import numpy as np

from stages.contours import read_sequences
from stages.kit import Viewpoint
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import CYCLE, INK, PALE, label, plt, save

from .contours import Canvas, followed

BLIND = "random"
OBJECTS, PATHS, FRAMES = 4, 3, 6
REACH = 0.09  # units that a normal is drawn long


def build(results):
    names = sorted(path.stem for path in results.folder("contours").glob("*.npz"))
    if not names:
        raise NotRun("no data/contours", "contours")
    names = _spread(names, results.settings.figure_objects)
    found = {name: read_sequences(results.folder("contours") / f"{name}.npz") for name in names}
    guided = sorted(set(found[names[0]]) - {BLIND}, key=lambda method: (method != "thesis_ssim", method))
    strategies = [one for one in (BLIND, *guided[:1]) if one in found[names[0]]]
    meshes = {name: results.mesh(name, results.folder("contours").parent.name) for name in names}
    paths = [
        _paths(meshes, found, strategies, results.reports / "figures/figure_4_14.png"),
        _felt(names[0], meshes, found, strategies[-1], results.reports / "figures/figure_4_15.png"),
    ]
    felt = found[names[0]][strategies[-1]]
    return Figure(
        "Figures 4.14 and 4.15: contours followed",
        f"Pictures of {', '.join(names)} with {PATHS} contours each, " + " and ".join(map(label, strategies)) + "; "
        f"below, {FRAMES} imprints, the normals round one contour of {names[0]}, and their components.",
        f"All planes pass through the object's centre and two points; a ring marks where a contour begins, dotted is "
        f"behind. Felt along the first contour of {names[0]} ({label(strategies[-1])}), {felt.images.shape[1]} frames: "
        "black is pressed first, row 0 is ahead; the array is smaller where its size is given.",
        paths,
    )


def _spread(names, preferred):
    """Up to OBJECTS names: the preferred ones, then evenly through the list, so through the classes."""
    first = [name for name in preferred if name in names]
    others = [name for name in names if name not in first]
    even = (
        [others[i] for i in np.unique(np.linspace(0, len(others) - 1, OBJECTS).round().astype(int))] if others else []
    )
    return (first + even)[:OBJECTS]


def _paths(meshes, found, strategies, path):
    figure, grid = plt.subplots(
        len(strategies), len(meshes), figsize=(2.7 * len(meshes), 2.9 * len(strategies)), squeeze=False
    )
    for down, strategy in enumerate(strategies):
        for axes, (name, mesh) in zip(grid[down], meshes.items(), strict=True):
            canvas = Canvas(axes, mesh)
            for place, pair in enumerate(found[name][strategy].planes[:PATHS]):
                piece = followed(mesh, pair)
                canvas.line(piece.points, CYCLE[place], piece.closed)
                begin = canvas.pixels(found[name][strategy].positions[place, :1])
                axes.plot(*begin, "o", mfc="white", mec=CYCLE[place], mew=1.6, ms=5)
            if down == 0:
                axes.set_title(name.replace("_", " "), loc="center")
        side = grid[down, 0].text(-0.04, 0.5, label(strategy), rotation=90, ha="right", va="center")
        side.set_transform(grid[down, 0].transAxes)
    figure.subplots_adjust(wspace=0.03, hspace=0.03)
    return save(figure, path)


def _felt(name, meshes, found, strategy, path):
    sequences = found[name][strategy]
    images, normals, positions = sequences.images[0], sequences.normals[0], sequences.positions[0]
    shown = np.linspace(0, len(images) - 1, FRAMES).round().astype(int)
    figure = plt.figure(figsize=(9.6, 5.4))
    grid = figure.add_gridspec(2, FRAMES, height_ratios=[1, 2.4], hspace=0.22, wspace=0.08)
    usual = sequences.pitches.max()
    for column, frame in enumerate(shown):
        axes = figure.add_subplot(grid[0, column])
        axes.imshow(images[frame], cmap="gray", vmin=0, vmax=255)
        axes.set(xticks=[], yticks=[])
        axes.spines[:].set(visible=True, color=PALE)
        share = sequences.pitches[0, frame] / usual
        axes.set_title(f"{frame + 1}" + (f", {share:.0%} size" if share < 0.995 else ""), fontsize=9, loc="center")
    piece = followed(meshes[name], sequences.planes[0])
    canvas = Canvas(figure.add_subplot(grid[1, :3]), meshes[name], _facing(positions))
    canvas.line(piece.points, CYCLE[0], piece.closed)
    starts, ends = canvas.pixels(positions), canvas.pixels(positions + REACH * normals)
    for x, y in zip(zip(starts[0], ends[0], strict=True), zip(starts[1], ends[1], strict=True), strict=True):
        canvas.axes.plot(x, y, color=INK, lw=1.1, solid_capstyle="round")
    canvas.axes.plot(*starts, "o", color=CYCLE[0], ms=3.2)
    canvas.axes.plot(starts[0][0], starts[1][0], "o", mfc="white", mec=CYCLE[0], mew=1.6, ms=7)
    canvas.widen(*ends)
    axes = figure.add_subplot(grid[1, 3:])
    for part, tint, letter in zip(normals.T, CYCLE, "xyz", strict=False):
        axes.plot(np.arange(1, len(normals) + 1), part, "o-", color=tint, ms=3.5, lw=1.4, label=letter)
    axes.set(xlabel="frame", ylim=(-1.08, 1.08), yticks=[-1, 0, 1])
    axes.grid(axis="y")
    axes.set_ylabel("normal", labelpad=0)
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 0.98))
    return save(figure, path)


def _facing(positions):
    """The Viewpoint that looks at a contour's plane, from above where it is level or slanted."""
    normal = np.linalg.svd(positions - positions.mean(axis=0))[2][2]
    normal = normal if normal[2] >= 0 else -normal
    return Viewpoint(
        np.degrees(np.arctan2(normal[1], normal[0])) % 360, np.degrees(np.arcsin(np.clip(normal[2], -1, 1)))
    )

"""A picture of touches: their places on the mesh, and the imprints."""

from pathlib import Path

import numpy as np
from matplotlib.backends.registry import BackendFilter, backend_registry
from matplotlib.figure import Figure, FigureBase

from haptic_glance.base.files import whole_file
from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene

from .press import as_shown

CANDIDATES = tuple(Viewpoint(az % 360, el) for el in (22, -22, 65) for az in range(305, 665, 30))  # the default first
OBLIQUE_PENALTY = 0.6  # places: how many more a view from far above or below must show
WELL_VISIBLE = 0.5  # cosine of the angle between normal and viewer, above which a place is fully visible
MIN_GAIN = 0.4  # places: how many more a second view must show
ROWS, SUPERSAMPLING = 560, 2  # rows of a view; rendered at twice the resolution and averaged
MAX_IMPRINTS = 24  # in one picture
RELIEF = "the imprint's relief"  # what 0 to 1 of an image stands for, unless it is a depth
MARK, INK, GREY = "#C2185B", "#222222", "#767676"
LABEL_GAP = 0.052  # of the rows: least distance of two numbers
RAY_OFFSET = 2e-3  # units off the surface, so that no place hides itself


def write_picture(
    path: Path,
    mesh: Mesh,
    positions: np.ndarray,
    axes: np.ndarray,
    images: np.ndarray,
    reliefs: np.ndarray,
    pitch: float,
    scale: str = RELIEF,
    up: str = "z",
) -> None:
    """Writes the picture of `draw` as a PNG with the same bytes in every run; up: the axis that points up there."""
    figure = Figure(figsize=(12, 5.4))
    draw(figure, mesh, positions, axes, images, reliefs, pitch, scale)
    figure.text(0.008, 0.985, f"↑ {up}", fontsize=10, color=GREY, va="top")
    with whole_file(path) as part:
        figure.savefig(part, dpi=130, format="png", metadata={"Software": None})


def draw(
    figure: FigureBase,
    mesh: Mesh,
    positions: np.ndarray,
    axes: np.ndarray,
    images: np.ndarray,
    reliefs: np.ndarray,
    pitch: float,
    scale: str = RELIEF,
) -> None:
    """Draws the mesh with numbered places and outlines of the array to scale, and the imprints beside it.

    mesh: in the frame of haptic_glance.mesh.repair, +z up; positions (k, 3), axes (k, 3, 3) of the arrays; images (k,
    rows, cols) in 0..1; reliefs (k,) in units. One or two views show as many places as possible. The first 24 imprints
    are shown.
    """
    total, count = len(images), min(len(images), MAX_IMPRINTS)
    positions, axes, images = positions[:count], axes[:count], images[:count]
    views = best_views(mesh, positions, axes[:, 2])
    left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=[1, 1.55], wspace=0)[0]
    panels = left.subplots(len(views), 1, squeeze=False, gridspec_kw=_margins(0.01, 0.99, 0.05, 0.95, 0.04))[:, 0]
    half = np.array(images.shape[1:]) / 2 * pitch
    numbers = np.arange(1, count + 1)
    is_visible = [visible(mesh, positions, axes[:, 2], view) for view in views]
    for panel, view, mask in zip(panels, views, is_visible, strict=True):
        _draw_view(panel, mesh, view, positions[mask], axes[mask], half, numbers[mask])
    hidden_numbers = numbers[~np.any(is_visible, axis=0)]
    if len(hidden_numbers):
        note = f"not visible: {', '.join(map(str, hidden_numbers))}"
        left.text(0.02, 0.015, note, fontsize=8.5, color=GREY, va="bottom")
    reliefs = np.asarray(reliefs)[:count]
    tiles = as_shown(images, reliefs, pitch) if scale == RELIEF else images
    _draw_imprints(right, tiles, reliefs, scale, total)


def best_views(mesh: Mesh, positions: np.ndarray, normals: np.ndarray) -> list[Viewpoint]:
    """One or two Viewpoints: the one that shows the most places well, and one for the remaining places, if any."""
    is_visible = np.array([visible(mesh, positions, normals, view) for view in CANDIDATES])
    facing = np.array([np.maximum(normals @ view.axes[2], 0) for view in CANDIDATES])
    visibility = is_visible * np.minimum(facing / WELL_VISIBLE, 1)
    penalty = -OBLIQUE_PENALTY * np.array([view.elevation != CANDIDATES[0].elevation for view in CANDIDATES])
    first = int(np.argmax(visibility.sum(axis=1) + penalty))
    gain = np.maximum(visibility - visibility[first], 0).sum(axis=1) + (is_visible & ~is_visible[first]).sum(axis=1)
    second = int(np.argmax(gain + penalty))
    return [CANDIDATES[k] for k in ([first, second] if gain[second] + penalty[second] >= MIN_GAIN else [first])]


def visible(mesh: Mesh, positions: np.ndarray, normals: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(k,) boolean: the places face the viewer and nothing of the mesh hides them."""
    back = viewpoint.axes[2]
    is_hidden = RayScene(mesh).cast(positions + RAY_OFFSET * normals, np.broadcast_to(back, positions.shape)).hit
    return ~is_hidden & (normals @ back > 0.05)


def _draw_view(panel, mesh, view, positions, axes, half, numbers):
    """Draws the mesh from one viewpoint with its places."""
    image = _shaded(mesh, view)
    (top, bottom), (start, end) = _window(image)
    panel.imshow(image, extent=(-0.5, ROWS - 0.5, ROWS - 0.5, -0.5))
    corners = np.array([[-1, 1], [1, 1], [1, -1], [-1, -1], [-1, 1]]) * half[::-1]
    for centre, (along, up, _) in zip(positions, axes, strict=True):
        rows, columns, _ = project(centre + corners[:, :1] * along + corners[:, 1:] * up, view, (ROWS, ROWS))
        panel.plot(columns, rows, color=MARK, lw=0.9, alpha=0.85)
    rows, columns, _ = project(positions, view, (ROWS, ROWS))
    span = max(bottom - top, end - start)
    for number, row, column, label in zip(
        numbers, rows, columns, _label_positions(rows, columns, LABEL_GAP * span), strict=True
    ):
        panel.plot([column, label[1]], [row, label[0]], color=MARK, lw=0.8)
        panel.plot(column, row, "o", color=MARK, ms=2.5)
        box = {"boxstyle": "circle,pad=0.18", "fc": "white", "ec": MARK, "lw": 0.9}
        panel.text(label[1], label[0], str(number), ha="center", va="center", fontsize=7.5, color=INK, bbox=box)
    panel.set_xlim(start, end)
    panel.set_ylim(bottom, top)
    panel.set_axis_off()


def _label_positions(rows, columns, min_gap):
    """(k, 2) rows and columns of the numbers: near their places, at least `min_gap` from each other."""
    spots = np.stack([rows, columns], axis=1)
    if len(spots) == 0:
        return spots
    outward = spots - spots.mean(axis=0)
    length = np.linalg.norm(outward, axis=1, keepdims=True)
    fallback = np.stack([-np.ones(len(spots)), np.zeros(len(spots))], axis=1)
    labels = spots + min_gap * np.where(length > 1e-9, outward / np.maximum(length, 1e-9), fallback)
    for _ in range(200):
        gaps = labels[:, None] - labels[None]
        distances = np.linalg.norm(gaps, axis=2) + np.eye(len(labels)) * 2 * min_gap
        push = np.maximum(min_gap - distances, 0) / np.maximum(distances, 1e-6)
        labels = labels + 0.5 * (gaps * push[..., None]).sum(axis=1)
    return labels


def _draw_imprints(figure, images, reliefs, scale, total):
    columns = _columns(len(images), images.shape[2] / images.shape[1])
    rows = -(-len(images) // columns)
    grid = figure.subplots(rows, columns, squeeze=False, gridspec_kw=_margins(0.02, 0.86, 0.085, 0.93, 0.34))
    for axes in grid.flat[len(images) :]:
        axes.set_axis_off()
    size = 9 if len(images) <= 12 else 7.5
    for number, (axes, image, relief) in enumerate(zip(grid.flat, images, reliefs, strict=False), start=1):
        axes.imshow(image, cmap="gray", vmin=0, vmax=1)
        axes.set(xticks=[], yticks=[])
        axes.spines[:].set(visible=True, color=GREY, linewidth=0.6)
        axes.set_title(f"{number}", fontsize=size + 1, fontweight="bold", pad=3, loc="center")
        axes.set_xlabel(f"relief {relief:.3f}", fontsize=size, labelpad=2, color=GREY)
    height = 0.84 if rows > 1 else 0.6
    place = figure.add_axes((0.89, 0.51 - height / 2, 0.018, height))
    bar = figure.colorbar(grid.flat[0].images[0], cax=place, ticks=[0, 0.25, 0.5, 0.75, 1])
    bar.ax.set_yticklabels(["0", "25", "50", "75", "100"], fontsize=8)
    bar.set_label(f"distance from the array, % of {scale} (black: first contact)", fontsize=8.5)
    note = "relief: greatest minus least distance, in units (the bounding sphere is 1 across)"
    note += "; fainter below a tenth of the pitch"
    note += f"; the first {len(images)} of {total} places" if total > len(images) else ""
    figure.text(0.02, 0.012, note, fontsize=8.5, color=GREY, va="bottom")


def _columns(count, aspect=1.0):
    """The number of columns in which `count` images with titles, `aspect` times as wide as high, are the largest."""
    sides = {
        columns: min(6.0 / columns / aspect, 4.9 / (-(-count // columns)) / 1.34) for columns in range(1, count + 1)
    }
    return max(sides, key=lambda columns: round(sides[columns], 6))


def _margins(left, right, bottom, top, gap):
    return {"left": left, "right": right, "bottom": bottom, "top": top, "wspace": 0.14, "hspace": gap}


def _shaded(mesh, viewpoint):
    side = ROWS * SUPERSAMPLING
    view = render(Mesh(mesh.vertices, mesh.faces), viewpoint, (side, side), renderer="raster", background="white")
    return view.rgb.reshape(ROWS, SUPERSAMPLING, ROWS, SUPERSAMPLING, 3).mean(axis=(1, 3)) / 255


def _window(image):
    """((top, bottom), (left, right)) of the object with a margin for the numbers."""
    mask = (image < 1).any(axis=2)
    ends = [np.flatnonzero(mask.any(axis=axis))[[0, -1]] for axis in (1, 0)]
    room = 2.2 * LABEL_GAP * max(np.ptp(end) for end in ends)
    return [(low - room, high + room) for low, high in ends]


def check_window() -> None:
    """Raises ValueError if no window can be opened."""
    from matplotlib import pyplot

    interactive = backend_registry.list_builtin(BackendFilter.INTERACTIVE)
    if pyplot.get_backend().lower() not in interactive:
        raise ValueError("--show: there is no display; leave it out and open the written picture")


def open_window(path: Path) -> None:
    """Shows a picture in a window until it is closed."""
    from matplotlib import pyplot

    image = pyplot.imread(path)
    figure = pyplot.figure(str(path), figsize=(image.shape[1] / 130, image.shape[0] / 130), dpi=100)
    figure.add_axes((0, 0, 1, 1)).imshow(image)
    figure.axes[0].set_axis_off()
    pyplot.show()

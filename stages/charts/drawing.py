"""Pictures of the report: one style, meshes drawn by rays, and names beside points.

All pictures have a white page, quiet axes and colours that the colour-blind can tell apart. `picture` draws a mesh with
lit surface, vertex colours, wires and points. `place_names` puts names on free places, without covering names or
points.
"""

import io
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from itertools import cycle, product
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.ticker import LogLocator, NullFormatter
from matplotlib.transforms import Bbox
from PIL import Image

from haptic_glance.base.files import whole_file
from haptic_glance.look.camera import Viewpoint, pixel_rays, pixels_per_unit, project
from haptic_glance.look.points.methods import PLUS, SUMS
from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.rays import RayScene, barycentric

matplotlib.use("Agg")  # no screen where pipelines run

MAP = "viridis"  # for saliency: even in lightness, safe for the colour-blind
INK, GREY, PALE = "#222222", "#767676", "#d9d9d9"
# Okabe and Ito 2008: eight colours that stay apart under the common colour deficiencies.
CYCLE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A6A00", "#000000"]
LABELS = {
    "random": "blind touch",
    "itti": "Itti's attention",
    "VisAttAll": "thesis, equal weights",
    "equal": "thesis, nine equal weights",
    "thesis_ssim": "thesis, SSIM",
    "thesis_ed": "thesis, ED",
    "glance_any_pose": "glance, any pose",
    "glance_deep": "glance, deep",
    "human": "the truth itself",
    "guided_ssim": "guided by SSIM",
    "guided_ed": "guided by ED",
    "guided_ssim+object": "guided by SSIM on the object",
    "svm+nearest": "thesis, SVM of the nearest object",
    "svm+object": "thesis, SVM of the object",
    "svm+viewpoint": "thesis, SVM of each view",
    "leifman": "regions of interest",
    "song": "spectral saliency",
    "tasse": "cluster-based saliency",
    "sift": "3D-SIFT",
    "harris": "3D-Harris",
    "corners": "scale-dependent corners",
    "farthest": "farthest points",
    "touch": "places to touch",
    "centre_distance": "distance from the centre",
    "spectral_residual": "spectral residual (OpenCV)",
    "fine_grained": "fine-grained (OpenCV)",
    "qem": "plain QEM",
    "qslim": "QSlim",
    "knn": "kNN",
    "svm": "SVM",
    "naive_bayes": "naive Bayes",
    "mean_without_svm": "mean without the SVM",
    "discriminant": "linear discriminant",
    "linear_svm": "linear SVM",
    "heat_kernel": "heat kernel signature",
    "hks": "heat kernel signature",
    "dkl": "DKL",
    "alexnet": "AlexNet",
    "googlenet": "GoogLeNet",
    "vgg16": "VGG16",
    "resnet50": "ResNet50",
    "resnet101": "ResNet101",
    "mobilenet_v2": "MobileNetV2",
    "efficientnet_lite0": "EfficientNet-Lite0",
    "finetuned": "fine-tuned",
    "last_block": "last block fine-tuned",
    "fast": "fast (ours)",
    "fast_simplification": "fast-simplification",
    "meshoptimizer_native": "meshoptimizer 0.2.30a0",
    "vtk": "VTK",
}
WAYS = ("adaptive", "area", "soft")  # of keeping a neighbourhood; behind a method's name
METHOD_COLOURS = {
    "random": "#E69F00", "itti": "#56B4E9", "VisAttAll": "#D55E00", "thesis_ssim": "#009E73", "glance": "#0072B2",
    "qem": GREY,
}  # fmt: skip
MARKERS = "osD^vPX*"
PALETTE = 160  # colours of a picture: a fourth of the bytes, and the shading of meshes still looks smooth
SETTLED = 1_000  # pixels that still change their colour: to go on until all stay takes five times as long
MARGIN = 0.12  # inches round a picture; its box is measured here, since "tight" would draw it once more
SETTINGS: dict[Any, Any] = {
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same letters on every machine
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#ececec",
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "image.interpolation": "antialiased",
}


def label(name: object) -> str:
    """A method's name in words, with its way of keeping neighbourhoods where there is one, but without `+seen`."""
    text = str(name)
    base, _, way = text.rpartition("-")
    if text.endswith(PLUS + SUMS):
        return f"{label(text.removesuffix(PLUS + SUMS))}, sums"
    words = LABELS.get(text) or LABELS.get(text.removesuffix("+seen")) or text.replace("_", " ").replace(PLUS, " ")
    return f"{label(base)}, {way}" if way in WAYS else words


def start(weights: str) -> str:
    """The weights that a network starts from, in words."""
    names = {"imagenet": "ImageNet", "random_initial": "random weights, initial statistics"}
    return names.get(weights) or f"{weights} weights"


def colours(names: Sequence[str]) -> dict[str, str]:
    """dict name -> colour: fixed for the known methods, the cycle for others."""
    fixed = {name: METHOD_COLOURS[name] for name in names if name in METHOD_COLOURS}
    free = cycle(colour for colour in CYCLE if colour not in fixed.values())
    return {name: fixed.get(name) or next(free) for name in names}


def plain_logarithm(axis: Axis, subs: Sequence[float] = (1.0, 2.0, 5.0)) -> None:
    """Numbers without powers at these multiples of a logarithmic axis's decades."""
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_formatter(NullFormatter())


def save(figure: Figure, path: Path, dpi: int = 130) -> Path:
    """Writes a PNG of PALETTE colours without dates or versions, so that equal runs give equal bytes; the path."""
    buffer = io.BytesIO()
    figure.set_dpi(dpi)
    if figure.get_layout_engine():
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # all has its place now; a chart on the page is drawn again
    box = figure.get_tightbbox().padded(MARGIN)
    figure.savefig(buffer, format="tiff", dpi=dpi, bbox_inches=box)  # without compression, since it is read at once
    plt.close(figure)
    with Image.open(buffer) as image:
        indexed = image.convert("RGB").quantize(PALETTE, Image.Quantize.MEDIANCUT, SETTLED, dither=Image.Dither.NONE)
    with whole_file(path) as part:
        indexed.save(part, "PNG", optimize=True)
    return path


VIEWPOINT = Viewpoint(305, 22)  # from above and the side: most household objects show their parts
CLAY = np.array([0.80, 0.80, 0.82])
WIRE = np.array([0.16, 0.22, 0.32])
BRIGHT = 0.98  # of the vertices are coloured by their value, those above as the brightest
CREASE = 0.8  # cosine of the angle over which an edge is drawn sharp
THIN = 0.25  # of its square: an object that fills less is no good for wires
LIGHT = unit(np.array([-0.35, 0.55, 0.75]))  # right, up, towards the viewer


def picture(
    mesh: Mesh,
    values: np.ndarray | None = None,
    wires: bool = False,
    viewpoint: Viewpoint = VIEWPOINT,
    rows: int = 420,
    smoothing: int = 2,
    tints: str = MAP,
) -> np.ndarray:
    """(rows, rows, 3) f8 in 0..1: the mesh on white.

    values (n,) in 0..1 colour the vertices by the map `tints`; wires draws the edges.
    """
    side = rows * smoothing
    pixels, face, weights, light = _surface(mesh, viewpoint, side)
    base = CLAY if values is None else colour_map(np.einsum("ij,ij->i", weights, values[mesh.faces[face]]), tints)
    shaded = base * light[:, None]
    if wires:
        near = _edge_distance(mesh, face, weights) * pixels_per_unit(side)
        shaded = np.where((near < 0.4 * smoothing)[:, None], WIRE, shaded)
    image = np.ones((side * side, 3))
    image[pixels] = np.clip(shaded, 0, 1)
    return image.reshape(rows, smoothing, rows, smoothing, 3).mean(axis=(1, 3))


_scene = lru_cache(maxsize=2)(RayScene)  # a mesh is drawn many times in turn, with its points and in many colours


@lru_cache(maxsize=2)
def _surface(mesh: Mesh, viewpoint: Viewpoint, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The content of a square picture: (pixels (k,), their faces (k,), the places in these (k, 3), the light (k,))."""
    size = (side, side)
    box = [slice(*np.clip((ends.min() - 1, ends.max() + 3), 0, side).astype(int))
           for ends in project(mesh.vertices, viewpoint, size)[:2]]  # fmt: skip
    down, across = np.mgrid[*box].reshape(2, -1)  # no ray beside the mesh
    origins, directions = pixel_rays(down, across, viewpoint, size)
    hits = _scene(mesh).cast(origins, directions)
    ray_ids = np.flatnonzero(hits.hit)
    face = hits.face[ray_ids]
    where = origins[ray_ids] + directions[ray_ids] * hits.distance[ray_ids, None]
    weights = np.clip(barycentric(mesh, face, where), 0, 1)
    return side * down[ray_ids] + across[ray_ids], face, weights, _light(mesh, face, weights, viewpoint)


def vivid(values: np.ndarray) -> np.ndarray:
    """Values (n,) over their 98 % quantile, at most 1: a map with a few high peaks would be dark everywhere else."""
    top = np.quantile(values, BRIGHT) or values.max() or 1.0
    return np.clip(values / top, 0, 1)


def visible(
    mesh: Mesh, vertices: np.ndarray, viewpoint: Viewpoint = VIEWPOINT, rows: int = 420
) -> tuple[np.ndarray, np.ndarray]:
    """(rows (k',), columns (k',)) in the picture of those of the vertices (k,) that the viewer sees."""
    points, normals, back = mesh.vertices[vertices], mesh.vertex_normals[vertices], viewpoint.axes[2]
    start = points + 1e-3 * normals  # off the surface, or each point would hide itself
    is_hidden = _scene(mesh).cast(start, np.broadcast_to(back, points.shape)).hit
    return project(points[~is_hidden & (normals @ back > 0)], viewpoint, (rows, rows))[:2]


def filled(mesh: Mesh) -> float:
    """The share of its square that an object fills: of a thin one the wires cannot be told apart."""
    return float((squared(picture(mesh, rows=60, smoothing=1), margin=0)[0] < 1).any(axis=2).mean())


def squared(image: np.ndarray, margin: int = 6) -> tuple[np.ndarray, tuple[int, int]]:
    """(image, (top, left)): the smallest square round the object."""
    down, across = np.nonzero((image < 1).any(axis=2))
    if not len(down):
        return image, (0, 0)
    side = min(max(np.ptp(down), np.ptp(across)) + 2 * margin, len(image))
    top, left = (int(np.clip((ids.min() + ids.max() - side) // 2, 0, len(image) - side)) for ids in (down, across))
    return image[top : top + side, left : left + side], (top, left)


def square_grid(
    rows: int, columns: int, side: float, right: float = 0.0, gap: float = 0.0
) -> tuple[Figure, np.ndarray]:
    """(figure, axes (rows, columns)): square panels of `side` inches, `right` inches free beside, `gap` between."""
    width, height = columns * side + right, rows * side + (rows - 1) * gap
    frame = {"left": 0, "right": columns * side / width, "bottom": 0, "top": 1, "wspace": 0, "hspace": gap / side}
    return plt.subplots(rows, columns, figsize=(width, height), gridspec_kw=frame, squeeze=False)


def show(
    axes: Axes,
    mesh: Mesh,
    values: np.ndarray | None = None,
    wires: bool = False,
    points: np.ndarray | None = None,
    rows: int = 420,
    tints: str = MAP,
) -> None:
    """Draws a mesh into matplotlib axes, square and without frame; points (k,) vertex ids become red dots."""
    image, (top, left) = squared(picture(mesh, values, wires, VIEWPOINT, rows, tints=tints))
    axes.imshow(image)
    if points is not None:
        down, across = visible(mesh, points, VIEWPOINT, rows)
        axes.plot(across - left, down - top, "o", color="#D81B1B", ms=4.2, mec="white", mew=0.8, clip_on=False)
    axes.set_axis_off()


def colour_bar(figure: Figure, box: Sequence[float], text: str, tints: str = MAP, ends: Sequence[str] = ()) -> None:
    """A bar of the maps' colours from 0 to 1 in box [left, bottom, width, height] of the figure, and what it is of.

    ends: words in place of the numbers, the lowest first.
    """
    left, bottom, width, height = box
    bar = figure.colorbar(ScalarMappable(Normalize(0, 1), tints), cax=figure.add_axes((left, bottom, width, height)))
    bar.set_label(text, fontsize=9)
    if ends:
        bar.set_ticks([*np.linspace(0, 1, len(ends))], labels=list(ends), fontsize=9)
    bar.outline.set_edgecolor(GREY)


def colour_map(values: np.ndarray, tints: str = MAP) -> np.ndarray:
    """(..., 3) RGB of values (...) in 0..1."""
    return matplotlib.colormaps[tints](np.clip(values, 0, 1))[..., :3]


def _light(mesh: Mesh, face: np.ndarray, weights: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """Head light and a soft key light; normals are smooth but for sharp edges."""
    flat = mesh.face_normals[face]
    smooth = unit(np.einsum("ij,ijk->ik", weights, mesh.vertex_normals[mesh.faces[face]]))
    normal = np.where((np.einsum("ij,ij->i", flat, smooth) > CREASE)[:, None], smooth, flat) @ viewpoint.axes.T
    normal *= np.sign(normal[:, 2:3] + 1e-12)  # an inside seen through an opening is lit as well
    return 0.42 + 0.3 * normal[:, 2] + 0.38 * np.clip(normal @ LIGHT, 0, 1)


def _edge_distance(mesh: Mesh, face: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(k,) distance of a point in its face to the nearest edge, in units."""
    corners = mesh.vertices[mesh.faces[face]]
    opposite = np.linalg.norm(np.roll(corners, -1, axis=1) - np.roll(corners, 1, axis=1), axis=2)
    heights = 2 * mesh.face_areas[face, None] / np.maximum(opposite, 1e-12)
    return (weights * heights).min(axis=1)


def name_panels(
    grid: np.ndarray,
    above: Iterable[str] = (),
    beside: Iterable[str] = (),
    letters: tuple = (10, 10),
    away: float = 0.04,
) -> None:
    """Words over each column of axes (rows, columns) and, upright, before each row; letters: sizes of both."""
    for axes, words in zip(grid[0], above, strict=False):
        axes.set_title(words, fontsize=letters[0], fontweight="normal", loc="center")
    for axes, words in zip(grid[:, 0], beside, strict=False):
        axes.text(-away, 0.5, words, rotation=90, va="center", ha="right", fontsize=letters[1],
                  transform=axes.transAxes)  # fmt: skip


SIDES = [(1, 1), (-1, 1), (1, -1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1)]  # of the point, the best first
GAPS = [8, 14, 26, 40]  # from the point to its name, in typographic points
FAR = 14  # a name from this gap on gets a thin line to its point
CROSSING = 15  # a crossed line is as bad as so much more of a gap
SIZE, RADIUS = 8.5, 5.5  # of the letters and of a point with its rim, in typographic points


Spot = tuple[float, float]


def place_names(
    axes: Axes, names: Iterable[tuple[str, Spot]], points: np.ndarray, lines: Iterable[Sequence[Spot]]
) -> list[Annotation]:
    """Writes each name at the nearest free place around its point; returns the texts.

    names: list of (text, (x, y)); points (k, 2): all that no name may cover; lines: list of two ends each, which names
    avoid where they can. All in the data's units. To be called last, when nothing moves the limits of the
    axes any more. A name that finds no free place is left out.
    """
    figure: Any = axes.figure  # whole, no part of one
    figure.draw_without_rendering()  # limits are settled only by drawing
    scale = figure.dpi / 72
    to_pixels = axes.transData.transform
    boxes = [_around(spot[None], RADIUS * scale) for spot in to_pixels(points)]
    strokes = [_around(to_pixels(ends), scale) for ends in lines]
    labels = []
    for text, point in names:
        probe, spot = axes.text(0, 0, text, fontsize=SIZE), to_pixels(point)
        extent = probe.get_window_extent()
        probe.remove()
        best = _nearest(axes, (extent.width, extent.height), spot, boxes, strokes, scale)
        if best is None:
            continue
        gap, box = best
        boxes.append(box)
        place = {"xytext": ((box.x0 - spot[0]) / scale, (box.y0 - spot[1]) / scale), "textcoords": "offset points"}
        if gap >= FAR:
            boxes += _leader(spot, box, scale)
            place["arrowprops"] = {"arrowstyle": "-", "color": GREY, "lw": 0.6, "shrinkA": 0, "shrinkB": 4}
        labels.append(axes.annotate(text, point, ha="left", va="bottom", fontsize=SIZE, color=INK, zorder=4, **place))
    return labels


def _nearest(
    axes: Axes, extent: Spot, spot: np.ndarray, taken: list[Bbox], strokes: list[Bbox], scale: float
) -> tuple[float, Bbox] | None:
    """(gap, box) of the best free place, or None. taken: what no name may cover; strokes: what it better does not."""
    window, free = axes.get_window_extent(), []
    for gap, side in product(GAPS, SIDES):
        if free and min(free)[0] <= gap:
            break  # no place from here on is better
        box = _beside(spot, extent, side, gap * scale)
        inside = window.x0 <= box.x0 and box.x1 <= window.x1 and window.y0 <= box.y0 and box.y1 <= window.y1
        if not inside or box.count_overlaps(taken):
            continue
        line = _leader(spot, box, scale) if gap >= FAR else []  # its line would belong to others where it crosses them
        if not any(part.count_overlaps(taken + strokes) for part in line):
            free.append((gap + CROSSING * box.count_overlaps(strokes), len(free), gap, box))
    return min(free)[2:] if free else None


def _leader(spot: np.ndarray, box: Bbox, scale: float) -> list[Bbox]:
    """Small boxes along the thin line to a name, from a little way off its point."""
    middle = np.array([(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2])
    near = min(1.0, 2 * RADIUS * scale / np.linalg.norm(middle - spot))
    return [_around((spot + share * (middle - spot))[None], scale) for share in np.linspace(near, 1, 30)]


def _beside(spot: np.ndarray, extent: Spot, side: tuple[int, int], gap: float) -> Bbox:
    """The box of a text of this extent at one side of a spot, in pixels."""
    (x, y), (width, height), (across, up) = spot, extent, side
    step = gap if across == 0 or up == 0 else 0.7 * gap  # at a corner both ways count
    x0 = x - width / 2 + across * (width / 2 + step)
    y0 = y - height / 2 + up * (height / 2 + step)
    return Bbox.from_extents(x0, y0, x0 + width, y0 + height)


def _around(spots: np.ndarray, margin: float) -> Bbox:
    """The box around spots (k, 2) with a margin: around one point, or the ends of an upright or level line."""
    return Bbox([spots.min(axis=0) - margin, spots.max(axis=0) + margin])


DARK = 55  # per cent from which a number is written in white


def draw_matrices(
    frame: pd.DataFrame, rows: Mapping[Any, str], columns: Mapping[Any, str], down: list[str], across: str
) -> tuple[Figure, dict[str, Any]]:
    """(figure, its words count and classes): a grid of matrices of `value` items of `group` taken for `predicted`.

    rows, columns: {values of the columns `down`, or value of the column `across`: how they are said}.
    """
    classes = list(dict.fromkeys(frame["group"]))
    count, side = len(classes), 0.3 * len(classes) + 0.5
    size = (side * len(columns) + 1.4, side * len(rows) + 0.8)
    figure, grid = plt.subplots(len(rows), len(columns), figsize=size, squeeze=False)
    for panels, (key, words) in zip(grid, rows.items(), strict=True):
        matrices = frame[(frame[down] == key).all(axis=1)]
        for axes, value in zip(panels, columns, strict=True):
            _draw(axes, matrices[matrices[across] == value], classes)
        panels[0].set_yticks(range(count), [f"{name} {k}" for k, name in enumerate(classes, start=1)], fontsize=7.5)
        panels[0].set_ylabel(words, fontsize=9)
    for top, bottom, words in zip(grid[0], grid[-1], columns.values(), strict=True):
        top.set_title(words, pad=6)
        bottom.set_xticks(range(count), range(1, count + 1), fontsize=7.5)
    figure.subplots_adjust(wspace=0.06, hspace=0.08)
    return figure, {"count": count, "classes": ", ".join(classes)}


def _draw(axes: Axes, rows: pd.DataFrame, classes: list[str]) -> None:
    counts = rows.pivot_table(index="group", columns="predicted", values="value", aggfunc="sum", fill_value=0)
    counts = counts.reindex(index=classes, columns=classes, fill_value=0).to_numpy(dtype=float)
    shares = 100 * counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    axes.imshow(shares, cmap="Blues", vmin=0, vmax=100)
    for i, j in np.argwhere(shares >= 1):
        tint = "white" if shares[i, j] >= DARK else "black"
        axes.text(j, i, f"{shares[i, j]:.0f}", ha="center", va="center", fontsize=6.5, color=tint)
    axes.set(xticks=[], yticks=[])
    axes.tick_params(length=0)
    axes.spines[:].set(visible=True, linewidth=0.6)

"""Pictures of meshes on a white page: lit surface, colour a vertex, wires and points, drawn by rays."""

from collections.abc import Iterable, Sequence
from functools import lru_cache

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from haptic_glance.look.camera import Viewpoint, pixel_rays, pixels_per_unit, project
from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.rays import RayScene, barycentric

from .style import GREY, MAP, plt

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
    seen, face, weights, light = _surface(mesh, viewpoint, side)
    base = CLAY if values is None else colour_map(np.einsum("ij,ij->i", weights, values[mesh.faces[face]]), tints)
    shaded = base * light[:, None]
    if wires:
        near = _edge_distance(mesh, face, weights) * pixels_per_unit(side)
        shaded = np.where((near < 0.4 * smoothing)[:, None], WIRE, shaded)
    image = np.ones((side * side, 3))
    image[seen] = np.clip(shaded, 0, 1)
    return image.reshape(rows, smoothing, rows, smoothing, 3).mean(axis=(1, 3))


_scene = lru_cache(maxsize=2)(RayScene)  # a mesh is drawn many times in turn, with its points and in many colours


@lru_cache(maxsize=2)
def _surface(mesh: Mesh, viewpoint: Viewpoint, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What a square picture shows: (pixels (k,), their faces (k,), the places in these (k, 3), the light (k,))."""
    size = (side, side)
    box = [slice(*np.clip((ends.min() - 1, ends.max() + 3), 0, side).astype(int))
           for ends in project(mesh.vertices, viewpoint, size)[:2]]  # fmt: skip
    down, across = np.mgrid[*box].reshape(2, -1)  # no ray beside the mesh
    origins, directions = pixel_rays(down, across, viewpoint, size)
    hits = _scene(mesh).cast(origins, directions)
    on = np.flatnonzero(hits.hit)
    face = hits.face[on]
    where = origins[on] + directions[on] * hits.distance[on, None]
    weights = np.clip(barycentric(mesh, face, where), 0, 1)
    return side * down[on] + across[on], face, weights, _light(mesh, face, weights, viewpoint)


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
    hidden = _scene(mesh).cast(start, np.broadcast_to(back, points.shape)).hit
    return project(points[~hidden & (normals @ back > 0)], viewpoint, (rows, rows))[:2]


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
    viewpoint: Viewpoint = VIEWPOINT,
    rows: int = 420,
    tints: str = MAP,
) -> None:
    """Draws a mesh into matplotlib axes, square and without frame; points (k,) vertex ids become red dots."""
    image, (top, left) = squared(picture(mesh, values, wires, viewpoint, rows, tints=tints))
    axes.imshow(image)
    if points is not None:
        down, across = visible(mesh, points, viewpoint, rows)
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

"""Pictures of a mesh coloured by saliency with its salient points, and of its faces before and after simplification."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import whole_file
from haptic_glance.base.lazy import trimesh
from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.look.views import render
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh

from .perceptual import within_frame

VIEWPOINT = Viewpoint(305, 22)  # from above and the side, as in the report
ROWS, FINER = 600, 2  # rows of a picture; drawn twice as fine and averaged
TOP = 0.98  # quantile of the values at which the colours saturate
WIRE = np.array([40, 56, 82])
DOT, RIM, INK = (216, 27, 27), (255, 255, 255), (34, 34, 34)
OUTER = 12  # pixels: radius of a dot with its rim, and one more
MARGIN, ARROW, TIP = 20, 45, 8  # pixels: of the arrow that points up
KINDS = (".jpg", ".png", ".webp")


def write_look(path: Path, mesh: Mesh, saliency: np.ndarray, points: np.ndarray) -> int:
    """Writes a picture of a mesh turned upright, with the axis that points up: its saliency (n,) and points (k,).

    Points are numbered from 1; those on the far side are not shown: how many is returned. The format follows the
    suffix of the path; ValueError for an unknown one.
    """
    check_look(path)
    with whole_file(path) as part:
        Image.fromarray(look(mesh, saliency, points)).save(
            part, format=Image.registered_extensions()[path.suffix.lower()]
        )
    return int((~visible(normalise(rotate_to_z_up(mesh)), points)).sum())


def look(mesh: Mesh, saliency: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The picture of `write_look`, (ROWS, ROWS, 3) u1."""
    upright = normalise(rotate_to_z_up(mesh))
    image = with_axis(draw(coloured(upright, saliency)), mesh.up)
    rows, columns = places(upright, points)
    for k in np.flatnonzero(visible(upright, points))[::-1]:  # the most salient last, above the others
        mark(image, round(float(columns[k])), round(float(rows[k])), str(k + 1))
    return image


def mark(image: np.ndarray, column: int, row: int, text: str) -> None:
    """Draws a dot that bears a text of a digit or two."""
    top, left = max(row - OUTER, 0), max(column - OUTER, 0)
    part = image[top : row + OUTER + 1, left : column + OUTER + 1]
    rows, columns = np.ogrid[top : top + len(part), left : left + part.shape[1]]
    distance = np.hypot(rows - row, columns - column)[..., None]
    for radius, colour in ((OUTER - 1, RIM), (OUTER - 3, DOT)):
        cover = np.clip(radius + 0.5 - distance, 0, 1)  # of each pixel by the disc: its rim is smooth
        part[:] = np.rint(cover * colour + (1 - cover) * part)
    canvas = Image.fromarray(image)
    ImageDraw.Draw(canvas).text((column, row), text, RIM, ImageFont.load_default(12), anchor="mm")
    image[:] = canvas


def check_look(path: Path) -> None:
    """Raises ValueError for a suffix that is not of KINDS."""
    if path.suffix.lower() not in KINDS:
        raise ValueError(f"{path.name}: pictures are written as {', '.join(KINDS)}")


def coloured(mesh: Mesh, values: np.ndarray) -> Mesh:
    """The mesh with colours of the values (n,), from violet to yellow, which saturate at their 98 % quantile."""
    return replace(mesh, colors=viridis(vivid(values)), texture=None)


def vivid(values: np.ndarray) -> np.ndarray:
    """The square root of values (n,) >= 0 over their 98 % quantile, at most 1.

    A density has a few high peaks, beside which everything else would be dark.
    """
    return np.sqrt(np.clip(values / (np.quantile(values, TOP) or values.max() or 1.0), 0, 1))


def viridis(values: np.ndarray) -> np.ndarray:
    """(n, 3) u1 colours of values (n,) in 0..1, from violet to yellow."""
    levels = np.rint(255 * values).astype(np.uint8)
    return _colour_scale()[levels]


@cache
def _colour_scale():
    """(256, 3) u1 colours of the levels of `viridis`."""
    return np.ascontiguousarray(trimesh.visual.color.interpolate(np.arange(256.0), "viridis")[:, :3])


def draw(mesh: Mesh, wires: bool = False) -> np.ndarray:
    """(ROWS, ROWS, 3) u1 picture of a mesh on white; wires: with the edges between visible faces."""
    side = ROWS * FINER
    view = render(mesh, VIEWPOINT, (side, side), renderer="raster", background="white")
    image = view.rgb.astype(np.float64)
    if wires:
        face = view.face
        across, down = face[:, 1:] != face[:, :-1], face[1:] != face[:-1]
        image[:, 1:][across] = WIRE
        image[1:][down] = WIRE
    return image.reshape(ROWS, FINER, ROWS, FINER, 3).mean(axis=(1, 3)).astype(np.uint8)


def with_axis(image: np.ndarray, up: str) -> np.ndarray:
    """The picture (h, w, 3) u1 with an arrow in its lower left corner that names the axis `up`."""
    foot = len(image) - MARGIN
    canvas, head = Image.fromarray(image), foot - ARROW
    pen = ImageDraw.Draw(canvas)
    pen.line([(MARGIN, foot), (MARGIN, head)], INK)
    pen.line([(MARGIN - TIP, head + TIP), (MARGIN, head), (MARGIN + TIP, head + TIP)], INK)
    pen.text((MARGIN + TIP + 2, head), up, INK, ImageFont.load_default(18), anchor="lm")
    return np.array(canvas)


def visible_points(mesh: Mesh, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rows, columns) in the picture of the visible ones of the vertices."""
    near = visible(mesh, vertices)
    rows, columns = places(mesh, vertices)
    return rows[near], columns[near]


def places(mesh: Mesh, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rows (k,), columns (k,)) in the picture of the vertices (k,)."""
    return project(mesh.vertices[vertices], VIEWPOINT, (ROWS, ROWS))[:2]


def visible(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    """(k,) boolean: which of the vertices the picture shows."""
    size = (ROWS, ROWS)
    depth = render(mesh, VIEWPOINT, size, renderer="raster").depth
    rows, columns, depths = project(mesh.vertices[vertices], VIEWPOINT, size)
    r, c = (np.clip(np.rint(place).astype(int), 0, ROWS - 1) for place in (rows, columns))
    return depths <= depth[r, c] + 0.02  # units: a point on the silhouette may miss its own surface by a pixel


def write_picture(
    path: Path, before: Mesh, after: Mesh, saliency: np.ndarray, points: np.ndarray, up: str = "z"
) -> None:
    """Writes a picture of three panels: saliency (n,) and points (k,), and the wireframes before and after.

    before, after: Meshes in the frame of haptic_glance.mesh.repair, +z up; where a coarse one exceeds it, both are
    drawn smaller; up: which axis that was before they were turned. The format follows the suffix of the path;
    ValueError for an unknown one (`check_picture`).
    """
    check_picture(path)
    (before, after), _ = within_frame([before, after])
    figure = _figure(figsize=(12, 4.4), layout="constrained")
    axes = figure.subplots(1, 3)
    axes[0].imshow(with_axis(draw(coloured(before, saliency)), up))
    rows, columns = visible_points(before, points)
    axes[0].plot(columns, rows, "o", color="#D81B1B", ms=5, mec="white", mew=0.8)
    note = f", {len(points)} point{'' if len(points) == 1 else 's'} kept" if len(points) else ""
    axes[0].set_title(f"saliency{note}")
    for panel, mesh, word in ((axes[1], before, "before"), (axes[2], after, "after")):
        panel.imshow(draw(Mesh(mesh.vertices, mesh.faces), wires=True))
        panel.set_title(f"{word}: {len(mesh.faces):,} faces")
    for panel in axes:
        panel.set_axis_off()
    with whole_file(path) as part:
        figure.savefig(part, dpi=130, format=path.suffix.lower()[1:])


def check_picture(path: Path) -> None:
    """Raises ValueError where matplotlib cannot write the format of the path's suffix."""
    kinds = _figure().canvas.get_supported_filetypes()
    if path.suffix.lower()[1:] not in kinds:
        raise ValueError(f"{path.name}: pictures are written as {', '.join(sorted(kinds))}")


def _figure(**options):
    with from_extra("the picture of a simplification is drawn by matplotlib, which "):
        from matplotlib.figure import Figure
    return Figure(**options)

"""A picture of one simplification: the saliency, and the faces before and after."""

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from stages.kit import Mesh, Viewpoint
from stages.kit.camera import project
from stages.kit.files import whole_file
from stages.views import render

from .within_frame import within_frame

VIEWPOINT = Viewpoint(305, 22)  # from above and the side, as in the report
ROWS, FINER = 600, 2  # rows of a panel; drawn twice as fine and averaged
TOP = 0.98  # quantile of the values at which the colours saturate
MAP = "viridis"
WIRE = np.array([40, 56, 82])


def write_picture(path: Path, before: Mesh, after: Mesh, saliency: np.ndarray, points: np.ndarray) -> None:
    """Writes a picture of three panels: saliency (n,) and points (k,), and the wireframes before and after.

    before, after: Meshes in the frame of stages.meshes.normalise, +z up; where a coarse one exceeds it, both are drawn
    smaller. The format follows the suffix of the path; ValueError for an unknown one (`check_picture`).
    """
    check_picture(path)
    (before, after), _ = within_frame([before, after])
    figure = Figure(figsize=(12, 4.4), layout="constrained")
    axes = figure.subplots(1, 3)
    _look(axes[0], before, saliency, points)
    kept = f", {len(points)} point{'' if len(points) == 1 else 's'} kept" if len(points) else ""
    axes[0].set_title(f"saliency{kept}")
    for panel, mesh, word in ((axes[1], before, "before"), (axes[2], after, "after")):
        panel.imshow(draw(Mesh(mesh.vertices, mesh.faces), wires=True))
        panel.set_title(f"{word}: {len(mesh.faces):,} faces")
    for panel in axes:
        panel.set_axis_off()
    with whole_file(path) as part:
        figure.savefig(part, dpi=130, format=path.suffix.lower()[1:])


def write_look(path: Path, mesh: Mesh, saliency: np.ndarray, points: np.ndarray) -> None:
    """Writes a picture of a mesh as in `write_picture`, coloured by saliency (n,), with its visible points (k,)."""
    check_picture(path)
    figure = Figure(figsize=(5, 5), layout="constrained")
    panel = figure.subplots()
    _look(panel, mesh, saliency, points)
    panel.set_axis_off()
    with whole_file(path) as part:
        figure.savefig(part, dpi=130, format=path.suffix.lower()[1:])


def _look(panel, mesh, saliency, points):
    panel.imshow(draw(coloured(mesh, saliency)))
    rows, columns = visible_points(mesh, points)
    panel.plot(columns, rows, "o", color="#D81B1B", ms=5, mec="white", mew=0.8)


def check_picture(path: Path) -> None:
    """Raises ValueError where matplotlib cannot write the format of the path's suffix."""
    kinds = Figure().canvas.get_supported_filetypes()
    if path.suffix.lower()[1:] not in kinds:
        raise ValueError(f"{path.name}: pictures are written as {', '.join(sorted(kinds))}")


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


def visible_points(mesh: Mesh, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rows, columns) in the picture of the visible ones of the vertices."""
    size = (ROWS, ROWS)
    depth = render(mesh, VIEWPOINT, size, renderer="raster").depth
    rows, columns, depths = project(mesh.vertices[vertices], VIEWPOINT, size)
    r, c = (np.clip(np.rint(place).astype(int), 0, ROWS - 1) for place in (rows, columns))
    near = depths <= depth[r, c] + 0.02  # units: a point on the silhouette may miss its own surface by a pixel
    return rows[near], columns[near]


def coloured(mesh: Mesh, values: np.ndarray) -> Mesh:
    """The mesh with colours of the values (n,), which saturate at their 98 % quantile."""
    top = np.quantile(values, TOP) or values.max() or 1.0
    colors = 255 * matplotlib.colormaps[MAP](np.clip(values / top, 0, 1))[:, :3]
    return Mesh(mesh.vertices, mesh.faces, np.rint(colors).astype(np.uint8))

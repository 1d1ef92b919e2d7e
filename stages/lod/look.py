"""A mesh as a picture, coloured by saliency, with its salient points: by what a core install has."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from stages.kit import Mesh, Viewpoint
from stages.kit.camera import project
from stages.kit.files import whole_file
from stages.meshes import normalise, rotate_to_z_up
from stages.views import render

VIEWPOINT = Viewpoint(305, 22)  # from above and the side, as in the report
ROWS, FINER = 600, 2  # rows of a picture; drawn twice as fine and averaged
TOP = 0.98  # quantile of the values at which the colours saturate
WIRE = np.array([40, 56, 82])
DOT, RIM, INK = (216, 27, 27), (255, 255, 255), (34, 34, 34)
MARGIN, ARROW = 20, 45  # pixels: of the arrow that points up
KINDS = (".jpg", ".png", ".webp")


def write_look(path: Path, mesh: Mesh, saliency: np.ndarray, points: np.ndarray) -> None:
    """Writes a picture of a mesh turned upright, with the axis that points up: its saliency (n,) and points (k,).

    Points on the far side are not shown. The format follows the suffix of the path; ValueError for an unknown one.
    """
    check_look(path)
    upright = normalise(rotate_to_z_up(mesh))
    image = with_axis(draw(coloured(upright, saliency)), mesh.up)
    for row, column in zip(*visible_points(upright, points), strict=True):
        for radius, colour in ((6, RIM), (4, DOT)):
            cv2.circle(image, (round(column), round(row)), radius, colour, cv2.FILLED, cv2.LINE_AA)
    with whole_file(path) as part:
        Image.fromarray(image).save(part, format=Image.registered_extensions()[path.suffix.lower()])


def check_look(path: Path) -> None:
    """Raises ValueError for a suffix that is not of KINDS."""
    if path.suffix.lower() not in KINDS:
        raise ValueError(f"{path.name}: pictures are written as {', '.join(KINDS)}")


def coloured(mesh: Mesh, values: np.ndarray) -> Mesh:
    """The mesh with colours of the values (n,), from violet to yellow, which saturate at their 98 % quantile."""
    top = np.quantile(values, TOP) or values.max() or 1.0
    levels = np.rint(255 * np.clip(values / top, 0, 1)).astype(np.uint8)
    colors = cv2.applyColorMap(levels[:, None], cv2.COLORMAP_VIRIDIS)[:, 0, ::-1]
    return replace(mesh, colors=np.ascontiguousarray(colors), texture=None)


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
    cv2.arrowedLine(image, (MARGIN, foot), (MARGIN, foot - ARROW), INK, 1, cv2.LINE_AA, tipLength=0.25)
    cv2.putText(image, up, (MARGIN + 8, foot - ARROW + 12), cv2.FONT_HERSHEY_SIMPLEX, 0.6, INK, 1, cv2.LINE_AA)
    return image


def visible_points(mesh: Mesh, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rows, columns) in the picture of the visible ones of the vertices."""
    size = (ROWS, ROWS)
    depth = render(mesh, VIEWPOINT, size, renderer="raster").depth
    rows, columns, depths = project(mesh.vertices[vertices], VIEWPOINT, size)
    r, c = (np.clip(np.rint(place).astype(int), 0, ROWS - 1) for place in (rows, columns))
    near = depths <= depth[r, c] + 0.02  # units: a point on the silhouette may miss its own surface by a pixel
    return rows[near], columns[near]

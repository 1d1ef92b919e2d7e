"""The ground truth saliency map of one view: a Gaussian at each visible point (T3.2.1.3)."""

from functools import lru_cache

import numpy as np

from haptic_glance.look.camera import Viewpoint, pixel_rays, project
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene

ROWS = 900  # of the thesis's images, for which the kernel size is stated
KERNEL = 50  # pixels per side at 900 rows; T3.2.1.3
SIGMA = 0.15  # of the kernel's side: 7.5 pixels at 900 rows
SAME_DEPTH = 1e-6  # units: above the rounding of a ray, far below the thinnest wall


def gts_map(rows: np.ndarray, columns: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """(h, w) f8 in 0..1: the ground truth saliency map of points at fractional pixels rows (k,), columns (k,).

    T3.2.1.3: a Gaussian kernel of 50 by 50 pixels with sigma 0.15 at each point, zero off the object (mask (h, w)
    boolean). The thesis does not state the unit of sigma. In pixels, the kernel would be a single bright pixel, not the
    "round region of saliency" of the text. As a share of the kernel's side, sigma is 7.5 pixels. At the border of the
    kernel, 25 pixels from the point, the Gaussian is then 0.0039, one grey level of 255, so that the kernel contains
    the visible part of a round region. The kernel scales with the rows of smaller maps. Where regions overlap the
    maximum is taken, so that all points are equally bright. Raises ValueError for rows and columns of different lengths
    or with NaN.
    """
    rows, columns, mask = np.asarray(rows, dtype=float), np.asarray(columns, dtype=float), np.asarray(mask, dtype=bool)
    if rows.shape != columns.shape or rows.ndim != 1 or mask.ndim != 2:
        shapes = f"{rows.shape}, {columns.shape} and {mask.shape}"
        raise ValueError(f"rows, columns and mask must be (k,), (k,) and (h, w), got {shapes}")
    if not np.isfinite([rows, columns]).all():
        raise ValueError("rows or columns hold NaN or infinite values")
    side = KERNEL * mask.shape[0] / ROWS
    values = np.zeros(mask.shape)
    for row, column in zip(rows, columns, strict=True):
        r, across = _profile(row, side, mask.shape[0])
        c, down = _profile(column, side, mask.shape[1])
        values[r, c] = np.maximum(values[r, c], across[:, None] * down)
    return np.where(mask, values, 0)


def _profile(centre, side, count):
    """The pixels of a row or column within the kernel, as a slice, and the Gaussian's values there."""
    low = int(np.clip(np.ceil(centre - side / 2), 0, count))
    high = int(np.clip(np.floor(centre + side / 2) + 1, low, count))
    return slice(low, high), np.exp(-(((np.arange(low, high) - centre) / (SIGMA * side)) ** 2) / 2)


def visible_points(
    mesh: Mesh, vertices: np.ndarray, viewpoint: Viewpoint, size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The vertices (k,) that a viewpoint sees: (rows (j,), columns (j,), indices (j,) i8 into `vertices`).

    rows and columns are fractional pixels of an image of `size` (h, w) by the thesis's camera (kit.camera). Visibility
    is exact: the ray through the vertex meets nothing in front of it. A vertex in no face is treated as a point. Raises
    ValueError for vertices that the mesh does not have.
    """
    vertices = np.asarray(vertices, dtype=np.int64)
    if vertices.ndim != 1 or ((vertices < 0) | (vertices >= len(mesh.vertices))).any():
        raise ValueError(f"vertices must be (k,) ids in 0..{len(mesh.vertices) - 1}, got {vertices}")
    rows, columns, depth = project(mesh.vertices[vertices], viewpoint, size)
    hits = _scene(mesh).cast(*pixel_rays(rows, columns, viewpoint, size))
    which = np.flatnonzero(hits.distance >= depth - SAME_DEPTH)
    return rows[which], columns[which], which


@lru_cache(maxsize=1)
def _scene(mesh):
    """The RayScene of the last mesh: building it takes most of a call, and a mesh is seen from many viewpoints."""
    return RayScene(mesh)

"""The ground truth as a saliency map of one view: a Gaussian at each visible point (T3.2.1.3)."""

from functools import lru_cache

import numpy as np

from stages.kit import RayScene
from stages.kit.camera import pixel_rays, project

ROWS = 900  # of the thesis's images, for which the kernel is stated
KERNEL = 50  # pixels a side at 900 rows; T3.2.1.3
SIGMA = 0.15  # of the kernel's side: 7.5 pixels at 900 rows
SAME_DEPTH = 1e-6  # units: the rounding of a ray, far below the thinnest wall


def gts_map(rows, columns, mask):
    """(h, w) f8 in 0..1: the ground truth saliency map of points at fractional pixels rows (k,), columns (k,).

    T3.2.1.3: a Gaussian kernel of 50 by 50 pixels with sigma 0.15 at each point, zero off the object (mask (h, w)
    boolean). The thesis does not say sigma's unit. In pixels the kernel would be one bright pixel, not the "round
    region of saliency" that it asks for. We take parts of the kernel's side: at the kernel's edge, 25 pixels off, the
    Gaussian of 7.5 pixels is then 0.0039, one grey level of 255, so the kernel is as large as the region is visible
    and the region is round. The kernel shrinks with the rows of smaller maps. Where regions meet the larger value
    holds, so that each point is as bright as a lone one. Raises ValueError for rows and columns that differ in length
    or hold NaN.
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


def visible_points(mesh, vertices, viewpoint, size):
    """(rows (j,), columns (j,), which (j,) i8) of the vertices (k,) that a viewpoint sees; which indexes `vertices`.

    rows and columns are fractional pixels of an image of `size` (h, w) by the thesis's camera (kit.camera). A vertex is
    seen when the ray through it meets nothing before it, exactly: not the nearest pixel, not the facing of its normal.
    A vertex in no face is seen as a point would be. Raises ValueError for vertices that the mesh does not have.
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
    """The rays' scene of the last mesh: making it takes most of a call, and one mesh is looked at from many sides."""
    return RayScene(mesh)

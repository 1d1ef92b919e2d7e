"""The faces of a mesh sorted into the cells of a grid, compiled by numba."""

import numpy as np

from .face_frame import NUMBERS, set_planes
from .jit import allocating_kernel


@allocating_kernel
def bounding_box(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner of the box around all faces."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for f in range(len(faces)):
        for corner in range(3):
            for axis in range(3):
                value = vertices[faces[f, corner], axis]
                low[axis], high[axis] = min(low[axis], value), max(high[axis], value)
    return low, high


@allocating_kernel
def planes_of(vertices: np.ndarray, faces: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The planes (m, 16) of all faces, relative to the corner `low`, and twice their areas (m,)."""
    planes, areas = np.empty((len(faces), NUMBERS)), np.empty(len(faces))
    for f in range(len(faces)):
        areas[f] = set_planes(vertices, faces[f, 0], faces[f, 1], faces[f, 2], low, planes, f)
    return planes, areas


@allocating_kernel
def cell_boxes(
    vertices: np.ndarray, faces: np.ndarray, low: np.ndarray, cell: float, shape: np.ndarray
) -> tuple[np.ndarray, int]:
    """(m, 6) i4 first and last cell of each face along the axes, and the number of cells in all these boxes."""
    boxes, per_unit, total = np.empty((len(faces), 6), dtype=np.int32), 1 / cell, 0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        cells = 1
        for axis in range(3):
            p, q, r = vertices[a, axis], vertices[b, axis], vertices[c, axis]
            first = int((min(p, q, r) - low[axis]) * per_unit)
            last = min(int((max(p, q, r) - low[axis]) * per_unit), shape[axis] - 1)
            boxes[f, axis], boxes[f, axis + 3] = first, last
            cells *= last - first + 1
        total += cells
    return boxes, total


@allocating_kernel
def fill_cells(boxes: np.ndarray, total: int, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(start of each cell's faces, and one more at the end; the faces, cell by cell)."""
    sx, sy = shape[0], shape[1]
    starts = np.zeros(sx * sy * shape[2] + 2, dtype=np.int32)
    for f in range(len(boxes)):
        for z in range(boxes[f, 2], boxes[f, 5] + 1):
            for y in range(boxes[f, 1], boxes[f, 4] + 1):
                row = (z * sy + y) * sx + 2
                for x in range(row + boxes[f, 0], row + boxes[f, 3] + 1):
                    starts[x] += 1
    for k in range(1, len(starts)):
        starts[k] += starts[k - 1]
    entries = np.empty(total, dtype=np.int32)
    for f in range(len(boxes)):
        for z in range(boxes[f, 2], boxes[f, 5] + 1):
            for y in range(boxes[f, 1], boxes[f, 4] + 1):
                row = (z * sy + y) * sx + 1
                for x in range(row + boxes[f, 0], row + boxes[f, 3] + 1):
                    entries[starts[x]] = f
                    starts[x] += 1
    return starts[:-1], entries

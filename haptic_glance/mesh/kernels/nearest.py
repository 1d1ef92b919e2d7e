"""The nearest point on a surface: faces sorted into the cells of a grid, and the search in it, compiled by numba."""

import math

import numpy as np

from haptic_glance.base.jit import greater, helper, lesser

from .planes import NUMBERS, bound_to, kernel, set_planes, square_to

# Grid: starts and entries of the cells (see fill_cells), lower corner, width and counts of the cells.
Grid = tuple[np.ndarray, np.ndarray, np.ndarray, float, np.ndarray]
EQUAL = 1 + 1e-9  # smaller ratios are rounding


@helper
def _clipped(place, cells):
    """The cell at a position along an axis, or the nearest one."""
    return int(place) if 0.0 <= place < cells else (0 if place < 0.0 else cells - 1)


@helper
def _nearest_in_cell(x, y, z, first, last, low, vertices, faces, entries, planes, enough):
    """(squared distance, face) of the nearest face in one cell; face -1 in an empty one.

    All bounds are computed without a branch, and the face of the smallest is measured: mispredicted branches took
    longer than all arithmetic. A face whose squared distance is at most `enough` ends the search.
    """
    px, py, pz = x - low[0], y - low[1], z - low[2]
    least, second, face = np.inf, np.inf, np.int64(-1)
    for e in range(first, last):
        candidate = np.int64(entries[e])  # as `face`: each further type compiles the callees once more
        bound = bound_to(planes, candidate, px, py, pz)
        if bound <= enough:
            square = square_to(vertices, faces, planes, candidate, x, y, z)
            if square <= enough:
                return square, candidate
        face = candidate if bound < least else face
        larger = bound if bound > least else least
        second = larger if larger < second else second
        least = bound if bound < least else least
    best = np.inf
    if face >= 0:
        best = square_to(vertices, faces, planes, face, x, y, z)
        if best > second * EQUAL:  # the nearest point is a corner: another face may be nearer
            for e in range(first, last):
                candidate = np.int64(entries[e])
                if bound_to(planes, candidate, px, py, pz) < best:
                    square = square_to(vertices, faces, planes, candidate, x, y, z)
                    if square < best:
                        best, face = square, candidate
    return best, face


@helper
def _search_one(points, i, vertices, faces, starts, entries, low, cell, shape, planes, enough, far):
    """(squared distance, face, whether it is the nearest) of one point: in its cell, then in ever wider boxes of cells.

    A face in several cells is bounded again, which is cheaper than remembering it.
    """
    x, y, z = points[i, 0], points[i, 1], points[i, 2]
    px, py, pz, per_unit = x - low[0], y - low[1], z - low[2], 1 / cell
    gx, gy, gz = px * per_unit, py * per_unit, pz * per_unit
    x0, y0, z0 = _clipped(gx, shape[0]), _clipped(gy, shape[1]), _clipped(gz, shape[2])
    home = (z0 * shape[1] + y0) * shape[0] + x0
    best, face = _nearest_in_cell(
        x, y, z, starts[home], starts[home + 1], low, vertices, faces, entries, planes, enough
    )
    needed = math.sqrt(best) * per_unit
    sure = gx - needed >= x0 and gx + needed < x0 + 1 and gy - needed >= y0 and gy + needed < y0 + 1
    sure = (sure and gz - needed >= z0 and gz + needed < z0 + 1) or best <= enough
    limit = 1.0
    while not sure and limit <= far:
        radius = lesser(needed, limit)
        x0, x1 = _clipped(gx - radius, shape[0]), _clipped(gx + radius, shape[0])
        y0, y1 = _clipped(gy - radius, shape[1]), _clipped(gy + radius, shape[1])
        z0, z1 = _clipped(gz - radius, shape[2]), _clipped(gz + radius, shape[2])
        for layer in range(z0, z1 + 1):
            up = greater(greater(layer - gz, gz - layer - 1), 0.0)
            for column in range(y0, y1 + 1):
                aside = greater(greater(column - gy, gy - column - 1), 0.0)
                if (up * up + aside * aside) * cell * cell > best:
                    continue
                row = layer * shape[1] + column
                for e in range(starts[row * shape[0] + x0], starts[row * shape[0] + x1 + 1]):
                    candidate = np.int64(entries[e])
                    if bound_to(planes, candidate, px, py, pz) < best:
                        square = square_to(vertices, faces, planes, candidate, x, y, z)
                        if square < best:
                            best, face = square, candidate
                            if best <= enough:
                                return best, face, True
        sure = needed <= limit or best * (per_unit * per_unit) <= radius * radius
        needed = math.sqrt(best) * per_unit
        limit *= 2
    return best, face, sure


def search(
    points: np.ndarray, vertices: np.ndarray, faces: np.ndarray, grid: Grid, planes: np.ndarray, far: float
) -> tuple[np.ndarray, np.ndarray]:
    """(squared distances (k,), faces (k,)) of the nearest faces; face -1 where all are more than `far` cells away."""
    squares, ids = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
    _search(points, vertices, faces, *grid, planes, far, squares, ids)
    return squares, ids


@kernel
def _search(points, vertices, faces, starts, entries, low, cell, shape, planes, far, squares, ids):
    """Fills what `search` returns."""
    for i in range(len(points)):
        best, face, sure = _search_one(points, i, vertices, faces, starts, entries, low, cell, shape, planes, -1.0, far)
        squares[i], ids[i] = best, face if sure else -1


def farthest(
    points: np.ndarray,
    corners: np.ndarray,
    vertices: np.ndarray,
    faces: np.ndarray,
    grid: Grid,
    planes: np.ndarray,
    square: float,
    far: float,
) -> tuple[float, np.ndarray]:
    """(largest squared distance of the corners (m, 3) among the points, at least `square`; ids of those not searched).

    Not searched are points more than `far` cells away.
    """
    visited, away = np.zeros(len(points), dtype=np.bool_), np.empty(len(points), dtype=np.int64)
    square, count = _farthest(points, corners, vertices, faces, *grid, planes, square, far, visited, away)
    return square, away[:count]


@kernel
def _farthest(points, corners, vertices, faces, starts, entries, low, cell, shape, planes, square, far, visited, away):
    """`farthest`, but for the number of `away` in the place of those ids. visited: no point yet."""
    count = 0
    for f in range(len(corners)):
        for corner in range(3):
            v = corners[f, corner]
            if visited[v]:
                continue
            visited[v] = True
            best, _, sure = _search_one(
                points, v, vertices, faces, starts, entries, low, cell, shape, planes, square, far
            )
            if not sure:
                away[count] = v
                count += 1
            elif best > square:
                square = best
    return square, count


def planes_of(vertices: np.ndarray, faces: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The planes (m, 16) of all faces, relative to the corner `low`, and twice their areas (m,)."""
    planes, areas = np.empty((len(faces), NUMBERS)), np.empty(len(faces))
    _fill_planes(vertices, faces, low, planes, areas)
    return planes, areas


@kernel
def _fill_planes(vertices, faces, low, planes, areas):
    """Fills what `planes_of` returns."""
    for f in range(len(faces)):
        areas[f] = set_planes(vertices, faces[f, 0], faces[f, 1], faces[f, 2], low, planes, f)


def cell_boxes(
    vertices: np.ndarray, faces: np.ndarray, low: np.ndarray, cell: float, shape: np.ndarray
) -> tuple[np.ndarray, int]:
    """(m, 6) i4 first and last cell of each face along the axes, and the number of cells in all these boxes."""
    boxes = np.empty((len(faces), 6), dtype=np.int32)
    return boxes, _fill_boxes(vertices, faces, low, 1 / cell, shape, boxes)


@kernel
def _fill_boxes(vertices, faces, low, per_unit, shape, boxes):
    """Fills the boxes of `cell_boxes`, and returns the number of cells."""
    total = 0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        cells = 1
        for axis in range(3):
            p, q, r = vertices[a, axis], vertices[b, axis], vertices[c, axis]
            first = _clipped((lesser(lesser(p, q), r) - low[axis]) * per_unit, shape[axis])
            last = greater(_clipped((greater(greater(p, q), r) - low[axis]) * per_unit, shape[axis]), first)
            boxes[f, axis], boxes[f, axis + 3] = first, last
            cells *= last - first + 1
        total += cells
    return total


def fill_cells(boxes: np.ndarray, total: int, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(start of each cell's faces, and one more at the end; the faces, cell by cell)."""
    starts, entries = np.zeros(shape.prod() + 2, dtype=np.int32), np.empty(total, dtype=np.int32)
    _sort_into_cells(boxes, shape, starts, entries)
    return starts[:-1], entries


@kernel
def _sort_into_cells(boxes, shape, starts, entries):
    """Fills what `fill_cells` returns. starts: zeros, one more than are needed."""
    sx, sy = shape[0], shape[1]
    for f in range(len(boxes)):
        for z in range(boxes[f, 2], boxes[f, 5] + 1):
            for y in range(boxes[f, 1], boxes[f, 4] + 1):
                row = (z * sy + y) * sx + 2
                for x in range(row + boxes[f, 0], row + boxes[f, 3] + 1):
                    starts[x] += 1
    for k in range(1, len(starts)):
        starts[k] += starts[k - 1]
    for f in range(len(boxes)):
        for z in range(boxes[f, 2], boxes[f, 5] + 1):
            for y in range(boxes[f, 1], boxes[f, 4] + 1):
                row = (z * sy + y) * sx + 1
                for x in range(row + boxes[f, 0], row + boxes[f, 3] + 1):
                    entries[starts[x]] = f
                    starts[x] += 1

"""The faces of a mesh in a grid of cells, and the search in it, compiled by numba."""

import math

import numpy as np

from .face_frame import set_frame, square_to
from .jit import inlined, kernel

NEAR = 0.5  # cells: an answer that near is made sure of at once


@kernel
def bounding_box(vertices, faces):
    """Lower and upper corner of the box around all faces."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for f in range(len(faces)):
        for corner in range(3):
            for axis in range(3):
                value = vertices[faces[f, corner], axis]
                low[axis], high[axis] = min(low[axis], value), max(high[axis], value)
    return low, high


@kernel
def fill_cells(vertices, faces, low, cell, shape, frames):
    """Fills the frames; returns where each cell's faces begin, and the faces, cell by cell."""
    m, sx, sy = len(faces), shape[0], shape[1]
    box = np.empty((m, 6), dtype=np.int32)
    starts = np.zeros(sx * sy * shape[2] + 2, dtype=np.int32)
    for f in range(m):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        set_frame(vertices, a, b, c, frames, f)
        for axis in range(3):
            p, q, r = vertices[a, axis], vertices[b, axis], vertices[c, axis]
            box[f, axis] = int((min(p, q, r) - low[axis]) / cell)
            box[f, axis + 3] = min(int((max(p, q, r) - low[axis]) / cell), shape[axis] - 1)
        for z in range(box[f, 2], box[f, 5] + 1):
            for y in range(box[f, 1], box[f, 4] + 1):
                row = (z * sy + y) * sx + 2
                for x in range(row + box[f, 0], row + box[f, 3] + 1):
                    starts[x] += 1
    for k in range(1, len(starts)):
        starts[k] += starts[k - 1]
    entries = np.empty(starts[-1], dtype=np.int32)
    for f in range(m):
        for z in range(box[f, 2], box[f, 5] + 1):
            for y in range(box[f, 1], box[f, 4] + 1):
                row = (z * sy + y) * sx + 1
                for x in range(row + box[f, 0], row + box[f, 3] + 1):
                    entries[starts[x]] = f
                    starts[x] += 1
    return starts[:-1], entries


@inlined
def clipped(place, cells):
    """The cell, from the first to the last, that is at a place along an axis or nearest to it."""
    return int(place) if 0.0 <= place < cells else (0 if place < 0.0 else cells - 1)


@inlined
def search_one(points, i, face, seen, mark, starts, entries, low, per_unit, shape, frames, enough, far):
    """(squared distance, face, True where it is the nearest) of one point; begins at `face`, the last one's answer."""
    x, y, z = points[i, 0], points[i, 1], points[i, 2]
    gx, gy, gz = (x - low[0]) * per_unit, (y - low[1]) * per_unit, (z - low[2]) * per_unit
    best = square_to(frames, face, x, y, z, np.inf)
    reach = math.sqrt(best) * per_unit
    reach = reach if reach < NEAR else 0.0
    sure = best <= enough
    seen[face] = mark
    while not sure and reach <= far:
        wanted = math.sqrt(best) * per_unit
        radius = min(wanted, reach)
        x0, x1 = clipped(gx - radius, shape[0]), clipped(gx + radius, shape[0])
        y0, y1 = clipped(gy - radius, shape[1]), clipped(gy + radius, shape[1])
        z0, z1 = clipped(gz - radius, shape[2]), clipped(gz + radius, shape[2])
        for layer in range(z0, z1 + 1):
            for row in range(layer * shape[1] + y0, layer * shape[1] + y1 + 1):
                for e in range(starts[row * shape[0] + x0], starts[row * shape[0] + x1 + 1]):
                    f = entries[e]
                    if seen[f] != mark:
                        seen[f] = mark
                        square = square_to(frames, f, x, y, z, best)
                        if square < best:
                            best, face = square, f
                            if best <= enough:
                                return best, face, True
        sure = wanted <= reach or best * per_unit**2 <= radius**2
        reach = max(2 * reach, 1.0)  # first the point's own cell, then wider, until nothing nearer can be outside
    return best, face, sure


@kernel
def search(points, grid, frames, far):
    """(squared distances (k,), faces (k,)) of the nearest faces; face -1 where all are more than `far` cells away.

    grid: starts and entries (see fill_cells), lower corner, width and counts of the cells.
    """
    starts, entries, low, cell, shape = grid
    squares, found = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
    seen = np.full(len(frames), -1, dtype=np.int64)  # the last point that looked at each face
    face = 0
    for i in range(len(points)):
        best, face, sure = search_one(
            points, i, face, seen, i, starts, entries, low, 1 / cell, shape, frames, -1.0, far
        )
        squares[i], found[i] = best, face if sure else -1
    return squares, found


@kernel
def farthest(vertices, faces, grid, frames, square, far):
    """(largest squared distance of a vertex, at least `square`, vertices more than `far` cells away)."""
    starts, entries, low, cell, shape = grid
    done, seen = np.zeros(len(vertices), dtype=np.bool_), np.full(len(frames), -1, dtype=np.int64)
    away = np.empty(len(vertices), dtype=np.int64)
    face, count = 0, 0
    for f in range(len(faces)):
        for corner in range(3):
            v = faces[f, corner]
            if done[v]:
                continue
            done[v] = True
            best, face, sure = search_one(
                vertices, v, face, seen, v, starts, entries, low, 1 / cell, shape, frames, square, far
            )
            if not sure:
                away[count] = v
                count += 1
            elif best > square:
                square = best
    return square, away[:count]


@kernel
def sample(vertices, faces, total, draws):
    """(points (k, 3), faces (k,), weights (k, 3)): one place in each of k equal slices of total (m,), areas summed up.

    draws (3, k), 0 to 1: where in its slice, and where in its face (Osada et al. 2002, eq. 1).
    """
    count = draws.shape[1]
    points, owners, weights = np.empty((count, 3)), np.empty(count, dtype=np.int64), np.empty((count, 3))
    f = 0
    for i in range(count):
        at = (i + draws[0, i]) / count * total[-1]
        while f < len(total) - 1 and total[f] <= at:
            f += 1
        root = math.sqrt(draws[1, i])
        weights[i, 0], weights[i, 1], weights[i, 2] = 1 - root, root * (1 - draws[2, i]), root * draws[2, i]
        owners[i] = f
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        for axis in range(3):
            one, two, three = vertices[a, axis], vertices[b, axis], vertices[c, axis]
            points[i, axis] = weights[i, 0] * one + weights[i, 1] * two + weights[i, 2] * three
    return points, owners, weights

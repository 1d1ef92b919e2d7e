"""The search for the nearest face in a grid of cells, compiled by numba."""

import math

import numpy as np

from .face_frame import bound_to, square_to
from .jit import inlined, kernel

ALIKE = 1 + 1e-9  # what differs by less is rounding


@inlined
def clipped(place, cells):
    """The cell, from the first to the last, that is at a place along an axis or nearest to it."""
    return int(place) if 0.0 <= place < cells else (0 if place < 0.0 else cells - 1)


@inlined
def nearest_in_cell(x, y, z, first, last, low, vertices, faces, entries, planes, enough):
    """(squared distance, face) of the nearest of the entries of one cell; the face -1 where it has none.

    The bounds of all are taken without a branch, and the face of the least is measured: guesses of the processor that
    go wrong took longer than all arithmetic. A face that is near `enough` ends it at once.
    """
    px, py, pz = x - low[0], y - low[1], z - low[2]
    least, second, face = np.inf, np.inf, -1
    for e in range(first, last):
        bound = bound_to(planes, entries[e], px, py, pz)
        if bound <= enough:
            square = square_to(vertices, faces, planes, entries[e], x, y, z)
            if square <= enough:
                return square, entries[e]
        face = entries[e] if bound < least else face
        larger = bound if bound > least else least
        second = larger if larger < second else second
        least = bound if bound < least else least
    best = np.inf
    if face >= 0:
        best = square_to(vertices, faces, planes, face, x, y, z)
        if best > second * ALIKE:  # the nearest place is a corner: another face may be nearer than this one
            for e in range(first, last):
                if bound_to(planes, entries[e], px, py, pz) < best:
                    square = square_to(vertices, faces, planes, entries[e], x, y, z)
                    if square < best:
                        best, face = square, entries[e]
    return best, face


@inlined
def search_one(points, i, vertices, faces, starts, entries, low, cell, shape, planes, enough, far):
    """(squared distance, face, True where it is the nearest) of one point: in its cell, then in wider boxes of cells.

    A face in several cells is bounded again: what is known by then passes it over, which is cheaper than a memory.
    """
    x, y, z = points[i, 0], points[i, 1], points[i, 2]
    px, py, pz, per_unit = x - low[0], y - low[1], z - low[2], 1 / cell
    gx, gy, gz = px * per_unit, py * per_unit, pz * per_unit
    x0, y0, z0 = clipped(gx, shape[0]), clipped(gy, shape[1]), clipped(gz, shape[2])
    own = (z0 * shape[1] + y0) * shape[0] + x0
    best, face = nearest_in_cell(x, y, z, starts[own], starts[own + 1], low, vertices, faces, entries, planes, enough)
    wanted = math.sqrt(best) * per_unit
    sure = gx - wanted >= x0 and gx + wanted < x0 + 1 and gy - wanted >= y0 and gy + wanted < y0 + 1
    sure = (sure and gz - wanted >= z0 and gz + wanted < z0 + 1) or best <= enough
    reach = 1.0
    while not sure and reach <= far:
        radius = min(wanted, reach)
        x0, x1 = clipped(gx - radius, shape[0]), clipped(gx + radius, shape[0])
        y0, y1 = clipped(gy - radius, shape[1]), clipped(gy + radius, shape[1])
        z0, z1 = clipped(gz - radius, shape[2]), clipped(gz + radius, shape[2])
        for layer in range(z0, z1 + 1):
            up = max(layer - gz, gz - layer - 1, 0.0)
            for column in range(y0, y1 + 1):
                aside = max(column - gy, gy - column - 1, 0.0)
                if (up * up + aside * aside) * cell * cell > best:
                    continue
                row = layer * shape[1] + column
                for e in range(starts[row * shape[0] + x0], starts[row * shape[0] + x1 + 1]):
                    if bound_to(planes, entries[e], px, py, pz) < best:
                        square = square_to(vertices, faces, planes, entries[e], x, y, z)
                        if square < best:
                            best, face = square, entries[e]
                            if best <= enough:
                                return best, face, True
        sure = wanted <= reach or best * per_unit**2 <= radius**2
        wanted = math.sqrt(best) * per_unit
        reach *= 2
    return best, face, sure


@kernel
def search(points, vertices, faces, grid, planes, far):
    """(squared distances (k,), faces (k,)) of the nearest faces; face -1 where all are more than `far` cells away.

    grid: starts and entries (see fill_cells), lower corner, width and counts of the cells.
    """
    starts, entries, low, cell, shape = grid
    squares, found = np.empty(len(points)), np.empty(len(points), dtype=np.int64)
    for i in range(len(points)):
        best, face, sure = search_one(points, i, vertices, faces, starts, entries, low, cell, shape, planes, -1.0, far)
        squares[i], found[i] = best, face if sure else -1
    return squares, found


@kernel
def farthest(points, corners, vertices, faces, grid, planes, square, far):
    """(largest squared distance of a point that is a corner, at least `square`; those more than `far` cells away)."""
    starts, entries, low, cell, shape = grid
    done = np.zeros(len(points), dtype=np.bool_)
    away = np.empty(len(points), dtype=np.int64)
    count = 0
    for f in range(len(corners)):
        for corner in range(3):
            v = corners[f, corner]
            if done[v]:
                continue
            done[v] = True
            best, _, sure = search_one(
                points, v, vertices, faces, starts, entries, low, cell, shape, planes, square, far
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

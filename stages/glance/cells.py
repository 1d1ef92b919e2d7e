"""Faces cut along the walls of a grid, so that each piece lies in one cell; compiled by numba."""

import math

import numpy as np

from stages.kit.jit import helper, kernel_of

kernel = kernel_of(__file__)
CORNERS, DEPTH = 24, 96  # a triangle that six walls have cut has nine corners; halving 2^30 cells along three axes
ROUNDING = 1e-9  # in units of a cell: what lies this near to a wall lies on it


@kernel
def cut(corners: np.ndarray) -> np.ndarray:
    """(p, 8) face, cell (3), area and centroid (3) of the pieces of triangles (m, 3, 3).

    The walls are the planes on which a coordinate is a whole number.
    """
    rows = np.empty((4 * len(corners) + 64, 8))
    stack, counts, cell = np.empty((DEPTH, CORNERS, 3)), np.empty(DEPTH, dtype=np.int64), np.empty(3, dtype=np.int64)
    found = 0
    for f in range(len(corners)):
        counts[0], top = 3, 0
        for i in range(3):
            for k in range(3):
                stack[0, i, k] = corners[f, i, k]
        while top >= 0:
            count, axis, wall = counts[top], -1, 0
            for k in range(3):
                low, high = stack[top, 0, k], stack[top, 0, k]
                for i in range(1, count):
                    low, high = min(low, stack[top, i, k]), max(high, stack[top, i, k])
                cell[k] = math.floor(low + ROUNDING)
                last = math.ceil(high - ROUNDING) - 1
                if last > cell[k]:
                    axis, wall = k, (cell[k] + last + 1) // 2
                    break
            if axis >= 0:
                counts[top], counts[top + 1] = _halve(stack, top, count, axis, wall)
                top += 1
                continue
            if found == len(rows):
                more = np.empty((2 * found, 8))
                more[:found] = rows
                rows = more
            rows[found, 0] = f
            for k in range(3):
                rows[found, 1 + k] = cell[k]
            _moments(stack, top, count, rows, found)
            found, top = found + 1, top - 1
    return rows[:found]


@helper
def _halve(stack, top, count, axis, wall):
    """Counts of corners (below, above) the wall: what is above goes on the stack, what is below stays at its place."""
    below, above = 0, 0
    for i in range(count):
        j = (i + 1) % count
        here, there = stack[top, i, axis] - wall, stack[top, j, axis] - wall
        for k in range(3):
            if here <= 0:
                stack[top + 2, below, k] = stack[top, i, k]
            if here >= 0:
                stack[top + 1, above, k] = stack[top, i, k]
        below, above = below + (here <= 0), above + (here >= 0)
        if here * there < 0:
            for k in range(3):
                at = stack[top, i, k] + (stack[top, j, k] - stack[top, i, k]) * (here / (here - there))
                at = wall if k == axis else at
                stack[top + 2, below, k], stack[top + 1, above, k] = at, at
            below, above = below + 1, above + 1
    for i in range(below):
        for k in range(3):
            stack[top, i, k] = stack[top + 2, i, k]
    return below, above


@helper
def _moments(stack, top, count, rows, row):
    """Writes the area and the centroid of a convex polygon into a row."""
    for k in range(4):
        rows[row, 4 + k] = 0
    x, y, z = stack[top, 0, 0], stack[top, 0, 1], stack[top, 0, 2]
    for i in range(1, count - 1):
        ux, uy, uz = stack[top, i, 0] - x, stack[top, i, 1] - y, stack[top, i, 2] - z
        vx, vy, vz = stack[top, i + 1, 0] - x, stack[top, i + 1, 1] - y, stack[top, i + 1, 2] - z
        area = math.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2) / 2
        rows[row, 4] += area
        for k in range(3):
            rows[row, 5 + k] += area * (stack[top, 0, k] + stack[top, i, k] + stack[top, i + 1, k]) / 3
    for k in range(3):
        rows[row, 5 + k] /= max(rows[row, 4], 1e-300)

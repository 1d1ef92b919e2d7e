"""Compiled kernels of the glance: faces cut into the cells of a grid, and the visibility of points.

Visibility counts the directions from which a point is seen, and how much the surface faces these directions.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from haptic_glance.base.jit import cached_njit, greater, helper, lesser

if TYPE_CHECKING:
    from .samples import Samples

kernel = cached_njit()
CORNERS, DEPTH = 24, 96  # a triangle that six walls have cut has nine corners; halving 2^30 cells along three axes
ROUNDING = 1e-5  # in units of a cell: what lies this near to a wall lies on it


def cut(corners: np.ndarray) -> np.ndarray:
    """(p, 8) face, cell (3), area and centroid (3) of the pieces of triangles (m, 3, 3).

    The walls are the planes on which a coordinate is a whole number.
    """
    rows = np.empty((4 * len(corners) + 64, 8))
    scratch = np.empty((DEPTH, CORNERS, 3)), np.empty(DEPTH, dtype=np.int64), np.empty(3, dtype=np.int64)
    face, filled = _cut(corners, 0, rows, 0, *scratch)
    while face < len(corners):
        rows = np.concatenate([rows, np.empty_like(rows)])
        face, filled = _cut(corners, face, rows, filled, *scratch)
    return rows[:filled]


@kernel
def _cut(corners, face, rows, filled, stack, counts, cell):
    """Fills the rows from row `filled` on with the pieces of the triangles from `face` on.

    Returns (the first triangle whose pieces no longer fit, the number of rows). stack, counts, cell: scratch.
    """
    for f in range(face, len(corners)):
        begun, counts[0], top = filled, 3, np.int64(0)  # numba compiles what `top` is passed to anew for a plain 0
        for i in range(3):
            for k in range(3):
                stack[0, i, k] = corners[f, i, k]
        while top >= 0:
            count, axis, wall = counts[top], -1, 0
            for k in range(3):
                low, high = stack[top, 0, k], stack[top, 0, k]
                for i in range(1, count):
                    low, high = lesser(low, stack[top, i, k]), greater(high, stack[top, i, k])
                cell[k] = math.floor(low + ROUNDING)
                last = math.ceil(high - ROUNDING) - 1
                if last > cell[k]:
                    axis, wall = k, (cell[k] + last + 1) // 2
                    break
            if axis >= 0:
                counts[top], counts[top + 1] = _halve(stack, top, count, axis, wall)
                top += 1
                continue
            if filled == len(rows):
                return f, begun
            rows[filled, 0] = f
            for k in range(3):
                rows[filled, 1 + k] = cell[k]
            _moments(stack, top, count, rows, filled)
            filled, top = filled + 1, top - 1
    return len(corners), filled


@helper
def _halve(stack, top, count, axis, wall):
    """Counts of corners (below, above) the wall: what is above goes on the stack, what is below stays at its place."""
    below, above = 0, 0
    for i in range(count):
        j = (i + 1) % count
        start, end = stack[top, i, axis] - wall, stack[top, j, axis] - wall
        for k in range(3):
            if start <= 0:
                stack[top + 2, below, k] = stack[top, i, k]
            if start >= 0:
                stack[top + 1, above, k] = stack[top, i, k]
        below, above = below + (start <= 0), above + (start >= 0)
        if start * end < 0:
            for k in range(3):
                at = stack[top, i, k] + (stack[top, j, k] - stack[top, i, k]) * (start / (start - end))
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


HEIGHTS, AROUND = 7, 16  # rings of directions, and directions in a ring
SIDE = 0.5  # |z| of a direction from the side: 30 degrees above or below the horizon
PIXEL = 1.4  # side of a pixel in units of the spacing, so that the points leave no holes
FARTHEST = 1000  # pixels from the middle of a picture: 23 for a ball, 430 for a wire of 1 mm and 50 cm
NEAR, FAR = 1.8, 2.6  # of the spacing, more on slopes: what is less far behind is the same surface, else it is hidden
EDGE_ON = 1e-9  # cosine up to which a face is seen edge-on and hence not seen, whatever the rounding
STEEP = 0.05  # cosine at which a slope counts as no steeper


def visibility(samples: "Samples") -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(share of directions that see a point, how much it faces those from the side, from above, from below), each (s,).

    A depth picture of the points is drawn from each direction, without a mesh. The directions belong to the object's
    own axes and lie alike on both sides of its upright planes.
    """
    eyes = _directions()
    right = np.cross(eyes, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    pictures = np.stack([right, np.cross(eyes, right), eyes], axis=1) @ samples.axes
    group = np.digitize(eyes[:, 2], [-SIDE, SIDE])
    places = (samples.points - samples.middle) / samples.spacing
    radius = np.sqrt((places**2).sum(axis=1).max(initial=0))
    places /= max(radius / (FARTHEST * PIXEL), 1)  # a stray part far away would make pictures of any size
    count, width = len(places), 2 * int(min(radius / PIXEL, FARTHEST)) + 5
    sums, scratch = np.zeros((4, count)), (np.empty((count, 2), dtype=np.int64), np.empty(count))
    _seen(places, samples.normals, pictures, group, sums, np.empty((width, width)), *scratch)
    sums[:3] /= np.bincount(group)[:, None]
    below, side, above, visible = sums
    return visible / len(eyes), side, above, below


def _directions():
    """(HEIGHTS * AROUND, 3) unit vectors: rings with equal shares of the sphere, every other one turned half a step."""
    height, k = np.meshgrid(1 - (2 * np.arange(HEIGHTS) + 1) / HEIGHTS, np.arange(AROUND), indexing="ij")
    turn = 2 * np.pi / AROUND * (k + np.arange(HEIGHTS)[:, None] % 2 / 2)
    across = np.sqrt(1 - height**2)
    return np.stack([np.cos(turn) * across, np.sin(turn) * across, height], axis=2).reshape(-1, 3)


@kernel
def _seen(places, normals, pictures, group, sums, depth, pixels, near):
    """Adds the cosine of normal and direction to sums (4, s) where the direction sees the point, and counts directions.

    The sums are over the directions of each of three groups; pictures (d, 3, 3) look along their third row. depth: a
    picture, as wide as it is high; pixels (s, 2), near (s,): scratch.
    """
    count, half = len(places), len(depth) // 2
    for d in range(len(pictures)):
        for row in range(len(depth)):
            for column in range(len(depth)):
                depth[row, column] = -np.inf
        ex, ey, ez = pictures[d, 2, 0], pictures[d, 2, 1], pictures[d, 2, 2]
        for i in range(count):
            x, y, z = places[i, 0], places[i, 1], places[i, 2]
            for k in range(2):
                at = pictures[d, k, 0] * x + pictures[d, k, 1] * y + pictures[d, k, 2] * z
                pixels[i, k] = half + math.floor(at / PIXEL + 0.5)
            near[i] = ex * x + ey * y + ez * z
            row, column = pixels[i, 0], pixels[i, 1]
            depth[row, column] = greater(depth[row, column], near[i])
        for i in range(count):
            cosine = ex * normals[i, 0] + ey * normals[i, 1] + ez * normals[i, 2]
            if cosine > EDGE_ON:
                front = near[i]
                for row in range(pixels[i, 0] - 1, pixels[i, 0] + 2):
                    for column in range(pixels[i, 1] - 1, pixels[i, 1] + 2):
                        front = greater(front, depth[row, column])
                share = (FAR - (front - near[i]) * greater(cosine, STEEP)) / (FAR - NEAR)
                share = lesser(greater(share, 0.0), 1.0)
                sums[group[d], i] += share * cosine
                sums[3, i] += share

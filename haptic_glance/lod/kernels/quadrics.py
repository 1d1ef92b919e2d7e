"""Quadrics of position and attributes.

The error of a position is the sum of squared distances to planes, weighted by area (Garland and Heckbert 1997,
T [222]). The error of attributes is the disagreement of the faces around a vertex (Hoppe 1999). Each face predicts an
attribute anywhere in space, as a gradient and a constant: g.x + d. At a merged vertex the best single value is the mean
of the predictions, and their squared distances to it are the error. It is quadratic in x, and zero where the attribute
is linear over the surface. A seam splits the faces around a vertex into wedges, each with a value of its own; edges of
a seam collapse wedge by wedge (section 4.2 there).
"""

from typing import NamedTuple

import numpy as np

from haptic_glance.base.jit import greater

from .mesh import after
from .vectors import Id, between, cross, dot, helper, kernel, point

PULL = 1e-6  # weight of the distance to the point itself relative to the plane: on a flat region it alone decides
MAX_SHIFT = 2.0  # of the optimum from the edge's midpoint, in lengths of the edge


def vertex_quadrics(position: np.ndarray, corner: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(n, 10) quadrics: x.A.x + 2 b.x + c as A (xx, xy, xz, yy, yz, zz), b, c; weight (n,) multiplies them."""
    quadrics = np.zeros((len(position), 10))
    _add_planes(position, corner, weight, quadrics)
    return quadrics


@kernel
def _add_planes(position, corner, weight, quadrics):
    """Adds the quadrics of the planes of all faces to those of their vertices."""
    for f in range(len(corner) // 3):
        i, j, k = corner[3 * f], corner[3 * f + 1], corner[3 * f + 2]
        ax, ay, az = point(position, i)
        ux, uy, uz = between(position, i, j)
        vx, vy, vz = between(position, i, k)
        nx, ny, nz = cross(ux, uy, uz, vx, vy, vz)
        double = np.sqrt(dot(nx, ny, nz, nx, ny, nz))
        if double == 0.0:
            continue
        nx, ny, nz = nx / double, ny / double, nz / double
        d = -dot(nx, ny, nz, ax, ay, az)
        for v in (i, j, k):
            px, py, pz = point(position, v)
            _add(quadrics, v, double / 6 * weight[v], nx, ny, nz, d, px, py, pz)


@helper
def _add(q, v, s, x, y, z, d, px, py, pz):
    """Adds s times the squared distance to the plane x, y, z, d and, `PULL` times weaker, to the point px, py, pz."""
    w, v = s * PULL, np.uint32(v)
    q[v, 0] += s * x * x + w
    q[v, 1] += s * x * y
    q[v, 2] += s * x * z
    q[v, 3] += s * y * y + w
    q[v, 4] += s * y * z
    q[v, 5] += s * z * z + w
    q[v, 6] += s * x * d - w * px
    q[v, 7] += s * y * d - w * py
    q[v, 8] += s * z * d - w * pz
    q[v, 9] += s * d * d + w * dot(px, py, pz, px, py, pz)


# Below, arrays and ids are passed rather than rows or tuples of arrays: a row is an object whose references numba
# counts, which took six times as long as the arithmetic.


@helper
def error_at(q: np.ndarray, i: Id, j: Id, x: float, y: float, z: float) -> float:
    """The error at a point of the sum of the quadrics of two vertices."""
    i, j = np.uint32(i), np.uint32(j)
    gx = (q[i, 0] + q[j, 0]) * x + 2 * ((q[i, 1] + q[j, 1]) * y + (q[i, 2] + q[j, 2]) * z + q[i, 6] + q[j, 6])
    gy = (q[i, 3] + q[j, 3]) * y + 2 * ((q[i, 4] + q[j, 4]) * z + q[i, 7] + q[j, 7])
    gz = (q[i, 5] + q[j, 5]) * z + 2 * (q[i, 8] + q[j, 8])
    return greater(x * gx + y * gy + z * gz + q[i, 9] + q[j, 9], 0.0)


@helper
def best_place(q: np.ndarray, p: np.ndarray, i: Id, j: Id) -> tuple[float, float, float, float]:
    """(error, x, y, z): the minimum of the quadrics of two vertices at p (n, 3), near their midpoint."""
    i, j = np.uint32(i), np.uint32(j)
    sx, sy, sz = point(p, i)
    tx, ty, tz = point(p, j)
    x, y, z = (sx + tx) / 2, (sy + ty) / 2, (sz + tz) / 2
    a, b, c = q[i, 0] + q[j, 0], q[i, 3] + q[j, 3], q[i, 5] + q[j, 5]
    d, e, f = q[i, 1] + q[j, 1], q[i, 2] + q[j, 2], q[i, 4] + q[j, 4]
    lx, ly, lz = q[i, 6] + q[j, 6], q[i, 7] + q[j, 7], q[i, 8] + q[j, 8]
    gx, gy, gz = dot(a, d, e, x, y, z) + lx, dot(d, b, f, x, y, z) + ly, dot(e, f, c, x, y, z) + lz
    error = dot(x, y, z, gx + lx, gy + ly, gz + lz) + q[i, 9] + q[j, 9]
    xx, xy, xz = b * c - f * f, e * f - d * c, d * f - b * e
    yy, yz, zz = a * c - e * e, d * e - a * f, a * b - d * d
    inverse = -1 / dot(a, d, e, xx, xy, xz)
    dx, dy, dz = dot(xx, xy, xz, gx, gy, gz), dot(xy, yy, yz, gx, gy, gz), dot(xz, yz, zz, gx, gy, gz)
    dx, dy, dz = dx * inverse, dy * inverse, dz * inverse
    ux, uy, uz = sx - tx, sy - ty, sz - tz
    if dot(dx, dy, dz, dx, dy, dz) <= MAX_SHIFT * MAX_SHIFT * dot(ux, uy, uz, ux, uy, uz):  # False for NaN: A is flat
        error, x, y, z = error + gx * dx + gy * dy + gz * dz, x + dx, y + dy, z + dz
    return greater(error, 0.0), x, y, z


class Wedges(NamedTuple):
    """The wedges of a surface, whose quadrics hold the predictions' squares; here are those of their means."""

    wedge: np.ndarray  # (3 m,) i4: that of each corner
    merged: np.ndarray  # (w + 1,) i4: the wedge into which each was merged; the last one is none and stays empty
    following: np.ndarray  # (w + 1,) i4: the next wedge of the same vertex, in a ring
    sums: np.ndarray  # (w + 1, 1 + 4 k): of the areas of the faces, and of g and d times them for each attribute
    error: np.ndarray  # (2, 10) scratch: the quadric that is left, and zeros
    ends: np.ndarray  # (2, 3) scratch


@helper
def attribute_cost(
    opposite: np.ndarray, position: np.ndarray, quadric: np.ndarray, wedges: Wedges, h: Id, i: Id, j: Id, held: Id
) -> tuple[float, float, float, float]:
    """(error, x, y, z) of a collapse of half-edge h from i to j: at vertex `held`, or if -1 at the best place."""
    wedge, merged, following, sums, error, ends = wedges
    for n in range(10):
        error[0, n] = quadric[i, n] + quadric[j, n]
    for n in range(3):
        ends[0, n], ends[1, n] = position[i, n], position[j, n]
    a, b, c, d = _pairs(opposite, wedge, merged, h)
    nobody = np.int64(len(merged) - 1)
    for first in (a, b):
        w = np.int64(first)
        while True:
            if w != a and w != b and w != c and w != d:
                _take_mean(error, sums, w, nobody, nobody)
            w = np.int64(following[w])
            if w == first:
                break
    if a == c or b == d:
        _take_mean(error, sums, a, b, nobody if a == c and b == d else c if b == d else d)
    else:
        _take_mean(error, sums, a, b, nobody)
        _take_mean(error, sums, c, d, nobody)
    if held >= 0:
        x, y, z = position[held, 0], position[held, 1], position[held, 2]
        return error_at(error, 0, 1, x, y, z), x, y, z
    return best_place(error, ends, 0, 1)


@helper
def _pairs(opposite, wedge, merged, h):
    """The wedges at the two ends of half-edge h in its own face, then in the face across."""
    t = opposite[h]
    a, b = _root(merged, wedge[h]), _root(merged, wedge[after(h)])
    return a, b, _root(merged, wedge[after(t)]), _root(merged, wedge[t])


@helper
def _root(merged, w):
    while merged[w] != w:
        merged[w] = merged[merged[w]]  # halves the path for later calls
        w = merged[w]
    return np.int64(w)


@helper
def _take_mean(error, sums, a, b, c):
    """Takes the square of the mean prediction of wedges a, b, c, times their area, off the sum of the squares."""
    area = sums[a, 0] + sums[b, 0] + sums[c, 0]
    if area == 0.0:
        return
    for n in range(1, sums.shape[1], 4):
        x = sums[a, n] + sums[b, n] + sums[c, n]
        y = sums[a, n + 1] + sums[b, n + 1] + sums[c, n + 1]
        z = sums[a, n + 2] + sums[b, n + 2] + sums[c, n + 2]
        d = sums[a, n + 3] + sums[b, n + 3] + sums[c, n + 3]
        error[0, 0] -= x * x / area
        error[0, 1] -= x * y / area
        error[0, 2] -= x * z / area
        error[0, 3] -= y * y / area
        error[0, 4] -= y * z / area
        error[0, 5] -= z * z / area
        error[0, 6] -= x * d / area
        error[0, 7] -= y * d / area
        error[0, 8] -= z * d / area
        error[0, 9] -= d * d / area


@helper
def merge_wedges(opposite: np.ndarray, wedges: Wedges, h: Id) -> None:
    """Merges the wedges at the ends of half-edge h, which is about to collapse, on both of its sides."""
    a, b, c, d = _pairs(opposite, wedges.wedge, wedges.merged, h)
    following = wedges.following
    following[a], following[b] = following[b], following[a]  # one ring of two
    _merge(wedges, a, b)
    c, d = _root(wedges.merged, c), _root(wedges.merged, d)
    if c != d:
        _merge(wedges, c, d)


@helper
def _merge(wedges, stays, goes):
    """Merges a wedge into another one of the same ring."""
    before = goes
    while wedges.following[before] != goes:
        before = np.int64(wedges.following[before])
    wedges.following[before] = wedges.following[goes]
    wedges.merged[goes] = stays
    for n in range(wedges.sums.shape[1]):
        wedges.sums[stays, n] += wedges.sums[goes, n]

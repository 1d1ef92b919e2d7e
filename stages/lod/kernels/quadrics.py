"""Quadric error: the sum of squared distances to planes, area-weighted (Garland and Heckbert 1997, T [222])."""

import numpy as np

from .jit import Id, helper, kernel
from .vectors import between, cross, dot, point

PULL = 1e-6  # weight of the distance to the point itself relative to the plane: on a flat region it alone decides
MAX_SHIFT = 2.0  # of the optimum from the edge's midpoint, in lengths of the edge


def vertex_quadrics(position: np.ndarray, corner: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """(n, 10) quadrics: x.A.x + 2 b.x + c as A (xx, xy, xz, yy, yz, zz), b, c; weight (n,) multiplies them."""
    found = np.zeros((len(position), 10))
    _add_planes(position, corner, weight, found)
    return found


@kernel
def _add_planes(position, corner, weight, found):
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
            _add(found, v, double / 6 * weight[v], nx, ny, nz, d, px, py, pz)


@helper
def _add(q, v, s, x, y, z, d, px, py, pz):
    """Adds s times the squared distance to the plane x, y, z, d and, `PULL` times weaker, to the point px, py, pz."""
    w = s * PULL
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
    gx = (q[i, 0] + q[j, 0]) * x + 2 * ((q[i, 1] + q[j, 1]) * y + (q[i, 2] + q[j, 2]) * z + q[i, 6] + q[j, 6])
    gy = (q[i, 3] + q[j, 3]) * y + 2 * ((q[i, 4] + q[j, 4]) * z + q[i, 7] + q[j, 7])
    gz = (q[i, 5] + q[j, 5]) * z + 2 * (q[i, 8] + q[j, 8])
    return max(x * gx + y * gy + z * gz + q[i, 9] + q[j, 9], 0.0)


@kernel
def best_place(q: np.ndarray, p: np.ndarray, i: Id, j: Id) -> tuple[float, float, float, float]:
    """(error, x, y, z): the minimum of the quadrics of two vertices at p (n, 3), near their midpoint."""
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
    return max(error, 0.0), x, y, z

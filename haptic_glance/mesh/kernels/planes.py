"""One face and one point: the planes of the face, and the distance to it, compiled by numba.

Planes are 16 numbers: those of the face itself and of its three sides, perpendicular to it and outward; four x, four y
and four z of their normals, four offsets. They give a lower bound of the distance by 24 products and sums without a
branch, which mostly is the distance. Faces without area are measured as segments or points.
"""

import math

import numpy as np

from haptic_glance.base.jit import cached_njit, greater, helper, lesser

Id = int | np.integer
kernel = cached_njit(forceinline=True)
NUMBERS = 16  # of the planes
SLIM = 1e-3  # height of a face over the position of its foot: below, the axes are orthogonalised again
SLIVER = 1e-12  # height of a face over its length: a flatter face has no interior


@helper
def _frame_of(vertices, a, b, c):
    """Two axes in the plane of a face, then length, cx, cy: its corners in them are (0, 0), (length, 0), (cx, cy)."""
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    vx, vy, vz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    if length > 0:
        over = 1 / length
        ux, uy, uz = ux * over, uy * over, uz * over
    else:
        ux, uy, uz = 1.0, 0.0, 0.0
    cx = vx * ux + vy * uy + vz * uz
    wx, wy, wz = vx - cx * ux, vy - cx * uy, vz - cx * uz
    size = math.sqrt(wx * wx + wy * wy + wz * wz)
    turns = 0 if size > SLIM * abs(cx) else 2
    while turns > 0:  # of a sliver's third corner rounding is left: orthogonalised once more
        turns -= 1
        if size > 0:
            wx, wy, wz = wx / size, wy / size, wz / size
        elif abs(ux) < 0.9:  # no area: any perpendicular axis
            wx, wy, wz = 0.0, -uz, uy
        else:
            wx, wy, wz = -uz, 0.0, ux
        slant = wx * ux + wy * uy + wz * uz
        wx, wy, wz = wx - slant * ux, wy - slant * uy, wz - slant * uz
        size = math.sqrt(wx * wx + wy * wy + wz * wz)
    over = 1 / size
    wx, wy, wz = wx * over, wy * over, wz * over
    return (ux, uy, uz), (wx, wy, wz), length, cx, greater(vx * wx + vy * wy + vz * wz, 0.0)


@helper
def set_planes(vertices: np.ndarray, a: Id, b: Id, c: Id, low: np.ndarray, planes: np.ndarray, f: Id) -> float:
    """Writes the planes of a face, offsets relative to `low`; returns twice its area."""
    (ux, uy, uz), (wx, wy, wz), length, cx, cy = _frame_of(vertices, a, b, c)
    side, back = math.sqrt((cx - length) ** 2 + cy * cy), math.sqrt(cx * cx + cy * cy)
    side, back = 1 / side if side > 0 else 0.0, 1 / back if back > 0 else 0.0
    row = planes[f]
    row[0], row[4], row[8] = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    down = -1.0 if cy > SLIVER * length else 0.0  # zero: no point is beyond or inside
    row[1], row[5], row[9] = down * wx, down * wy, down * wz
    p, q = cy * side, (length - cx) * side
    row[2], row[6], row[10] = p * ux + q * wx, p * uy + q * wy, p * uz + q * wz
    p, q = -cy * back, cx * back
    row[3], row[7], row[11] = p * ux + q * wx, p * uy + q * wy, p * uz + q * wz
    for k in range(4):
        corner = b if k == 2 else (c if k == 3 else a)
        x, y, z = vertices[corner, 0] - low[0], vertices[corner, 1] - low[1], vertices[corner, 2] - low[2]
        row[12 + k] = -(row[k] * x + row[4 + k] * y + row[8 + k] * z)
    return length * cy


@helper
def bound_to(planes: np.ndarray, f: Id, x: float, y: float, z: float) -> float:
    """Lower bound of the squared distance of a point, relative to `low`, to a face: that to its planes."""
    w = planes[f, 0] * x + planes[f, 4] * y + planes[f, 8] * z + planes[f, 12]
    side_a = planes[f, 1] * x + planes[f, 5] * y + planes[f, 9] * z + planes[f, 13]
    side_b = planes[f, 2] * x + planes[f, 6] * y + planes[f, 10] * z + planes[f, 14]
    side_c = planes[f, 3] * x + planes[f, 7] * y + planes[f, 11] * z + planes[f, 15]
    beyond = side_a if side_a > side_b else side_b  # numba's max of several numbers takes twice as long
    beyond = side_c if side_c > beyond else beyond
    beyond = beyond if beyond > 0.0 else 0.0
    return w * w + beyond * beyond


@helper
def _square_to_side(x, y, z, dx, dy, dz):
    """Squared distance of a point to the segment from the origin to d."""
    size = dx * dx + dy * dy + dz * dz
    t = (x * dx + y * dy + z * dz) / size if size > 0.0 else 0.0
    t = t if t > 0.0 else 0.0
    t = t if t < 1.0 else 1.0
    x, y, z = x - t * dx, y - t * dy, z - t * dz
    return x * x + y * y + z * z


@helper
def square_to(
    vertices: np.ndarray, faces: np.ndarray, planes: np.ndarray, f: Id, x: float, y: float, z: float
) -> float:
    """Squared distance of a point to a face, relative to the face's own corners, so that no offset adds rounding."""
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    ax, ay, az = x - vertices[a, 0], y - vertices[a, 1], z - vertices[a, 2]
    bx, by, bz = x - vertices[b, 0], y - vertices[b, 1], z - vertices[b, 2]
    cx, cy, cz = x - vertices[c, 0], y - vertices[c, 1], z - vertices[c, 2]
    w = planes[f, 0] * ax + planes[f, 4] * ay + planes[f, 8] * az
    side_a = planes[f, 1] * ax + planes[f, 5] * ay + planes[f, 9] * az
    side_b = planes[f, 2] * bx + planes[f, 6] * by + planes[f, 10] * bz
    side_c = planes[f, 3] * cx + planes[f, 7] * cy + planes[f, 11] * cz
    if side_a < 0.0 and side_b < 0.0 and side_c < 0.0:
        return w * w
    best = _square_to_side(ax, ay, az, ax - bx, ay - by, az - bz)
    best = lesser(best, _square_to_side(bx, by, bz, bx - cx, by - cy, bz - cz))
    return lesser(best, _square_to_side(cx, cy, cz, cx - ax, cy - ay, cz - az))


def corner_weights(points: np.ndarray, owners: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(k, 3) barycentric weights, 0 to 1, of the points of faces[owners] (k,) nearest to points (k, 3)."""
    weights = np.empty((len(points), 3))
    _weigh(points, owners, vertices, faces, weights)
    return weights


@kernel
def _weigh(points, owners, vertices, faces, weights):
    """Fills the weights of `corner_weights`."""
    for i in range(len(points)):
        a, b, c = faces[owners[i], 0], faces[owners[i], 1], faces[owners[i], 2]
        (ux, uy, uz), (wx, wy, wz), length, cx, cy = _frame_of(vertices, a, b, c)
        x, y, z = points[i, 0] - vertices[a, 0], points[i, 1] - vertices[a, 1], points[i, 2] - vertices[a, 2]
        u, v = x * ux + y * uy + z * uz, x * wx + y * wy + z * wz
        if length > 0 and cy > 0:
            third = v / cy
            second = (u - cx * third) / length
            if second >= 0 and third >= 0 and second + third <= 1:
                weights[i, 0], weights[i, 1], weights[i, 2] = 1 - second - third, second, third
                continue
        best = np.inf
        for k in range(3):
            after = (k + 1) % 3
            px, py = length if k == 1 else (cx if k == 2 else 0.0), cy if k == 2 else 0.0
            dx, dy = (length if k == 0 else (cx if k == 1 else 0.0)) - px, (cy if k == 1 else 0.0) - py
            square = dx * dx + dy * dy
            t = ((u - px) * dx + (v - py) * dy) / square if square > 0 else 0.0
            t = lesser(greater(t, 0.0), 1.0)
            square_distance = (u - px - t * dx) ** 2 + (v - py - t * dy) ** 2
            if square_distance < best:
                best = square_distance
                weights[i, k], weights[i, after], weights[i, (k + 2) % 3] = 1 - t, t, 0.0

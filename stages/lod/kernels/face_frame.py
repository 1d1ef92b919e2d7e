"""One face and one point: the face as a frame of its own, and the distance to it, compiled by numba.

A frame is 17 numbers: origin, normal, two axes in the plane, the corners (0, 0), (length, 0), (cx, cy) in them, and one
over the lengths of the second and third side. Most faces are then passed over after three or nine products. Faces
without area are segments or points, and are measured as such.
"""

import math

import numpy as np

from .jit import inlined, kernel

NUMBERS = 17  # of a frame


@kernel
def set_frame(vertices, a, b, c, frames, f):
    """Writes a face as origin, normal, two axes, and its corners (0, 0), (length, 0), (cx, cy) in them."""
    ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
    ux, uy, uz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
    vx, vy, vz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    if length > 0:
        ux, uy, uz = ux / length, uy / length, uz / length
    else:
        ux, uy, uz = 1.0, 0.0, 0.0
    cx = vx * ux + vy * uy + vz * uz
    wx, wy, wz = vx - cx * ux, vy - cx * uy, vz - cx * uz
    for _ in range(2):  # what is left of a needle's third corner is rounding: made to stand upright once more
        size = math.sqrt(wx * wx + wy * wy + wz * wz)
        if size > 0:
            wx, wy, wz = wx / size, wy / size, wz / size
        elif abs(ux) < 0.9:  # no area: any axis across will do
            wx, wy, wz = 0.0, -uz, uy
        else:
            wx, wy, wz = -uz, 0.0, ux
        slant = wx * ux + wy * uy + wz * uz
        wx, wy, wz = wx - slant * ux, wy - slant * uy, wz - slant * uz
    size = math.sqrt(wx * wx + wy * wy + wz * wz)
    wx, wy, wz = wx / size, wy / size, wz / size
    cy = max(vx * wx + vy * wy + vz * wz, 0.0)
    side, back = math.sqrt((cx - length) ** 2 + cy * cy), math.sqrt(cx * cx + cy * cy)
    frames[f, 0], frames[f, 1], frames[f, 2] = ax, ay, az
    frames[f, 3], frames[f, 4], frames[f, 5] = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    frames[f, 6], frames[f, 7], frames[f, 8] = ux, uy, uz
    frames[f, 9], frames[f, 10], frames[f, 11] = wx, wy, wz
    frames[f, 12], frames[f, 13], frames[f, 14] = length, cx, cy
    frames[f, 15], frames[f, 16] = 1 / side if side > 0 else 0.0, 1 / back if back > 0 else 0.0


@inlined
def square_to(frames, f, x, y, z, best):
    """Squared distance of a point to a face; `best` where it is no less than that."""
    x, y, z = x - frames[f, 0], y - frames[f, 1], z - frames[f, 2]
    w = x * frames[f, 3] + y * frames[f, 4] + z * frames[f, 5]
    u = x * frames[f, 6] + y * frames[f, 7] + z * frames[f, 8]
    v = x * frames[f, 9] + y * frames[f, 10] + z * frames[f, 11]
    length, cx, cy = frames[f, 12], frames[f, 13], frames[f, 14]
    # How far the point lies beyond the line of each side, in the plane of the face.
    one = -v
    two = (cy * (u - length) - (cx - length) * v) * frames[f, 15]
    three = (cx * v - cy * u) * frames[f, 16]
    beyond = one if one > 0.0 else 0.0  # numba's max of several numbers takes twice as long
    beyond = two if two > beyond else beyond
    beyond = three if three > beyond else beyond
    if w * w + beyond * beyond >= best:
        return best
    if one < 0.0 and two < 0.0 and three < 0.0:
        return w * w
    flat = np.inf
    if one >= 0:
        t = min(max(u, 0.0), length)
        flat = (u - t) ** 2 + v * v
    if two >= 0:
        ex, ey = (cx - length) * frames[f, 15], cy * frames[f, 15]
        t = min(max((u - length) * ex + v * ey, 0.0), ex * (cx - length) + ey * cy)
        flat = min(flat, (u - length - t * ex) ** 2 + (v - t * ey) ** 2)
    if three >= 0:
        ex, ey = cx * frames[f, 16], cy * frames[f, 16]
        t = min(max(u * ex + v * ey, 0.0), ex * cx + ey * cy)
        flat = min(flat, (u - t * ex) ** 2 + (v - t * ey) ** 2)
    return min(w * w + flat, best)


@kernel
def corner_weights(points, faces, frames):
    """(k, 3) barycentric weights, 0 to 1, of the place in faces (k,) nearest to points (k, 3)."""
    weights = np.empty((len(points), 3))
    for i in range(len(points)):
        f = faces[i]
        x, y, z = points[i, 0] - frames[f, 0], points[i, 1] - frames[f, 1], points[i, 2] - frames[f, 2]
        u = x * frames[f, 6] + y * frames[f, 7] + z * frames[f, 8]
        v = x * frames[f, 9] + y * frames[f, 10] + z * frames[f, 11]
        length, cx, cy = frames[f, 12], frames[f, 13], frames[f, 14]
        if length > 0 and cy > 0:
            c = v / cy
            b = (u - cx * c) / length
            if b >= 0 and c >= 0 and b + c <= 1:
                weights[i, 0], weights[i, 1], weights[i, 2] = 1 - b - c, b, c
                continue
        px, py = np.array([0.0, length, cx]), np.array([0.0, 0.0, cy])
        best = np.inf
        for k in range(3):
            after = (k + 1) % 3
            dx, dy = px[after] - px[k], py[after] - py[k]
            square = dx * dx + dy * dy
            t = ((u - px[k]) * dx + (v - py[k]) * dy) / square if square > 0 else 0.0
            t = min(max(t, 0.0), 1.0)
            found = (u - px[k] - t * dx) ** 2 + (v - py[k] - t * dy) ** 2
            if found < best:
                best = found
                weights[i, k], weights[i, after], weights[i, (k + 2) % 3] = 1 - t, t, 0.0
    return weights

"""Free vertices fitted to the original surface after the collapses.

A quadric pulls a vertex to the planes around it, so that on a curved region it lies outside. The error measured is the
distance between surfaces. So each vertex is moved to where the faces around it lie nearest to the original vertices
merged into it (least squares, as in Hoppe et al. 1993, "Mesh optimization", section 4.1; one step is enough).
"""

import numpy as np

from .checks import NOBODY, check_move
from .corners import after, before
from .jit import kernel
from .surface import HalfEdgeMesh

STEP = 1.4  # over the step that cannot overshoot: converges faster
TURN = 0.8  # least cosine by which the fit may turn a face
SHAPE = 0.1  # least quality of a face, as in `check_move`


@kernel
def refit(
    surface: HalfEdgeMesh, points: np.ndarray, faces: np.ndarray, weight: np.ndarray, samples: int, fold: float
) -> None:
    """Moves the unlocked vertices of the surface, in place.

    points (n, 3), faces (3 m,): the original surface, of whose vertices and face centres about `samples` are targets.
    weight (n,): the area around each vertex, times its weight. fold: as in `check_move`.
    """
    corner, opposite, start, boundary, locked, position, quadric, parent = surface
    count = len(points) + len(faces) // 3
    pull = np.zeros((len(position), 4))
    mark = np.empty(len(position), dtype=np.int32)  # scratch of check_move
    for at in range(0, count, max(count // max(samples, 1), 1)):
        owner, x, y, z, share = _target(points, faces, weight, at)
        _pull(corner, opposite, start, position, _root(parent, owner), x, y, z, share, pull)
    for v in range(len(position)):
        if pull[v, 3] > 0.0 and not locked[v]:
            by = STEP / pull[v, 3]
            x = position[v, 0] + by * pull[v, 0]
            y = position[v, 1] + by * pull[v, 1]
            z = position[v, 2] + by * pull[v, 2]
            if check_move(corner, opposite, start, position, mark, v, v, NOBODY, x, y, z, TURN, SHAPE, fold) >= 0:
                position[v, 0], position[v, 1], position[v, 2] = x, y, z


@kernel
def _root(parent, v):
    """The vertex into which v was merged in the end."""
    while parent[v] != v:
        parent[v] = parent[parent[v]]  # halves the path for later calls
        v = parent[v]
    return v


@kernel
def _target(points, faces, weight, at):
    """(vertex, x, y, z, weight) of one target: the vertices, then the centres of the faces.

    A face weighs a third of what its corners weigh, so that all faces together weigh as much as all vertices.
    """
    if at < len(points):
        return at, points[at, 0], points[at, 1], points[at, 2], weight[at]
    f = 3 * (at - len(points))
    i, j, k = faces[f], faces[f + 1], faces[f + 2]
    x = (points[i, 0] + points[j, 0] + points[k, 0]) / 3
    y = (points[i, 1] + points[j, 1] + points[k, 1]) / 3
    z = (points[i, 2] + points[j, 2] + points[k, 2]) / 3
    return np.int64(i), x, y, z, (weight[i] + weight[j] + weight[k]) / 3


@kernel
def _pull(corner, opposite, start, position, v, x, y, z, weight, pull):
    """Adds the pull of a target at x, y, z on the corners of the nearest face around v.

    The pull is its distance to the plane of the face, along the normal: along the surface nothing has to move, and a
    target beyond the faces around v would drag them there.
    """
    least, at, s, t = np.inf, start[v], 0.0, 0.0
    h = first = start[v]
    while True:
        far, along, aside = _nearest(position, v, corner[after(h)], corner[before(h)], x, y, z)
        if far < least:
            least, at, s, t = far, h, along, aside
        h = opposite[before(h)]
        if h < 0 or h == first:
            break
    i, j = corner[after(at)], corner[before(at)]
    ux, uy, uz = position[i, 0] - position[v, 0], position[i, 1] - position[v, 1], position[i, 2] - position[v, 2]
    wx, wy, wz = position[j, 0] - position[v, 0], position[j, 1] - position[v, 1], position[j, 2] - position[v, 2]
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    square = nx * nx + ny * ny + nz * nz
    if square == 0.0:
        return
    off = (x - position[v, 0]) * nx + (y - position[v, 1]) * ny + (z - position[v, 2]) * nz
    dx, dy, dz = off * nx / square, off * ny / square, off * nz / square
    _add(pull, v, (1 - s - t) * weight, dx, dy, dz)
    _add(pull, i, s * weight, dx, dy, dz)
    _add(pull, j, t * weight, dx, dy, dz)


@kernel
def _add(pull, v, share, dx, dy, dz):
    pull[v, 0] += share * dx
    pull[v, 1] += share * dy
    pull[v, 2] += share * dz
    pull[v, 3] += share


@kernel
def _nearest(p, a, b, c, x, y, z):
    """(squared distance, share of b, share of c) of the point of the triangle nearest to x, y, z."""
    ux, uy, uz = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
    vx, vy, vz = p[c, 0] - p[a, 0], p[c, 1] - p[a, 1], p[c, 2] - p[a, 2]
    wx, wy, wz = x - p[a, 0], y - p[a, 1], z - p[a, 2]
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    uw, vw = ux * wx + uy * wy + uz * wz, vx * wx + vy * wy + vz * wz
    det = uu * vv - uv * uv
    s, t = vv * uw - uv * vw, uu * vw - uv * uw
    if det > 0.0 and s >= 0.0 and t >= 0.0 and s + t <= det:
        s, t = s / det, t / det
    elif s < 0.0 and vw >= 0.0 and (t >= 0.0 or uw <= 0.0):
        s, t = 0.0, min(vw / vv, 1.0) if vv > 0.0 else 0.0
    elif t < 0.0 and uw >= 0.0:
        s, t = min(uw / uu, 1.0) if uu > 0.0 else 0.0, 0.0
    elif uw <= 0.0 and vw <= 0.0:
        s, t = 0.0, 0.0
    else:
        along = uu - 2 * uv + vv
        t = min(max((uu - uv - uw + vw) / along, 0.0), 1.0) if along > 0.0 else 0.0
        s = 1 - t
    dx, dy, dz = wx - s * ux - t * vx, wy - s * uy - t * vy, wz - s * uz - t * vz
    return dx * dx + dy * dy + dz * dz, s, t

"""Free vertices fitted to the original surface after the collapses.

A quadric pulls a vertex to the planes around it, so that on a curved region it lies outside. The error measured is the
distance between surfaces. So each vertex is moved to where the faces around it lie nearest to the original vertices
merged into it (least squares, as in Hoppe et al. 1993, "Mesh optimization", section 4.1; one step is enough).
"""

import numpy as np

from haptic_glance.base.jit import greater, lesser

from .collapse import NOBODY, check_move
from .mesh import HalfEdgeMesh, after, before
from .vectors import between, cross, dot, helper, kernel, point

STEP = 1.4  # over the step that cannot overshoot: converges faster
TURN = 0.8  # least cosine by which the fit may turn a face
SHAPE = 0.1  # least quality of a face, as in `check_move`


def refit(
    surface: HalfEdgeMesh, points: np.ndarray, faces: np.ndarray, weight: np.ndarray, samples: int, fold: float
) -> None:
    """Moves the unlocked vertices of the surface, in place.

    points (n, 3), faces (3 m,): the original surface, of whose vertices and face centres about `samples` are targets.
    weight (n,): the area around each vertex, times its weight. fold: as in `check_move`.
    """
    pull = np.zeros((len(surface.position), 4))
    mark = np.empty(len(pull), dtype=np.int32)  # scratch of check_move
    _refit(surface, points, faces, weight, samples, fold, pull, mark)


@kernel
def _refit(surface, points, faces, weight, samples, fold, pull, mark):
    corner, opposite, start, boundary, locked, position, quadric, parent = surface
    limits = TURN, SHAPE, fold, np.inf, 0.0
    count = len(points) + len(faces) // 3
    for at in range(0, count, greater(count // greater(samples, 1), 1)):
        owner, x, y, z, share = _target(points, faces, weight, at)
        _pull(corner, opposite, start, position, _root(parent, owner), x, y, z, share, pull)
    for v in range(len(position)):
        if pull[v, 3] > 0.0 and not locked[v]:
            by = STEP / pull[v, 3]
            x = position[v, 0] + by * pull[v, 0]
            y = position[v, 1] + by * pull[v, 1]
            z = position[v, 2] + by * pull[v, 2]
            if check_move(corner, opposite, start, position, mark, v, v, NOBODY, x, y, z, *limits) >= 0:
                position[v, 0], position[v, 1], position[v, 2] = x, y, z


@helper
def _root(parent, v):
    """The vertex into which v was merged in the end."""
    while parent[v] != v:
        parent[v] = parent[parent[v]]  # halves the path for later calls
        v = parent[v]
    return v


@helper
def _target(points, faces, weight, at):
    """(vertex, x, y, z, weight) of one target: the vertices, then the centres of the faces.

    A face weighs a third of what its corners weigh, so that all faces together weigh as much as all vertices.
    """
    if at < len(points):
        x, y, z = point(points, at)
        return at, x, y, z, weight[at]
    f = 3 * (at - len(points))
    i, j, k = faces[f], faces[f + 1], faces[f + 2]
    ax, ay, az = point(points, i)
    bx, by, bz = point(points, j)
    cx, cy, cz = point(points, k)
    share = (weight[i] + weight[j] + weight[k]) / 3
    return np.int64(i), (ax + bx + cx) / 3, (ay + by + cy) / 3, (az + bz + cz) / 3, share


@helper
def _pull(corner, opposite, start, position, v, x, y, z, weight, pull):
    """Adds the pull of a target at x, y, z on the corners of the nearest face around v.

    The pull is its distance to the plane of the face, along the normal: along the surface nothing has to move, and a
    target beyond the faces around v would drag them there.
    """
    least, at, s, t = np.inf, start[v], 0.0, 0.0
    h = first = start[v]
    while True:
        i, j = np.int64(corner[after(h)]), np.int64(corner[before(h)])
        far, along, aside = _nearest(position, v, i, j, x, y, z)
        if far < least:
            least, at, s, t = far, h, along, aside
        h = opposite[before(h)]
        if h < 0 or h == first:
            break
    i, j = np.int64(corner[after(at)]), np.int64(corner[before(at)])  # as v: `_add` is compiled once
    ux, uy, uz = between(position, v, i)
    wx, wy, wz = between(position, v, j)
    nx, ny, nz = cross(ux, uy, uz, wx, wy, wz)
    square = dot(nx, ny, nz, nx, ny, nz)
    if square == 0.0:
        return
    px, py, pz = point(position, v)
    off = dot(x - px, y - py, z - pz, nx, ny, nz)
    dx, dy, dz = off * nx / square, off * ny / square, off * nz / square
    _add(pull, v, (1 - s - t) * weight, dx, dy, dz)
    _add(pull, i, s * weight, dx, dy, dz)
    _add(pull, j, t * weight, dx, dy, dz)


@helper
def _add(pull, v, share, dx, dy, dz):
    pull[v, 0] += share * dx
    pull[v, 1] += share * dy
    pull[v, 2] += share * dz
    pull[v, 3] += share


@helper
def _nearest(p, a, b, c, x, y, z):
    """(squared distance, share of b, share of c) of the point of the triangle nearest to x, y, z."""
    ax, ay, az = point(p, a)
    ux, uy, uz = between(p, a, b)
    vx, vy, vz = between(p, a, c)
    wx, wy, wz = x - ax, y - ay, z - az
    uu, uv, vv = dot(ux, uy, uz, ux, uy, uz), dot(ux, uy, uz, vx, vy, vz), dot(vx, vy, vz, vx, vy, vz)
    uw, vw = dot(ux, uy, uz, wx, wy, wz), dot(vx, vy, vz, wx, wy, wz)
    det = uu * vv - uv * uv
    s, t = vv * uw - uv * vw, uu * vw - uv * uw
    if det > 0.0 and s >= 0.0 and t >= 0.0 and s + t <= det:
        s, t = s / det, t / det
    elif s < 0.0 and 0.0 <= vw <= vv and (t >= 0.0 or uw <= 0.0):
        s, t = 0.0, vw / vv if vv > 0.0 else 0.0
    elif t < 0.0 and 0.0 <= uw <= uu:
        s, t = uw / uu if uu > 0.0 else 0.0, 0.0
    elif uw <= 0.0 and vw <= 0.0:
        s, t = 0.0, 0.0
    else:
        along = uu - 2 * uv + vv
        t = lesser(greater((uu - uv - uw + vw) / along, 0.0), 1.0) if along > 0.0 else 0.0
        s = 1 - t
    dx, dy, dz = wx - s * ux - t * vx, wy - s * uy - t * vy, wz - s * uz - t * vz
    return dot(dx, dy, dz, dx, dy, dz), s, t

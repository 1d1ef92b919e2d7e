"""Which collapses are allowed: none may turn a face over, make a sliver, or change the topology."""

import numpy as np

from .corners import after, before
from .jit import Id, helper
from .vectors import cross, dot, point

NOBODY = np.int64(-1)  # no vertex; numba compiles anew for a plain -1
STEADY = 0.98  # cosine between a face's normal before and after above which its neighbours are not checked


@helper
def may_collapse(
    corner: np.ndarray,
    opposite: np.ndarray,
    start: np.ndarray,
    locked: np.ndarray,
    p: np.ndarray,
    mark: np.ndarray,
    last: np.ndarray,
    h: Id,
    x: float,
    y: float,
    z: float,
    turn: float,
    shape: float,
    fold: float,
    cut: float,
) -> bool:
    """Whether the edge of half-edge h may collapse to x, y, z: nothing folds, and the link condition holds.

    The link condition: the ends share no neighbour but the two opposite the edge, and no tetrahedron closes. mark (n,)
    scratch, last (1,) the tag of the last marking; turn, shape, fold, cut: see `check_move`.
    """
    t = np.int64(opposite[h])  # as all ids that are passed on: each further type compiles the callees once more
    i, j = np.int64(corner[h]), np.int64(corner[t])
    k, m = np.int64(corner[before(h)]), np.int64(corner[before(t)])
    if k == m or _closes_tetrahedron(corner, opposite, h, m) or _closes_tetrahedron(corner, opposite, t, k):
        return False
    last[0] += 1
    shared = 0
    for v, other in ((i, j), (j, i)):
        if locked[v]:
            shared = _mark_neighbours(corner, opposite, start, mark, last[0], v)
        else:
            shared = check_move(corner, opposite, start, p, mark, last[0], v, other, x, y, z, turn, shape, fold, cut)
        if shared < 0:
            return False
    holds = shared == 2
    for side in (h, t):
        holds = holds and _seam_holds(corner, opposite, p, i, j, side, x, y, z, fold)
    return holds


@helper
def _mark_neighbours(corner, opposite, start, mark, tag, v):
    """Marks all neighbours of v with `tag`; returns how many had that mark already."""
    found = 0
    h = first = start[v]
    while True:
        a = corner[after(h)]
        found += mark[a] == tag
        mark[a] = tag
        back = before(h)
        h = opposite[back]
        if h < 0:
            found += mark[corner[back]] == tag
            mark[corner[back]] = tag
            return found
        if h == first:
            return found


@helper
def _seam_holds(corner, opposite, p, i, j, h, x, y, z, fold):
    """Whether the faces that become neighbours without that of h do not fold, or one was folded before."""
    one, two = np.int64(opposite[after(h)]), np.int64(opposite[before(h)])
    if one < 0 or two < 0:
        return True
    ax, ay, az = _normal(corner, p, one, i, j, x, y, z)
    bx, by, bz = _normal(corner, p, two, i, j, x, y, z)
    if not _folds(ax, ay, az, bx, by, bz, fold):
        return True
    ax, ay, az = _normal(corner, p, one, NOBODY, NOBODY, x, y, z)
    bx, by, bz = _normal(corner, p, two, NOBODY, NOBODY, x, y, z)
    cx, cy, cz = _normal(corner, p, h, NOBODY, NOBODY, x, y, z)
    return _folds(ax, ay, az, cx, cy, cz, fold) or _folds(bx, by, bz, cx, cy, cz, fold)


@helper
def _normal(corner, p, h, i, j, x, y, z):
    """Normal, times twice the area, of the face of h once vertices i and j are at x, y, z."""
    ax, ay, az = _place(p, corner[h], i, j, x, y, z)
    bx, by, bz = _place(p, corner[after(h)], i, j, x, y, z)
    cx, cy, cz = _place(p, corner[before(h)], i, j, x, y, z)
    return cross(bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az)


@helper
def _place(p, v, i, j, x, y, z):
    if v != i and v != j:  # compiled in a tenth of the time of `not in`
        return point(p, v)
    return x, y, z


@helper
def check_move(
    corner: np.ndarray,
    opposite: np.ndarray,
    start: np.ndarray,
    p: np.ndarray,
    mark: np.ndarray,
    tag: Id,
    v: Id,
    other: Id,
    x: float,
    y: float,
    z: float,
    turn: float,
    shape: float,
    fold: float,
    cut: float,
) -> int:
    """-1 where moving v to x, y, z spoils a face around v; faces that also touch `other` are left out.

    Spoiled is a face that turns too far, becomes a sliver, or folds onto a neighbour where it did not before, and a tip
    that is cut off. Otherwise the neighbours of v are marked and counted as by `_mark_neighbours`. v: not on the
    boundary. p (n, 3). turn: least cosine, above 0, between a face's normal before and after; shape: least quality of a
    face after (1 for an equilateral triangle, 0 for a sliver), unless it was lower before; fold: least cosine, below 0,
    between the normals of two neighbours; cut: how far v may move where it is a tip, of which x, y, z then is the
    nearest point that is left: all its neighbours lie behind that.
    """
    vx, vy, vz = point(p, v)
    # Normals, after and before, of the face before this one and of the first.
    lx = ly = lz = mx = my = mz = fx = fy = fz = gx = gy = gz = 0.0
    dx, dy, dz = vx - x, vy - y, vz - z
    tip = dot(dx, dy, dz, dx, dy, dz) > cut * cut
    found = 0
    h = first = start[v]
    a = corner[after(h)]
    ax, ay, az = point(p, a)
    while True:
        found += mark[a] == tag
        mark[a] = tag
        tip = tip and dot(ax - x, ay - y, az - z, dx, dy, dz) <= 0.0
        back = before(h)
        b = corner[back]
        bx, by, bz = point(p, b)
        if a == other or b == other:
            lx = ly = lz = 0.0
        else:
            ex, ey, ez = bx - ax, by - ay, bz - az
            sx, sy, sz, tx, ty, tz = ax - x, ay - y, az - z, ax - vx, ay - vy, az - vz
            nx, ny, nz = cross(sx, sy, sz, ex, ey, ez)
            ox, oy, oz = cross(tx, ty, tz, ex, ey, ez)
            new, old = dot(nx, ny, nz, nx, ny, nz), dot(ox, oy, oz, ox, oy, oz)
            along = dot(nx, ny, nz, ox, oy, oz)
            if old > 0.0 and (along <= 0.0 or along * along < turn * turn * new * old):
                return -1
            sides = _sides(sx, sy, sz, ex, ey, ez)
            if 12 * new < shape * shape * sides * sides:
                before_sides = _sides(tx, ty, tz, ex, ey, ez)
                if new * before_sides * before_sides <= old * sides * sides:
                    return -1
            if _folds(nx, ny, nz, lx, ly, lz, fold) and not _folds(ox, oy, oz, mx, my, mz, fold):
                return -1
            lx, ly, lz, mx, my, mz = nx, ny, nz, ox, oy, oz
            if h == first:
                fx, fy, fz, gx, gy, gz = nx, ny, nz, ox, oy, oz
            if along * along < STEADY * STEADY * new * old:
                g = np.int64(opposite[after(h)])
                if g >= 0:
                    cx, cy, cz = _normal(corner, p, g, NOBODY, NOBODY, x, y, z)
                    if _folds(nx, ny, nz, cx, cy, cz, fold) and not _folds(ox, oy, oz, cx, cy, cz, fold):
                        return -1
        a, ax, ay, az = b, bx, by, bz
        h = opposite[back]
        if h == first:
            bad = _folds(fx, fy, fz, lx, ly, lz, fold) and not _folds(gx, gy, gz, mx, my, mz, fold)
            return -1 if bad or tip else found


@helper
def _folds(ax, ay, az, bx, by, bz, fold):
    """Whether the cosine between two vectors lies below `fold`, which is negative."""
    along = dot(ax, ay, az, bx, by, bz)
    if along >= 0.0:
        return False
    return along * along > fold * fold * dot(ax, ay, az, ax, ay, az) * dot(bx, by, bz, bx, by, bz)


@helper
def _sides(ax, ay, az, ex, ey, ez):
    """The squared lengths of the sides a, e and a + e of a triangle, summed."""
    bx, by, bz = ax + ex, ay + ey, az + ez
    return ax * ax + ay * ay + az * az + bx * bx + by * by + bz * bz + ex * ex + ey * ey + ez * ez


@helper
def _closes_tetrahedron(corner, opposite, h, apex):
    """Whether the corner across h has only three faces, the outer one of which ends at the other corner `apex`."""
    one, two = opposite[after(h)], opposite[before(h)]
    return one >= 0 and two >= 0 and corner[before(one)] == apex and corner[before(two)] == apex

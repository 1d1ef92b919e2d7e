"""Collapses edges in the order of their quadric error, until the faces are few enough.

A collapse is refused if it turns a face over, makes a sliver or changes the topology. The queue holds half-edges in
buckets by cost, each a linked list, so that every operation takes constant time. head (buckets,): the first half-edge
of each, -1 where empty; following (3 m,): the next one of the same bucket, -1 at the end, NOT_QUEUED where the
half-edge is in none; lowest (1,): all buckets below it are empty.
"""

import numpy as np

from haptic_glance.base.jit import greater, lesser

from .mesh import HalfEdgeMesh, after, before, collapse_edge
from .quadrics import Wedges, attribute_cost, best_place, error_at, merge_wedges
from .vectors import Id, cross, dot, helper, kernel, point

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
    thin: float,
) -> bool:
    """Whether the edge of half-edge h may collapse to x, y, z: nothing folds, and the link condition holds.

    The link condition: the ends share no neighbour but the two opposite the edge, and no tetrahedron closes. mark (n,)
    scratch, last (1,) the tag of the last marking; turn, shape, fold, cut, thin: as of `check_move`.
    """
    t = np.int64(opposite[h])  # as all ids that are passed on: each further type compiles the callees once more
    i, j = np.int64(corner[h]), np.int64(corner[t])
    k, m = np.int64(corner[before(h)]), np.int64(corner[before(t)])
    if k == m or _closes_tetrahedron(corner, opposite, h, m) or _closes_tetrahedron(corner, opposite, t, k):
        return False
    last[0] += 1
    shared = 0
    for v, partner in ((i, j), (j, i)):
        if locked[v]:
            shared = _mark_neighbours(corner, opposite, start, mark, last[0], v)
        else:
            limits = turn, shape, fold, cut, thin
            shared = check_move(corner, opposite, start, p, mark, last[0], v, partner, x, y, z, *limits)
        if shared < 0:
            return False
    holds = shared == 2
    for side in (h, t):
        holds = holds and _seam_holds(corner, opposite, p, i, j, side, x, y, z, fold)
    return holds


@helper
def _mark_neighbours(corner, opposite, start, mark, tag, v):
    """Marks all neighbours of v with `tag`; returns how many had that mark already."""
    shared = 0
    h = first = start[v]
    while True:
        a = corner[after(h)]
        shared += mark[a] == tag
        mark[a] = tag
        back = before(h)
        h = opposite[back]
        if h < 0:
            shared += mark[corner[back]] == tag
            mark[corner[back]] = tag
            return shared
        if h == first:
            return shared


@helper
def _seam_holds(corner, opposite, p, i, j, h, x, y, z, fold):
    """Whether the faces that become neighbours without that of h do not fold, or one was folded before."""
    first, second = np.int64(opposite[after(h)]), np.int64(opposite[before(h)])
    if first < 0 or second < 0:
        return True
    ax, ay, az = _normal(corner, p, first, i, j, x, y, z)
    bx, by, bz = _normal(corner, p, second, i, j, x, y, z)
    if not _folds(ax, ay, az, bx, by, bz, fold):
        return True
    ax, ay, az = _normal(corner, p, first, NOBODY, NOBODY, x, y, z)
    bx, by, bz = _normal(corner, p, second, NOBODY, NOBODY, x, y, z)
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
    partner: Id,
    x: float,
    y: float,
    z: float,
    turn: float,
    shape: float,
    fold: float,
    cut: float,
    thin: float,
) -> int:
    """-1 where moving v to x, y, z spoils a face around v; faces that also touch `partner` are left out.

    Spoiled is a face that turns too far, becomes a sliver, or folds onto a neighbour where it did not before, and a tip
    that is cut off. Otherwise the neighbours of v are marked and counted as by `_mark_neighbours`. v: not on the
    boundary. p (n, 3). turn: least cosine, above 0, between a face's normal before and after; shape: least quality of a
    face after (1 for an equilateral triangle, 0 for a sliver), unless it was lower before; fold: least cosine, below 0,
    between the normals of two neighbours; cut: how far v may move where it is a tip, of which x, y, z then is the
    nearest point that is left: all its neighbours lie behind that; thin: least height of a face after, or 0 for any.
    """
    vx, vy, vz = point(p, v)
    # Normals, after and before, of the face before this one and of the first.
    lx = ly = lz = mx = my = mz = fx = fy = fz = gx = gy = gz = 0.0
    dx, dy, dz = vx - x, vy - y, vz - z
    tip = dot(dx, dy, dz, dx, dy, dz) > cut * cut
    shared = 0
    h = first = start[v]
    a = corner[after(h)]
    ax, ay, az = point(p, a)
    while True:
        shared += mark[a] == tag
        mark[a] = tag
        tip = tip and dot(ax - x, ay - y, az - z, dx, dy, dz) <= 0.0
        back = before(h)
        b = corner[back]
        bx, by, bz = point(p, b)
        if a == partner or b == partner:
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
            if new < thin * thin * sides and new < old:
                return -1
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
            return -1 if bad or tip else shared


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
    first, second = opposite[after(h)], opposite[before(h)]
    return first >= 0 and second >= 0 and corner[before(first)] == apex and corner[before(second)] == apex


BITS = 1  # of the mantissa: two buckets for each doubling of the cost
LEAST = 127 - 100  # biased exponent of the cost below which all share a bucket
HIGHEST = 3e38  # from this cost on all share the last bucket
NOT_QUEUED = -2
BUCKETS = (255 - LEAST) << BITS


def empty_queue(size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(head, following, lowest) for half-edges below `size`."""
    return (
        np.full(BUCKETS, -1, dtype=np.int32),
        np.full(size, NOT_QUEUED, dtype=np.int32),
        np.full(1, BUCKETS, dtype=np.int64),
    )


@helper
def bucket_of(cost: float) -> Id:
    """The bucket of a cost of 0 or more: the leading bits of the number itself, which grow with it."""
    if not cost < HIGHEST:  # infinity and NaN of either sign, too
        return BUCKETS - 1
    return lesser(greater((np.float32(cost).view(np.int32) >> (23 - BITS)) - (LEAST << BITS), 0), BUCKETS - 1)


@helper
def is_queued(following: np.ndarray, h: Id) -> bool:
    """Whether a half-edge is in the queue."""
    return following[np.uint32(h)] != NOT_QUEUED


@helper
def push(head: np.ndarray, following: np.ndarray, lowest: np.ndarray, h: Id, bucket: Id) -> None:
    """Puts a half-edge that is not queued into a bucket."""
    h, bucket = np.uint32(h), np.uint32(bucket)
    following[h] = head[bucket]
    head[bucket] = h
    if bucket < lowest[0]:
        lowest[0] = bucket


@helper
def pop(head: np.ndarray, following: np.ndarray, lowest: np.ndarray) -> tuple[Id, Id]:
    """(half-edge, its bucket) of least cost; (-1, -1) when the queue is empty."""
    for at in range(lowest[0], BUCKETS):
        h = np.int64(head[np.uint32(at)])
        if h >= 0:
            head[np.uint32(at)] = following[np.uint32(h)]
            following[np.uint32(h)] = NOT_QUEUED
            lowest[0] = at
            return h, at
    lowest[0] = BUCKETS
    return -1, -1


LATER = 8  # buckets by which a refused collapse is put off,
GROWN = 16.0  # until the current cost has grown so many times
THIN = 4e-7  # of the surface's longest side: twice the height of a face that `topology.faults` counts as degenerate


def decimate(surface: HalfEdgeMesh, wedges: Wedges | None, faces: int, turn: float, shape: float, fold: float) -> int:
    """Collapses edges of the surface until `faces` are left or none may collapse; returns the face count.

    wedges: those of the attributes that the quadrics hold; numba compiles what deals with them only where they are.
    turn, shape, fold: the limits of `check_move`. The cost in the queue is a lower bound, since quadrics only grow: an
    edge whose cost has risen is put back when its turn comes. So is a refused one, further back, and then slivers a
    tenth as wide are allowed: slivers on a flat region are better than a cut-off corner.

    A tip may be cut by the distance at which a face of mean area costs as much as the collapses of now. Its own planes
    say little of it: along a thin tip they all hold, and the fewer and smaller they are, the less it costs.
    """
    mark, last = np.zeros(len(surface.position), dtype=np.int32), np.zeros(1, dtype=np.int64)
    return _decimate(surface, wedges, *empty_queue(len(surface.corner)), mark, last, faces, turn, shape, fold)


@kernel
def _decimate(surface, wedges, head, following, lowest, mark, last, faces, turn, shape, fold):
    """`decimate` with an empty queue; mark, last: as of `may_collapse`."""
    corner, opposite, start, boundary, locked, position, quadric, parent = surface
    count = 0
    for h in range(len(corner)):
        count += corner[h] >= 0
        if opposite[h] > h and corner[h] >= 0:
            _offer(corner, opposite, locked, position, quadric, wedges, head, following, lowest, h)
    count //= 3
    xx, yy, zz = 0.0, 0.0, 0.0
    for v in range(len(quadric)):
        xx, yy, zz = xx + quadric[v, 0], yy + quadric[v, 3], zz + quadric[v, 5]
    area, thin = xx + yy + zz, 0.0
    if wedges is not None:  # whose attributes are in the quadrics too
        # Where seams meet, the best places of several edges are one point, and the faces between them would vanish.
        area, thin = 0.0, THIN
        for w in range(len(wedges.sums)):
            area += wedges.sums[w, 0]
    level = 0.0
    while count > faces:
        h, bucket = pop(head, following, lowest)
        if h < 0:
            break
        if corner[h] < 0 or (locked[corner[h]] and locked[corner[after(h)]]):
            continue
        cost, x, y, z = _cost(corner, opposite, locked, position, quadric, wedges, h)
        now = bucket_of(cost)
        if now > bucket:
            push(head, following, lowest, h, now)
            continue
        least = shape
        if bucket > now:
            refused = (bucket - now) / LATER
            cost, least = cost * GROWN**refused, shape * 0.1**refused
        level = greater(level, cost)
        cut = np.sqrt(level * count / area)
        limits = turn, least, fold, cut, thin
        if may_collapse(corner, opposite, start, locked, position, mark, last, h, x, y, z, *limits):
            if wedges is not None:
                merge_wedges(opposite, wedges, h)
            first, second = collapse_edge(
                corner, opposite, start, boundary, locked, position, quadric, parent, h, x, y, z
            )
            for g in (first, second):
                if g >= 0 and not (is_queued(following, g) or (opposite[g] >= 0 and is_queued(following, opposite[g]))):
                    _offer(corner, opposite, locked, position, quadric, wedges, head, following, lowest, g)
            count -= 2
        elif bucket + LATER < BUCKETS:
            push(head, following, lowest, h, bucket + LATER)
    return count


@helper
def _offer(corner, opposite, locked, position, quadric, wedges, head, following, lowest, h):
    if opposite[h] >= 0 and not (locked[corner[h]] and locked[corner[after(h)]]):
        cost, x, _y, _z = _cost(corner, opposite, locked, position, quadric, wedges, h)
        if x == x:  # of hidden faces one corner lies nowhere: see haptic_glance.lod.borders
            push(head, following, lowest, h, bucket_of(cost))


@helper
def _cost(corner, opposite, locked, position, quadric, wedges, h):
    i, j = corner[np.uint32(h)], corner[after(h)]
    if wedges is not None:
        held = i if locked[i] else j if locked[j] else np.int32(-1)
        return attribute_cost(opposite, position, quadric, wedges, h, i, j, held)
    if locked[np.uint32(i)] or locked[np.uint32(j)]:
        x, y, z = point(position, i if locked[np.uint32(i)] else j)
        return error_at(quadric, i, j, x, y, z), x, y, z
    return best_place(quadric, position, i, j)

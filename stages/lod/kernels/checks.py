"""What a collapse must not do: turn a face over, make a needle, or change what is joined to what."""

from .corners import after, before
from .jit import kernel

STEADY = 0.98  # cosine between a face's normal before and after above which its neighbours are not looked at


@kernel
def may_collapse(corner, twin, start, locked, p, mark, last, h, x, y, z, turn, shape, fold):
    """Whether the edge of half-edge h may become one vertex at x, y, z: nothing folds, and the link condition holds.

    The link condition: the ends share no neighbour but the two across the edge, and no tetrahedron closes. mark (n,)
    scratch, last (1,) the number of the last marking; turn, shape, fold: see `look_around`.
    """
    t = twin[h]
    i, j, k, m = corner[h], corner[t], corner[before(h)], corner[before(t)]
    if k == m or _shut(corner, twin, h, m) or _shut(corner, twin, t, k):
        return False
    last[0] += 1
    if locked[i]:
        mark_neighbours(corner, twin, start, mark, last[0], i)
    elif look_around(corner, twin, start, p, mark, last[0], i, j, x, y, z, turn, shape, fold) < 0:
        return False
    if locked[j]:
        shared = mark_neighbours(corner, twin, start, mark, last[0], j)
    else:
        shared = look_around(corner, twin, start, p, mark, last[0], j, i, x, y, z, turn, shape, fold)
    if shared != 2:
        return False
    return _seam_holds(corner, twin, p, i, j, h, x, y, z, fold) and _seam_holds(corner, twin, p, i, j, t, x, y, z, fold)


@kernel
def mark_neighbours(corner, twin, start, mark, tag, v):
    """Marks all vertices that an edge joins to v by `tag`; returns how many had that mark already."""
    found = 0
    h = first = start[v]
    while True:
        a = corner[after(h)]
        found += mark[a] == tag
        mark[a] = tag
        back = before(h)
        h = twin[back]
        if h < 0:
            found += mark[corner[back]] == tag
            mark[corner[back]] = tag
            return found
        if h == first:
            return found


@kernel
def _seam_holds(corner, twin, p, i, j, h, x, y, z, fold):
    """The two faces that become neighbours when the face of h goes do not fold onto each other, or one was folded."""
    one, two = twin[after(h)], twin[before(h)]
    if one < 0 or two < 0:
        return True
    ax, ay, az = _normal(corner, p, one, i, j, x, y, z)
    bx, by, bz = _normal(corner, p, two, i, j, x, y, z)
    if not _folds(ax, ay, az, bx, by, bz, fold):
        return True
    ax, ay, az = _normal(corner, p, one, -1, -1, x, y, z)
    bx, by, bz = _normal(corner, p, two, -1, -1, x, y, z)
    cx, cy, cz = _normal(corner, p, h, -1, -1, x, y, z)
    return _folds(ax, ay, az, cx, cy, cz, fold) or _folds(bx, by, bz, cx, cy, cz, fold)


@kernel
def _normal(corner, p, h, i, j, x, y, z):
    """Normal, times twice the area, of the face of h once vertices i and j are at x, y, z."""
    ax, ay, az = _place(p, corner[h], i, j, x, y, z)
    bx, by, bz = _place(p, corner[after(h)], i, j, x, y, z)
    cx, cy, cz = _place(p, corner[before(h)], i, j, x, y, z)
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


@kernel
def _place(p, v, i, j, x, y, z):
    if v in (i, j):
        return x, y, z
    return p[v, 0], p[v, 1], p[v, 2]


@kernel
def look_around(corner, twin, start, p, mark, tag, v, other, x, y, z, turn, shape, fold):
    """-1 where a face around v, but those it shares with `other`, goes bad when v moves to x, y, z.

    Bad is: turned too far, folded onto a neighbour as it was not before, or a needle. Else it marks the neighbours of v
    as `mark_neighbours` does, on the same way round. v: not at a rim. p (n, 3). turn: least cosine, above 0, between a
    face's normal before and after; shape: least quality of a face after (1 for an equilateral triangle, 0 for a
    needle), unless it was below it before and does not get worse; fold: least cosine, below 0, between the normals of
    two neighbours.
    """
    vx, vy, vz = p[v, 0], p[v, 1], p[v, 2]
    # Normals, after and before, of the face before this one and of the first.
    lx = ly = lz = mx = my = mz = fx = fy = fz = gx = gy = gz = 0.0
    found = 0
    h = first = start[v]
    a = corner[after(h)]
    ax, ay, az = p[a, 0], p[a, 1], p[a, 2]
    while True:
        found += mark[a] == tag
        mark[a] = tag
        back = before(h)
        b = corner[back]
        bx, by, bz = p[b, 0], p[b, 1], p[b, 2]
        if a == other or b == other:
            lx = ly = lz = 0.0
        else:
            ex, ey, ez = bx - ax, by - ay, bz - az
            sx, sy, sz, tx, ty, tz = ax - x, ay - y, az - z, ax - vx, ay - vy, az - vz
            nx, ny, nz = sy * ez - sz * ey, sz * ex - sx * ez, sx * ey - sy * ex
            ox, oy, oz = ty * ez - tz * ey, tz * ex - tx * ez, tx * ey - ty * ex
            new, old = nx * nx + ny * ny + nz * nz, ox * ox + oy * oy + oz * oz
            along = nx * ox + ny * oy + nz * oz
            if old > 0.0 and (along <= 0.0 or along * along < turn * turn * new * old):
                return -1
            now = _sides(sx, sy, sz, ex, ey, ez)
            if 12 * new < shape * shape * now * now:
                was = _sides(tx, ty, tz, ex, ey, ez)
                if new * was * was <= old * now * now:
                    return -1
            if _folds(nx, ny, nz, lx, ly, lz, fold) and not _folds(ox, oy, oz, mx, my, mz, fold):
                return -1
            lx, ly, lz, mx, my, mz = nx, ny, nz, ox, oy, oz
            if h == first:
                fx, fy, fz, gx, gy, gz = nx, ny, nz, ox, oy, oz
            if along * along < STEADY * STEADY * new * old:
                g = twin[after(h)]
                if g >= 0:
                    cx, cy, cz = _normal(corner, p, g, -1, -1, x, y, z)
                    if _folds(nx, ny, nz, cx, cy, cz, fold) and not _folds(ox, oy, oz, cx, cy, cz, fold):
                        return -1
        a, ax, ay, az = b, bx, by, bz
        h = twin[back]
        if h == first:
            bad = _folds(fx, fy, fz, lx, ly, lz, fold) and not _folds(gx, gy, gz, mx, my, mz, fold)
            return -1 if bad else found


@kernel
def _folds(ax, ay, az, bx, by, bz, fold):
    """Whether the cosine between two vectors lies below `fold`, which is negative."""
    along = ax * bx + ay * by + az * bz
    if along >= 0.0:
        return False
    return along * along > fold * fold * (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz)


@kernel
def _sides(ax, ay, az, ex, ey, ez):
    """The squared lengths of the sides a, e and a + e of a triangle, summed."""
    bx, by, bz = ax + ex, ay + ey, az + ez
    return ax * ax + ay * ay + az * az + bx * bx + by * by + bz * bz + ex * ex + ey * ey + ez * ez


@kernel
def _shut(corner, twin, h, opposite):
    """True where the corner across h has but three faces, and the outer one ends at the edge's other corner."""
    one, two = twin[after(h)], twin[before(h)]
    return one >= 0 and two >= 0 and corner[before(one)] == opposite and corner[before(two)] == opposite

"""The half-edge mesh while it is simplified: one edge collapse, fans, components, and counts of faults.

The corner table has the opposite of each half-edge, and one vertex per fan of faces. Half-edge 3 f + k runs from corner
k of face f to the next corner; the number is also the name of that corner.
"""

from typing import NamedTuple

import numpy as np

from haptic_glance.base.jit import greater, lesser

from .vectors import Id, between, cross, dot, helper, kernel, point


@helper
def after(h: Id) -> Id:
    """The next half-edge of the face."""
    return np.int64(np.uint32(h - 2 if np.uint32(h) % np.uint32(3) == np.uint32(2) else h + 1))


@helper
def before(h: Id) -> Id:
    """The previous half-edge of the face."""
    return np.int64(np.uint32(h + 2 if np.uint32(h) % np.uint32(3) == np.uint32(0) else h - 1))


def opposites(faces: np.ndarray, count: int, oriented: bool) -> tuple[np.ndarray, int]:
    """The opposite of each half-edge, (3 m,) i4, and how many half-edges lie on non-manifold edges.

    faces (3 m,) vertex ids below `count`. The opposite is -1 on the boundary: where one, three or more faces share the
    edge and, if `oriented`, where its two faces have opposite windings.
    """
    opposite, first = np.full(len(faces), -1, dtype=np.int32), np.full(2 * count, -1, dtype=np.int32)
    if _closed(faces, opposite, first, np.empty(len(faces), dtype=np.int32), np.zeros(count, dtype=np.int32)):
        return opposite, 0
    return _of_any(faces, count, oriented)


@kernel
def _of_any(faces, count, oriented):
    """`opposites` of faces that need not be closed."""
    opposite = np.full(len(faces), -1, dtype=np.int32)
    first, order = _by_lower_end(faces, count)
    mark = np.full(count, -1, dtype=np.int32)
    slot = np.zeros(count, dtype=np.int32)
    shared = np.zeros(count, dtype=np.int32)
    non_manifold = 0
    for low in range(count):
        for at in range(first[low], first[low + 1]):
            h = order[at]
            tail, head = faces[h], faces[after(h)]
            high = max(tail, head)
            if mark[high] != low:
                mark[high], slot[high], shared[high] = low, h, 0
            first_half = slot[high]  # of the edge, which keeps the count
            shared[high] += 1
            if shared[high] == 2 and not (oriented and faces[first_half] == tail):
                opposite[h], opposite[first_half] = first_half, h
            elif shared[high] > 3:
                non_manifold += 1
            elif shared[high] == 3:
                non_manifold += 3
                if opposite[first_half] >= 0:
                    opposite[opposite[first_half]] = -1
                    opposite[first_half] = -1
    return opposite, non_manifold


@kernel
def _closed(faces, opposite, first, following, half_edge):
    """Fills `opposite` for a closed manifold with consistent winding, else returns False.

    There each edge has one half-edge up, to the higher id, and one down. Most meshes are such: an eighth of the time.
    first (2 count,): -1, then for each vertex the last half-edge down to it and the last one up from it; following
    (3 m,): the next one of that list; half_edge (count,): zeros, then the half-edge up to each vertex.
    """
    for f in range(0, len(faces), 3):
        for k in range(3):
            tail, head = np.uint32(faces[f + k]), np.uint32(faces[f + (k + 1) % 3])
            at = 2 * tail + 1 if tail < head else 2 * head
            following[f + k] = first[at]
            first[at] = f + k
    good = True
    for low in range(len(half_edge)):
        h = first[2 * low + 1]
        while h >= 0:
            half_edge[np.uint32(faces[after(h)])] = h
            h = following[np.uint32(h)]
        h = first[2 * low]
        while h >= 0:
            high = np.uint32(faces[np.uint32(h)])
            g = np.uint32(half_edge[high])
            good &= faces[g] == low and faces[after(g)] == high and opposite[g] < 0
            opposite[g], opposite[np.uint32(h)] = h, g
            h = following[np.uint32(h)]
    return good  # each half-edge down has its own up; faces are cycles, so that none up is left over


@kernel
def _by_lower_end(faces, count):
    first = np.zeros(count + 1, dtype=np.int32)
    for h in range(len(faces)):
        first[lesser(faces[h], faces[after(h)]) + 1] += 1
    for low in range(count):
        first[low + 1] += first[low]
    place = first[:-1].copy()
    order = np.empty(len(faces), dtype=np.int32)
    for h in range(len(faces)):
        low = lesser(faces[h], faces[after(h)])
        order[place[low]] = h
        place[low] += 1
    return first, order


def fans(faces: np.ndarray, opposite: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """One vertex per fan of faces, so that vertices at which several fans touch are split.

    Returns corner (3 m,) i4: the new vertex at the tail of each half-edge; start (k,) i4: the first half-edge that
    leaves a new vertex (of an open fan the one on the boundary); source (k,) i4: the old vertex of each; boundary (k,)
    boolean: whether the fan is open.
    """
    corner = np.full(len(faces), -1, dtype=np.int32)
    start, source = np.empty((2, len(faces)), dtype=np.int32)
    boundary = np.empty(len(faces), dtype=np.bool_)
    count = _fill_fans(faces, opposite, corner, start, source, boundary)
    return corner, start[:count].copy(), source[:count].copy(), boundary[:count].copy()


@kernel
def _fill_fans(faces, opposite, corner, start, source, boundary):
    """Fills what `fans` returns; returns the number of fans."""
    count = 0
    for seed in range(len(faces)):
        if corner[seed] >= 0:
            continue
        h = seed
        while h >= 0 and corner[h] < 0:
            corner[h] = count
            h = opposite[before(h)]
        start[count], source[count], boundary[count] = seed, faces[seed], h < 0
        if h < 0:  # the fan is open: back to its other end
            h = seed
            while opposite[h] >= 0:
                h = after(opposite[h])
                corner[h] = count
            start[count] = h
        count += 1
    return count


class HalfEdgeMesh(NamedTuple):
    """A triangle mesh by half-edges; the corners of a removed face are -1."""

    corner: np.ndarray  # (3 m,) vertex at the tail of each half-edge
    opposite: np.ndarray  # (3 m,) half-edge
    start: np.ndarray  # (n,) first half-edge that leaves a vertex
    boundary: np.ndarray  # (n,) boolean
    locked: np.ndarray  # (n,) boolean
    position: np.ndarray  # (n, 3)
    quadric: np.ndarray  # (n, 10)
    parent: np.ndarray  # (n,) the vertex into which each was merged


@helper
def collapse_edge(
    corner: np.ndarray,
    opposite: np.ndarray,
    start: np.ndarray,
    boundary: np.ndarray,
    locked: np.ndarray,
    position: np.ndarray,
    quadric: np.ndarray,
    parent: np.ndarray,
    h: Id,
    x: float,
    y: float,
    z: float,
) -> tuple[Id, Id]:
    """Merges the ends of the edge of half-edge h at x, y, z; a locked end keeps its position.

    Returns a half-edge of each of the two edges that result from merging two.
    """
    t = np.int64(opposite[h])
    i, j = corner[h], corner[t]
    stays, goes = (i, j) if locked[i] else (j, i)
    g = first = start[goes]
    while True:
        corner[g] = stays
        g = opposite[before(g)]
        if g < 0 or g == first:
            break
    up, down = opposite[before(h)], opposite[before(t)]  # half-edges that leave i and j beside the two removed faces
    if start[stays] // 3 == h // 3 or start[stays] // 3 == t // 3:
        start[stays] = down if boundary[stays] and stays == i else up
    left, right = opposite[after(h)], opposite[after(t)]
    left, right = (left if left >= 0 else up), (right if right >= 0 else down)
    for g in (h, t):
        ahead, behind, across = opposite[after(g)], opposite[before(g)], corner[before(g)]
        if start[across] == before(g):
            start[across] = ahead
        if ahead >= 0:
            opposite[ahead] = behind
        if behind >= 0:
            opposite[behind] = ahead
        f = g - g % 3
        corner[f] = corner[f + 1] = corner[f + 2] = -1
    position[stays, 0], position[stays, 1], position[stays, 2] = x, y, z
    for n in range(10):
        quadric[stays, n] += quadric[goes, n]
    parent[goes] = stays
    return np.int64(left), np.int64(right)


def compact(corner: np.ndarray, locked: np.ndarray, source: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The remaining faces (3 k,) i8, and (n',) the vertex of the surface that each of their vertices is.

    corner, locked: as of a HalfEdgeMesh. source (n,): ids below `count`; locked vertices of one source become one
    vertex again.
    """
    name = np.full(count + len(source), -1, dtype=np.int64)
    faces = np.empty(len(corner), dtype=np.int64)
    used = np.empty(len(source), dtype=np.int64)
    size, ids = _name_corners(corner, locked, source, count, name, faces, used)
    return faces[:size].copy(), used[:ids].copy()


@kernel
def _name_corners(corner, locked, source, count, name, faces, used):
    """Fills what `compact` returns; returns the numbers of corners and of vertices. name: -1 for each key."""
    size = ids = 0
    for v in corner:
        if v < 0:
            continue
        key = source[v] if locked[v] else count + v
        if name[key] < 0:
            name[key], used[ids] = ids, v
            ids += 1
        faces[size] = name[key]
        size += 1
    return size, ids


def split_fans(faces: np.ndarray, opposite: np.ndarray) -> tuple[np.ndarray, int]:
    """(3 m,) i4: the fan at each corner, and the number of fans; the windings of neighbours may differ.

    faces (3 m,); opposite (3 m,): their `opposites`.
    """
    fan = np.full(len(faces), -1, dtype=np.int32)
    return fan, _fill_split_fans(faces, opposite, fan)


@kernel
def _fill_split_fans(faces, opposite, fan):
    """Fills the fans of `split_fans`, all -1 before; returns their number."""
    count = 0
    for seed in range(len(faces)):
        if fan[seed] >= 0:
            continue
        fan[seed] = count
        for side in range(2):  # to one end of the fan, then to the other; around once where it is closed
            edge, tail = (seed, True) if side == 0 else (before(seed), False)  # tail: the corner is that of the edge
            while opposite[edge] >= 0:
                across = opposite[edge]
                tail = tail == (faces[across] == faces[edge])
                corner = across if tail else after(across)
                if fan[corner] >= 0:
                    break
                fan[corner] = count
                edge, tail = (before(across), False) if tail else (corner, True)
        count += 1
    return count


def face_components(opposite: np.ndarray) -> tuple[np.ndarray, int]:
    """(m,) i4: the component, joined by edges, of each face, and their number. opposite (3 m,): see `opposites`."""
    component = np.full(len(opposite) // 3, -1, dtype=np.int32)
    return component, _fill_components(opposite, component, np.empty_like(component))


@kernel
def _fill_components(opposite, component, waiting):
    """Fills the components, all -1 before, and returns their number. waiting (m,): scratch."""
    count = 0
    for seed in range(len(component)):
        if component[seed] >= 0:
            continue
        component[seed], waiting[0], pending = count, seed, 1
        while pending:
            pending -= 1
            f = waiting[pending]
            for h in range(3 * f, 3 * f + 3):
                g = opposite[h] // 3  # -1 on the boundary
                if g >= 0 and component[g] < 0:
                    component[g], waiting[pending] = count, g
                    pending += 1
        count += 1
    return count


def signed_volumes(vertices: np.ndarray, faces: np.ndarray, opposite: np.ndarray) -> np.ndarray:
    """(k,) volume inside each component, negative where it is inside out; 0 for one with a boundary."""
    component, count = face_components(opposite)
    volume, boundary = np.zeros(count), np.zeros(count, dtype=np.bool_)
    _add_volumes(vertices, faces, opposite, component, np.full(count, -1, dtype=np.int32), volume, boundary)
    volume[boundary] = 0.0
    return volume


@kernel
def _add_volumes(vertices, faces, opposite, component, origin, volume, boundary):
    """Adds the volume under each face to that of its component. origin: -1, then a vertex of each component."""
    for f in range(len(component)):
        at = component[f]
        if origin[at] < 0:
            # a point of the component itself: from afar, small volumes would be lost to rounding
            origin[at] = faces[3 * f]
        o, i, j, k = origin[at], faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]
        ax, ay, az = between(vertices, o, i)
        bx, by, bz = between(vertices, o, j)
        cx, cy, cz = between(vertices, o, k)
        nx, ny, nz = cross(bx, by, bz, cx, cy, cz)
        volume[at] += dot(ax, ay, az, nx, ny, nz) / 6
        for h in range(3 * f, 3 * f + 3):
            boundary[at] |= opposite[h] < 0


def count_faults(
    vertices: np.ndarray, faces: np.ndarray, opposite: np.ndarray, thin: float, fold: float
) -> tuple[int, int]:
    """(degenerate faces, pairs of neighbours folded onto each other).

    faces (3 m,); opposite (3 m,): their `opposites`. thin: height of a degenerate face; fold: cosine of the normals.
    """
    return _count(vertices, faces, opposite, thin, fold, np.zeros((len(faces) // 3, 3)))


@kernel
def _count(vertices, faces, opposite, thin, fold, normal):
    """`count_faults`; normal (m, 3): zeros."""
    degenerate = folded = 0
    for f in range(len(normal)):
        i, j, k = faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]
        ux, uy, uz = between(vertices, i, j)
        vx, vy, vz = between(vertices, i, k)
        wx, wy, wz = vx - ux, vy - uy, vz - uz
        x, y, z = cross(ux, uy, uz, vx, vy, vz)
        double = np.sqrt(dot(x, y, z, x, y, z))
        sides = greater(dot(ux, uy, uz, ux, uy, uz), dot(vx, vy, vz, vx, vy, vz))
        sides = greater(sides, dot(wx, wy, wz, wx, wy, wz))
        degenerate += double <= thin * np.sqrt(sides)
        if double > 0.0:
            normal[f, 0], normal[f, 1], normal[f, 2] = x / double, y / double, z / double
    for h in range(len(faces)):
        if opposite[h] > h:
            ux, uy, uz = point(normal, h // 3)
            vx, vy, vz = point(normal, opposite[h] // 3)
            along = dot(ux, uy, uz, vx, vy, vz)
            folded += (-along if faces[h] == faces[opposite[h]] else along) < fold  # whatever the winding
    return degenerate, folded

"""The corner table: the opposite of each half-edge, and one vertex per fan of faces.

Half-edge 3 f + k runs from corner k of face f to the next; it is also the name of that corner.
"""

import numpy as np

from .jit import Id, allocating_kernel, helper, kernel

MAX_EDGES = 64  # at a vertex, to vertices of higher ids: with more of them the linear search takes too long


@helper
def after(h: Id) -> Id:
    """The next half-edge of the face."""
    return h - 2 if np.uint32(h) % np.uint32(3) == np.uint32(2) else h + 1


@helper
def before(h: Id) -> Id:
    """The previous half-edge of the face."""
    return h + 2 if np.uint32(h) % np.uint32(3) == np.uint32(0) else h - 1


def opposites(faces: np.ndarray, count: int, oriented: bool) -> tuple[np.ndarray, int]:
    """The opposite of each half-edge, (3 m,) i4, and how many half-edges lie on non-manifold edges.

    faces (3 m,) vertex ids below `count`. The opposite is -1 on the boundary: where one, three or more faces share the
    edge and, if `oriented`, where its two faces have opposite windings.
    """
    other = np.full(len(faces), -1, dtype=np.int32)
    ends = np.empty((2, len(faces) // 2), dtype=np.int32)
    if _closed(faces, other, np.zeros(count + 1, dtype=np.int32), *ends):
        return other, 0
    return _of_any(faces, count, oriented)


@allocating_kernel
def _of_any(faces, count, oriented):
    """`opposites` of faces that need not be closed."""
    other = np.full(len(faces), -1, dtype=np.int32)
    first, order = _by_lower_end(faces, count)
    seen = np.full(count, -1, dtype=np.int32)
    slot = np.zeros(count, dtype=np.int32)
    shared = np.zeros(count, dtype=np.int32)
    non_manifold = 0
    for low in range(count):
        for at in range(first[low], first[low + 1]):
            h = order[at]
            tail, head = faces[h], faces[after(h)]
            high = max(tail, head)
            if seen[high] != low:
                seen[high], slot[high], shared[high] = low, h, 0
            first_half = slot[high]  # of the edge, which keeps the count
            shared[high] += 1
            if shared[high] == 2 and not (oriented and faces[first_half] == tail):
                other[h], other[first_half] = first_half, h
            elif shared[high] > 3:
                non_manifold += 1
            elif shared[high] == 3:
                non_manifold += 3
                if other[first_half] >= 0:
                    other[other[first_half]] = -1
                    other[first_half] = -1
    return other, non_manifold


@kernel
def _closed(faces, other, first, up, high):
    """Fills `other` for a closed manifold with consistent winding, else returns False.

    There each edge has one half-edge up, to the higher id, and one down. Most meshes are such: a third of the time.
    first (count + 1,): zeros; up, high: scratch, half as long as faces.
    """
    for f in range(0, len(faces), 3):
        for k in range(3):
            tail, head = faces[f + k], faces[f + (k + 1) % 3]
            first[min(tail, head)] += tail < head
    total, count = 0, len(first) - 1
    for low in range(count):
        if first[low] > MAX_EDGES:
            return False
        total += first[low]
        first[low] = total
    first[count] = total
    if 2 * total != len(faces):
        return False
    for f in range(0, len(faces), 3):
        for k in range(3):
            tail, head = faces[f + k], faces[f + (k + 1) % 3]
            if tail < head:
                first[tail] -= 1
                up[first[tail]], high[first[tail]] = f + k, head
    good = True
    for f in range(0, len(faces), 3):
        for k in range(3):
            tail, head = faces[f + k], faces[f + (k + 1) % 3]
            if tail >= head:
                good &= _match(first, up, high, other, tail, head, f + k)
    return good


@helper
def _match(first, up, high, other, tail, head, h):
    """Pairs half-edge h with the first one from its head up to its tail; False where that already has a pair."""
    for at in range(first[head], first[head + 1]):
        if high[at] == tail:
            g = up[at]
            free = other[g] < 0
            other[h], other[g] = g, h
            return free
    return False


@allocating_kernel
def _by_lower_end(faces, count):
    first = np.zeros(count + 1, dtype=np.int32)
    for h in range(len(faces)):
        first[min(faces[h], faces[after(h)]) + 1] += 1
    for low in range(count):
        first[low + 1] += first[low]
    place = first[:-1].copy()
    order = np.empty(len(faces), dtype=np.int32)
    for h in range(len(faces)):
        low = min(faces[h], faces[after(h)])
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
        while opposite[h] >= 0:  # back to the boundary, or around once
            h = after(opposite[h])
            if h == seed:
                break
        start[count], source[count], boundary[count] = h, faces[h], opposite[h] < 0
        while corner[h] < 0:
            corner[h] = count
            h = opposite[before(h)]
            if h < 0:
                break
        count += 1
    return count

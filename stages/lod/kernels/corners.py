"""The corner table: which half-edge lies on the other side, and one vertex a fan of faces.

Half-edge 3 f + k runs from corner k of face f to the next; it is also the name of that corner.
"""

import numpy as np

from .jit import kernel

CROWD = 64  # edges at a vertex, to vertices of higher ids, above which looking through them takes too long


@kernel
def after(h):
    """The next half-edge of the face."""
    return h - 2 if np.uint32(h) % np.uint32(3) == np.uint32(2) else h + 1


@kernel
def before(h):
    """The previous half-edge of the face."""
    return h + 2 if np.uint32(h) % np.uint32(3) == np.uint32(0) else h - 1


@kernel
def partners(faces, count, oriented):
    """The half-edge on the other side of each, (3 m,) i4, and how many lie on edges that three or more faces share.

    faces (3 m,) vertex ids below `count`. The other side is -1 at a rim: where one, three or more faces share the edge
    and, if `oriented`, where its two faces disagree on which side is out.
    """
    other = np.full(len(faces), -1, dtype=np.int32)
    if _closed(faces, count, other):
        return other, 0
    other[:] = -1
    first, order = _by_lower_end(faces, count)
    seen = np.full(count, -1, dtype=np.int32)
    slot = np.zeros(count, dtype=np.int32)
    shared = np.zeros(count, dtype=np.int32)
    crowded = 0
    for low in range(count):
        for at in range(first[low], first[low + 1]):
            h = order[at]
            tail, head = faces[h], faces[after(h)]
            high = max(tail, head)
            if seen[high] != low:
                seen[high], slot[high], shared[high] = low, h, 0
            mate = slot[high]  # the first half-edge of the edge counts for all
            shared[high] += 1
            if shared[high] == 2 and not (oriented and faces[mate] == tail):
                other[h], other[mate] = mate, h
            elif shared[high] > 3:
                crowded += 1
            elif shared[high] == 3:
                crowded += 3
                if other[mate] >= 0:
                    other[other[mate]] = -1
                    other[mate] = -1
    return other, crowded


@kernel
def _closed(faces, count, other):
    """Fills `other` where each edge has one half-edge up, to the higher id, and one down; False where one has not.

    Most meshes are such, and are done in a third of the time.
    """
    first = np.zeros(count + 1, dtype=np.int32)
    for f in range(0, len(faces), 3):
        a, b, c = faces[f], faces[f + 1], faces[f + 2]
        first[min(a, b)] += a < b
        first[min(b, c)] += b < c
        first[min(c, a)] += c < a
    total = 0
    for low in range(count):
        if first[low] > CROWD:
            return False
        total += first[low]
        first[low] = total
    first[count] = total
    if 2 * total != len(faces):
        return False
    up, high = np.empty(total, dtype=np.int32), np.empty(total, dtype=np.int32)
    for f in range(0, len(faces), 3):
        a, b, c = faces[f], faces[f + 1], faces[f + 2]
        if a < b:
            _note(first, up, high, a, b, f)
        if b < c:
            _note(first, up, high, b, c, f + 1)
        if c < a:
            _note(first, up, high, c, a, f + 2)
    good = True
    for f in range(0, len(faces), 3):
        a, b, c = faces[f], faces[f + 1], faces[f + 2]
        if a >= b:
            good &= _match(first, up, high, other, a, b, f)
        if b >= c:
            good &= _match(first, up, high, other, b, c, f + 1)
        if c >= a:
            good &= _match(first, up, high, other, c, a, f + 2)
    return good


@kernel
def _note(first, up, high, tail, head, h):
    first[tail] -= 1
    up[first[tail]], high[first[tail]] = h, head


@kernel
def _match(first, up, high, other, tail, head, h):
    """Pairs half-edge h with the first that goes up from its head to its tail; False where that is not free."""
    for at in range(first[head], first[head + 1]):
        if high[at] == tail:
            g = up[at]
            free = other[g] < 0
            other[h], other[g] = g, h
            return free
    return False


@kernel
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


@kernel
def fans(faces, twin):
    """A vertex of its own for each fan of faces, where fans touch in one vertex alone.

    Returns corner (3 m,) i4: the fan at the tail of each half-edge; start (k,) i4: the first half-edge that leaves a
    fan's vertex (of an open fan that along its rim); source (k,) i4: the vertex that it was; rim (k,) boolean: open.
    """
    size = len(faces)
    corner = np.full(size, -1, dtype=np.int32)
    start = np.empty(size, dtype=np.int32)
    source = np.empty(size, dtype=np.int32)
    rim = np.zeros(size, dtype=np.bool_)
    count = 0
    for seed in range(size):
        if corner[seed] >= 0:
            continue
        h = seed
        while twin[h] >= 0:  # back to the rim, or once round
            h = after(twin[h])
            if h == seed:
                break
        start[count], source[count], rim[count] = h, faces[h], twin[h] < 0
        while corner[h] < 0:
            corner[h] = count
            h = twin[before(h)]
            if h < 0:
                break
        count += 1
    return corner, start[:count].copy(), source[:count].copy(), rim[:count].copy()

"""Edge collapses in the order of their quadric error, until the faces are few enough."""

import numpy as np

from .attributes import Wedges, attribute_cost, merge_wedges
from .checks import may_collapse
from .corners import after
from .jit import helper, kernel
from .quadrics import best_place, error_at
from .queue import BUCKETS, bucket_of, empty_queue, is_queued, pop, push
from .surface import HalfEdgeMesh, collapse_edge

LATER = 8  # buckets by which a refused collapse is put off,
GROWN = 16.0  # until the current cost has grown so many times


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
    left = 0
    for h in range(len(corner)):
        left += corner[h] >= 0
        if opposite[h] > h and corner[h] >= 0:
            _offer(corner, opposite, locked, position, quadric, wedges, head, following, lowest, h)
    left //= 3
    ones, twos, threes = 0.0, 0.0, 0.0
    for v in range(len(quadric)):
        ones, twos, threes = ones + quadric[v, 0], twos + quadric[v, 3], threes + quadric[v, 5]
    area = ones + twos + threes
    if wedges is not None:  # whose attributes are in the quadrics too
        area = 0.0
        for w in range(len(wedges.sums)):
            area += wedges.sums[w, 0]
    level = 0.0
    while left > faces:
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
        refused = (bucket - now) / LATER
        level = max(level, cost * GROWN**refused)
        cut, least = np.sqrt(level * left / area), shape * 0.1**refused
        limits = turn, least, fold, cut
        if may_collapse(corner, opposite, start, locked, position, mark, last, h, x, y, z, *limits):
            if wedges is not None:
                merge_wedges(opposite, wedges, h)
            one, two = collapse_edge(corner, opposite, start, boundary, locked, position, quadric, parent, h, x, y, z)
            for g in (one, two):
                if g >= 0 and not (is_queued(following, g) or (opposite[g] >= 0 and is_queued(following, opposite[g]))):
                    _offer(corner, opposite, locked, position, quadric, wedges, head, following, lowest, g)
            left -= 2
        elif bucket + LATER < BUCKETS:
            push(head, following, lowest, h, bucket + LATER)
    return left


@helper
def _offer(corner, opposite, locked, position, quadric, wedges, head, following, lowest, h):
    if opposite[h] >= 0 and not (locked[corner[h]] and locked[corner[after(h)]]):
        cost, x, _y, _z = _cost(corner, opposite, locked, position, quadric, wedges, h)
        if x == x:  # of hidden faces one corner lies nowhere: see stages.lod.free_borders
            push(head, following, lowest, h, bucket_of(cost))


@helper
def _cost(corner, opposite, locked, position, quadric, wedges, h):
    i, j = corner[h], corner[after(h)]
    if wedges is not None:
        held = i if locked[i] else j if locked[j] else np.int32(-1)
        return attribute_cost(opposite, position, quadric, wedges, h, i, j, held)
    if locked[i] or locked[j]:
        v = i if locked[i] else j
        x, y, z = position[v, 0], position[v, 1], position[v, 2]
        return error_at(quadric, i, j, x, y, z), x, y, z
    return best_place(quadric, position, i, j)

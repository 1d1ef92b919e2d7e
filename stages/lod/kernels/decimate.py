"""Edge collapses in the order of their quadric error, until the faces are few enough."""

import numpy as np

from .checks import may_collapse
from .corners import after
from .jit import kernel
from .quadrics import best_place, error_at
from .queue import BUCKETS, bucket_of, empty_queue, pop, push, waits
from .surface import collapse_edge

LATER = 8  # buckets that a refused collapse waits, until the cost at hand has grown sixteenfold


@kernel
def decimate(surface, faces, turn, shape, fold):
    """Collapses edges of the surface until `faces` are left, or no collapse is allowed any more; returns the count.

    turn, shape, fold: the limits of `look_around`. The cost in the queue is a lower bound, since quadrics only
    grow: an edge whose cost rose meanwhile is put back when its turn comes. So is one that was refused, further back,
    and then needles a tenth as wide are allowed: rather those on a flat place than a corner cut off.
    """
    corner, twin, start, rim, locked, position, quadric, parent = surface
    mark, last = np.zeros(len(position), dtype=np.int32), np.zeros(1, dtype=np.int32)
    head, following, lowest = empty_queue(len(corner))
    left = 0
    for h in range(len(corner)):
        left += corner[h] >= 0
        if twin[h] > h and corner[h] >= 0:
            _offer(corner, twin, locked, position, quadric, head, following, lowest, h)
    left //= 3
    while left > faces:
        h, bucket = pop(head, following, lowest)
        if h < 0:
            break
        if corner[h] < 0 or (locked[corner[h]] and locked[corner[after(h)]]):
            continue
        cost, x, y, z = _cost(corner, locked, position, quadric, h)
        now = bucket_of(cost)
        if now > bucket:
            push(head, following, lowest, h, now)
            continue
        least = shape if bucket == now else shape * 0.1 ** ((bucket - now) / LATER)
        if may_collapse(corner, twin, start, locked, position, mark, last, h, x, y, z, turn, least, fold):
            one, two = collapse_edge(corner, twin, start, rim, locked, position, quadric, parent, h, x, y, z)
            for g in (one, two):
                if g >= 0 and not (waits(following, g) or (twin[g] >= 0 and waits(following, twin[g]))):
                    _offer(corner, twin, locked, position, quadric, head, following, lowest, g)
            left -= 2
        elif bucket + LATER < BUCKETS:
            push(head, following, lowest, h, bucket + LATER)
    return left


@kernel
def _offer(corner, twin, locked, position, quadric, head, following, lowest, h):
    if twin[h] >= 0 and not (locked[corner[h]] and locked[corner[after(h)]]):
        cost = _cost(corner, locked, position, quadric, h)[0]
        push(head, following, lowest, h, bucket_of(cost))


@kernel
def _cost(corner, locked, position, quadric, h):
    i, j = corner[h], corner[after(h)]
    if locked[i] or locked[j]:
        v = i if locked[i] else j
        x, y, z = position[v, 0], position[v, 1], position[v, 2]
        return error_at(quadric, i, j, x, y, z), x, y, z
    return best_place(quadric, position, i, j)

"""A queue of half-edges by cost: buckets a few per cent wide, each a linked list, so that all it does takes one step.

head (buckets,) first half-edge of each, -1 empty; following (3 m,) the next one of the same bucket, -1 at its end, OUT
where the half-edge is in none; lowest (1,) no bucket below it holds any.
"""

import numpy as np

from .jit import kernel

BITS = 1  # of the mantissa: two buckets for each doubling of the cost
LEAST = 127 - 100  # biased exponent of the cost below which all are alike
OUT = -2
BUCKETS = (255 - LEAST) << BITS


@kernel
def empty_queue(size):
    """(head, following, lowest) for half-edges below `size`."""
    return (
        np.full(BUCKETS, -1, dtype=np.int32),
        np.full(size, OUT, dtype=np.int32),
        np.full(1, BUCKETS, dtype=np.int64),
    )


@kernel
def bucket_of(cost):
    """The bucket of a cost of 0 or more: the leading bits of the number itself, which grow as it does."""
    return max((np.float32(cost).view(np.int32) >> (23 - BITS)) - (LEAST << BITS), 0)


@kernel
def waits(following, h):
    """Whether a half-edge is in the queue."""
    return following[h] != OUT


@kernel
def push(head, following, lowest, h, bucket):
    """Puts a half-edge that does not wait yet into a bucket."""
    following[h] = head[bucket]
    head[bucket] = h
    lowest[0] = min(lowest[0], bucket)


@kernel
def pop(head, following, lowest):
    """(half-edge, its bucket) of least cost; (-1, -1) when none waits."""
    for at in range(lowest[0], BUCKETS):
        h = np.int64(head[at])
        if h >= 0:
            head[at] = following[h]
            following[h] = OUT
            lowest[0] = at
            return h, at
    lowest[0] = BUCKETS
    return -1, -1

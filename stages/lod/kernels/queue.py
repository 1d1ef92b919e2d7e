"""A priority queue of half-edges by cost: buckets, each a linked list, so that every operation takes constant time.

head (buckets,): the first half-edge of each, -1 where empty; following (3 m,): the next one of the same bucket, -1 at
the end, NOT_QUEUED where the half-edge is in none; lowest (1,): all buckets below it are empty.
"""

import numpy as np

from .jit import Id, helper

BITS = 1  # of the mantissa: two buckets for each doubling of the cost
LEAST = 127 - 100  # biased exponent of the cost below which all share a bucket
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
    return max((np.float32(cost).view(np.int32) >> (23 - BITS)) - (LEAST << BITS), 0)


@helper
def is_queued(following: np.ndarray, h: Id) -> bool:
    """Whether a half-edge is in the queue."""
    return following[h] != NOT_QUEUED


@helper
def push(head: np.ndarray, following: np.ndarray, lowest: np.ndarray, h: Id, bucket: Id) -> None:
    """Puts a half-edge that is not queued into a bucket."""
    following[h] = head[bucket]
    head[bucket] = h
    if bucket < lowest[0]:
        lowest[0] = bucket


@helper
def pop(head: np.ndarray, following: np.ndarray, lowest: np.ndarray) -> tuple[Id, Id]:
    """(half-edge, its bucket) of least cost; (-1, -1) when the queue is empty."""
    for at in range(lowest[0], BUCKETS):
        h = np.int64(head[at])
        if h >= 0:
            head[at] = following[h]
            following[h] = NOT_QUEUED
            lowest[0] = at
            return h, at
    lowest[0] = BUCKETS
    return -1, -1

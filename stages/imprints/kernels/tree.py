"""The faces of a mesh in blocks of a balanced tree of boxes: numpy, but for their order, which numba compiles."""

import numpy as np

from .jit import helper, kernel

LANES = 32  # faces in a block: four instructions of eight numbers each
NUMBERS = 10  # of a face: x, y, z of its corners, and twice its area


def face_tree(corners: np.ndarray, doubled: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(blocks (b, 320), boxes (2 b - 1, 6), children (2 b - 1,)) of the faces with corners (m, 3, 3).

    A block holds 32 faces, number by number; the last one is filled up with NaN. A node's box is its centre and half
    widths. Its children are children[node] and the next; a leaf has none and is block -1 - children[node]. A node is
    split across the longest side of the box of its faces' centres, so that all blocks but the last are full.
    """
    size, count = len(corners), -(-len(corners) // LANES)
    order, ranges = np.arange(count * LANES), np.zeros((max(2 * count - 1, 0), 2), dtype=np.int64)
    children = np.empty(len(ranges), dtype=np.int64)
    ranges[:1, 1] = count
    order_faces(np.einsum("fcx->fx", corners), order, ranges, children)  # a sixth of the time of sum(axis=1)
    order[size:] = order[size - 1 : size]  # until the boxes are made
    blocks = np.empty((count, NUMBERS, LANES))
    blocks[:, :9] = np.take(corners.reshape(-1, 9), order, axis=0).reshape(count, LANES, 9).transpose(0, 2, 1)
    blocks[:, 9] = np.take(doubled, order).reshape(count, LANES)
    boxes = _boxes(blocks[:, :9].reshape(count, 3, 3, LANES), ranges)
    blocks[-1:, :, LANES - len(order) + size :] = np.nan
    return blocks.reshape(count, NUMBERS * LANES), boxes, children


def _boxes(corners, ranges):
    """(nodes, 6): centre and half widths of the box around the blocks ranges[node, 0] up to ranges[node, 1].

    corners (blocks, corner, axis, face).
    """
    sides = []
    for least in (np.minimum, np.maximum):
        of_block = least.reduce(least(least(corners[:, 0], corners[:, 1]), corners[:, 2]), axis=2)
        of_block = np.append(of_block, of_block[-1:], axis=0)  # reduceat wants the end of each range
        sides.append(least.reduceat(of_block, ranges.ravel(), axis=0)[::2])
    low, high = sides
    return np.concatenate([(low + high) / 2, (high - low) / 2], axis=1)


@kernel
def order_faces(middles: np.ndarray, order: np.ndarray, ranges: np.ndarray, children: np.ndarray) -> None:
    """Orders the faces, and their centres (m, 3), by node, and fills the blocks and the children of all nodes.

    ranges[0] holds all blocks.
    """
    used = 1
    for node in range(len(children)):
        first, last = ranges[node, 0], ranges[node, 1]
        if last - first == 1:
            children[node] = -1 - first
            continue
        middle = (first + last) // 2
        start, stop = first * LANES, min(last * LANES, len(middles))
        split(middles, order, start, stop, middle * LANES, longest_axis(middles, start, stop))
        ranges[used, 0], ranges[used, 1] = first, middle
        ranges[used + 1, 0], ranges[used + 1, 1] = middle, last
        children[node] = used
        used += 2


@helper
def longest_axis(middles: np.ndarray, start: int, stop: int) -> int:
    """The axis along which the centres start:stop extend farthest."""
    best, widest = 0, -1.0
    for axis in range(3):
        low, high = np.inf, -np.inf
        for k in range(start, stop):
            value = middles[k, axis]
            low, high = value if value < low else low, value if value > high else high
        if high - low > widest:
            best, widest = axis, high - low
    return best


@helper
def split(middles: np.ndarray, order: np.ndarray, start: int, stop: int, middle: int, axis: int) -> None:
    """Orders the faces start:stop so that no one before `middle` lies farther along the axis than one after it."""
    low, high = start, stop - 1
    while low < high:
        pivot = middles[(low + high) // 2, axis]
        i, j = low, high
        while i <= j:
            while middles[i, axis] < pivot:
                i += 1
            while middles[j, axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                for k in range(3):
                    middles[i, k], middles[j, k] = middles[j, k], middles[i, k]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            break

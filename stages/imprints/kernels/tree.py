"""The faces of a mesh in blocks of a balanced tree of boxes, compiled by numba."""

import numpy as np

from .jit import inlined, kernel

LANES = 32  # faces in a block: four instructions of eight numbers each
NUMBERS = 10  # of a face: x, y, z of its corners, and twice its area


@kernel
def face_tree(corners: np.ndarray, doubled: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(blocks (b, 320), boxes (2 b - 1, 6), children (2 b - 1,)) of the faces with corners (m, 3, 3).

    A block holds 32 faces, number by number; the last one is filled up with NaN. A node's box is its centre and half
    widths. Its children are children[node] and the next; a leaf has none and is block -1 - children[node]. A node is
    split across the longest side of the box of its faces' centres, so that all blocks but the last are full.
    """
    count = len(corners)
    blocks = (count + LANES - 1) // LANES
    order, children = np.arange(count), np.empty(max(2 * blocks - 1, 0), dtype=np.int64)
    middles = np.empty((count, 3))
    for f in range(count):
        for axis in range(3):
            middles[f, axis] = corners[f, 0, axis] + corners[f, 1, axis] + corners[f, 2, axis]
    ranges = np.empty((max(2 * blocks, 1), 2), dtype=np.int64)
    ranges[0, 0], ranges[0, 1], used = 0, blocks, 1
    for node in range(len(children)):
        first, last = ranges[node]
        if last - first == 1:
            children[node] = -1 - first
            continue
        middle = (first + last) // 2
        start, stop = first * LANES, min(last * LANES, count)
        split(middles, order, start, stop, middle * LANES, longest_axis(middles, order, start, stop))
        ranges[used, 0], ranges[used, 1] = first, middle
        ranges[used + 1, 0], ranges[used + 1, 1] = middle, last
        children[node], used = used, used + 2
    return pack_blocks(corners, doubled, order, blocks), node_boxes(corners, order, children), children


@inlined
def longest_axis(middles: np.ndarray, order: np.ndarray, start: int, stop: int) -> int:
    """The axis along which the centres of the faces order[start:stop] extend farthest."""
    best, widest = 0, -1.0
    for axis in range(3):
        low, high = np.inf, -np.inf
        for k in range(start, stop):
            value = middles[order[k], axis]
            low, high = min(low, value), max(high, value)
        if high - low > widest:
            best, widest = axis, high - low
    return best


@inlined
def split(middles: np.ndarray, order: np.ndarray, start: int, stop: int, middle: int, axis: int) -> None:
    """Orders order[start:stop] so that no face before `middle` lies farther along the axis than one after it."""
    low, high = start, stop - 1
    while low < high:
        pivot = middles[order[(low + high) // 2], axis]
        i, j = low, high
        while i <= j:
            while middles[order[i], axis] < pivot:
                i += 1
            while middles[order[j], axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            break


@inlined
def pack_blocks(corners: np.ndarray, doubled: np.ndarray, order: np.ndarray, count: int) -> np.ndarray:
    """(count, 320): the numbers of the faces, block by block."""
    blocks = np.full((count, NUMBERS * LANES), np.nan)
    for k in range(len(order)):
        block, lane = blocks[k // LANES], k % LANES
        for corner in range(3):
            for axis in range(3):
                block[(3 * corner + axis) * LANES + lane] = corners[order[k], corner, axis]
        block[9 * LANES + lane] = doubled[order[k]]
    return blocks


@inlined
def node_boxes(corners: np.ndarray, order: np.ndarray, children: np.ndarray) -> np.ndarray:
    """(nodes, 6): centre and half widths of the box around the faces of each node."""
    low, high = np.full((len(children), 3), np.inf), np.full((len(children), 3), -np.inf)
    for node in range(len(children) - 1, -1, -1):
        child, start = children[node], (-1 - children[node]) * LANES
        for axis in range(3):
            if child > 0:
                low[node, axis] = min(low[child, axis], low[child + 1, axis])
                high[node, axis] = max(high[child, axis], high[child + 1, axis])
            else:
                for k in range(start, min(start + LANES, len(order))):
                    for corner in range(3):
                        value = corners[order[k], corner, axis]
                        low[node, axis], high[node, axis] = min(low[node, axis], value), max(high[node, axis], value)
    return np.concatenate(((low + high) / 2, (high - low) / 2), axis=1)

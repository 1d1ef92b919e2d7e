"""The faces of a mesh in blocks of a balanced tree of boxes, compiled by numba."""

import numpy as np

from .jit import inlined, kernel

LANES = 32  # faces in a block: four instructions of eight numbers each
NUMBERS = 10  # of a face: x, y, z of its corners, and twice its area


@kernel
def face_tree(corners, doubled):
    """(blocks (b, 320), boxes (2 b - 1, 6), children (2 b - 1,)) of the faces with corners (m, 3, 3).

    A block holds 32 faces, number by number; what the last one lacks is NaN. A node's box is the middle and the half
    widths; its children are children[node] and the next; a node of one block has none, it is block -1 - children[node].
    A node is cut across the longest side of the box of its faces' middles, so that all blocks but the last are full.
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
    return filled(corners, doubled, order, blocks), boxes_of(corners, order, children), children


@inlined
def longest_axis(middles, order, start, stop):
    """The axis along which the middles of the faces order[start:stop] lie farthest apart."""
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
def split(middles, order, start, stop, middle, axis):
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
def filled(corners, doubled, order, count):
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
def boxes_of(corners, order, children):
    """(nodes, 6): the middle and the half widths of the box around the faces of each node."""
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

"""Faces of a mesh as a tree of boxes, and their projection onto the plane of an array, compiled.

The frame of an array converts a point to column, row and height. The leaves of the tree are blocks of 32 faces. All 32
go through the same arithmetic at once, without a branch, up to the four cells that a face of a cell's size can cover,
and its heights there. Only faces with hits are processed one by one.
"""

from collections import namedtuple

import numpy as np

from haptic_glance.base.jit import UntilWorthCompiling, cached_njit, helper

kernel = cached_njit()


SLACK = 1e-12  # of the mesh's diagonal: how far a face extends beyond its edges, so that no column passes between two
GRAZING = 1e-12  # sine of a face's angle to the normal, below which a column has no single intersection with it

# centre (3,); right, down (3,) in cells per unit, normal (3,) in units; column, row of the centre; side 1, or -1 for
# upwards; lift, slack in units, margin the slack in cells; grazing the area in cells below which an area of 1 grazes.
Frame = namedtuple("Frame", "centre right down normal column row side lift slack margin grazing")


@helper
def frame_of(
    centre: np.ndarray,
    axes: np.ndarray,
    pitch: float,
    rows: int,
    columns: int,
    side: float,
    lift: float,
    diagonal: float,
) -> Frame:
    """The Frame of an array; for side -1 heights count down, so that what is above comes first."""
    over, slack = 1 / pitch, SLACK * (diagonal + (rows + columns) * pitch)
    return Frame(
        (centre[0], centre[1], centre[2]),
        (axes[0, 0] * over, axes[0, 1] * over, axes[0, 2] * over),
        (-axes[1, 0] * over, -axes[1, 1] * over, -axes[1, 2] * over),
        (side * axes[2, 0], side * axes[2, 1], side * axes[2, 2]),
        (columns - 1) / 2,
        (rows - 1) / 2,
        side,
        lift,
        slack,
        slack * over,
        GRAZING * over * over,
    )


@helper
def is_placed(centre: np.ndarray, axes: np.ndarray) -> bool:
    """True if the centre is finite and the axes are perpendicular unit vectors, the third the first x the second.

    A tenth more tolerant than `check_places`, which says what is wrong.
    """
    good = True
    for i in range(3):
        good = good and abs(centre[i]) < np.inf
        for j in range(3):
            product = axes[i, 0] * axes[j, 0] + axes[i, 1] * axes[j, 1] + axes[i, 2] * axes[j, 2]
            good = good and (abs(product - 1) <= 1.21e-5 if i == j else abs(product) <= 1.1e-6)
    x = axes[0, 1] * axes[1, 2] - axes[0, 2] * axes[1, 1]
    y = axes[0, 2] * axes[1, 0] - axes[0, 0] * axes[1, 2]
    z = axes[0, 0] * axes[1, 1] - axes[0, 1] * axes[1, 0]
    return good and x * axes[2, 0] + y * axes[2, 1] + z * axes[2, 2] >= 0


@helper
def along(axis: tuple[float, float, float], x: float, y: float, z: float) -> float:
    """The dot product of a vector and an axis."""
    return axis[0] * x + axis[1] * y + axis[2] * z


@helper
def half_width(axis: tuple[float, float, float], x: float, y: float, z: float) -> float:
    """The half extent along an axis of a box with half widths x, y, z."""
    return abs(axis[0]) * x + abs(axis[1]) * y + abs(axis[2]) * z


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
    order_kernel = ORDER.for_work(size)
    order_kernel(np.einsum("fcx->fx", corners), order, ranges, children)  # a sixth of the time of sum(axis=1)
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


ORDER = UntilWorthCompiling(order_faces, budget=15_000)  # faces


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


ROWS = 24  # of 32 numbers, one per face
HITS, TWICE, FIRST, LAST, TOP, BOTTOM = (LANES * k for k in range(6))  # twice the area; cells under its box
HEIGHT = LANES * 6  # and the three rows after: its heights at its first four cells
FACE = LANES * 10  # and the 13 rows after: see `crossing`
OVER_FOUR = 16.0  # hits: the face has more than four cells under its box


@helper
def min3(a: float, b: float, c: float) -> float:
    """The least of three numbers, without a branch."""
    a = b if b < a else a
    return c if c < a else a


@helper
def max3(a: float, b: float, c: float) -> float:
    """The greatest of three numbers, without a branch."""
    a = b if b > a else a
    return c if c > a else a


@helper
def crossing(face: tuple[float, ...], column: float, row: float, lift: float) -> tuple[float, float]:
    """(0 or more if the face covers the cell and is not above `lift`, its height) at a column and row.

    face: column, row and height of its first corner; changes of the weights of its second and third corner and of its
    height per column and per row; least and greatest height; tolerances of the two weights below 0 and of their sum.
    """
    u, v, w, second_u, second_v, third_u, third_v, w_u, w_v, low, high, slack_second, slack_third, max_sum = face
    du, dv = column - u, row - v
    second, third = second_u * du + second_v * dv, third_u * du + third_v * dv
    w = w + w_u * du + w_v * dv
    w = w if w > low else low
    w = w if w < high else high
    covered = min3(second + slack_second, third + slack_third, max_sum - second - third)
    return covered if w <= lift else -1.0, w


@helper
def project_corner(block: np.ndarray, k: int, frame: Frame) -> tuple[float, float, float]:
    """(column, row, height) of the corner whose x is the number k of a block."""
    x = block[k] - frame.centre[0]
    y = block[LANES + k] - frame.centre[1]
    z = block[2 * LANES + k] - frame.centre[2]
    return (
        along(frame.right, x, y, z) + frame.column,
        along(frame.down, x, y, z) + frame.row,
        along(frame.normal, x, y, z),
    )


@helper
def faces_above(block: np.ndarray, frame: Frame, floor: float) -> int:
    """How many faces of a block have a corner at the height `floor` or above it."""
    count = 0
    for f in range(LANES):
        _, _, w = project_corner(block, f, frame)
        _, _, w1 = project_corner(block, 3 * LANES + f, frame)
        _, _, w2 = project_corner(block, 6 * LANES + f, frame)
        count += 1 if max3(w, w1, w2) >= floor else 0
    return count


@helper
def store_face(out: np.ndarray, f: int, face: tuple[float, ...]) -> None:
    """Writes the 14 numbers of a face; unrolled, since a loop over them would prevent vectorisation over the faces."""
    at = FACE + f
    out[at], out[at + LANES], out[at + 2 * LANES], out[at + 3 * LANES] = face[0], face[1], face[2], face[3]
    at += 4 * LANES
    out[at], out[at + LANES], out[at + 2 * LANES], out[at + 3 * LANES] = face[4], face[5], face[6], face[7]
    at += 4 * LANES
    out[at], out[at + LANES], out[at + 2 * LANES], out[at + 3 * LANES] = face[8], face[9], face[10], face[11]
    out[at + 4 * LANES], out[at + 5 * LANES] = face[12], face[13]


@helper
def load_face(projected: np.ndarray, f: int) -> tuple[float, ...]:
    """The 14 numbers that `store_face` wrote."""
    at, far = FACE + f, FACE + 8 * LANES + f
    return (
        projected[at], projected[at + LANES], projected[at + 2 * LANES], projected[at + 3 * LANES],
        projected[at + 4 * LANES], projected[at + 5 * LANES], projected[at + 6 * LANES], projected[at + 7 * LANES],
        projected[far], projected[far + LANES], projected[far + 2 * LANES], projected[far + 3 * LANES],
        projected[far + 4 * LANES], projected[far + 5 * LANES],
    )  # fmt: skip


@kernel
def project(block: np.ndarray, frame: Frame, rows: int, columns: int, floor: float, out: np.ndarray) -> None:
    """Writes the projections of the 32 faces of a block for `raise_cells`.

    HITS is 0 for one that covers no cell, or is below the height `floor`.
    """
    last_column, last_row, reach = columns - 1.0, rows - 1.0, frame.margin
    for f in range(LANES):
        u, v, w = project_corner(block, f, frame)
        u1, v1, w1 = project_corner(block, 3 * LANES + f, frame)
        u2, v2, w2 = project_corner(block, 6 * LANES + f, frame)
        first, last = np.ceil(min3(u, u1, u2) - reach), np.floor(max3(u, u1, u2) + reach)
        top, bottom = np.ceil(min3(v, v1, v2) - reach), np.floor(max3(v, v1, v2) + reach)
        first, last = first if first > 0.0 else 0.0, last if last < last_column else last_column
        top, bottom = top if top > 0.0 else 0.0, bottom if bottom < last_row else last_row
        low, high = min3(w, w1, w2), max3(w, w1, w2)
        u1, v1, w1, u2, v2, w2 = u1 - u, v1 - v, w1 - w, u2 - u, v2 - v, w2 - w
        twice = u1 * v2 - v1 * u2
        over = 1 / twice
        margin = abs(over) * frame.margin
        face = (
            u, v, w, v2 * over, -u2 * over, -v1 * over, u1 * over,
            (w1 * v2 - w2 * v1) * over, (w2 * u1 - w1 * u2) * over, low, high,
            margin * (abs(u2) + abs(v2)), margin * (abs(u1) + abs(v1)),
            1.0 + margin * (abs(u2 - u1) + abs(v2 - v1)),
        )  # fmt: skip
        covered, out[HEIGHT + f] = crossing(face, first, top, frame.lift)
        covered_2, out[HEIGHT + LANES + f] = crossing(face, first + 1, top, frame.lift)
        covered_3, out[HEIGHT + 2 * LANES + f] = crossing(face, first, top + 1, frame.lift)
        covered_4, out[HEIGHT + 3 * LANES + f] = crossing(face, first + 1, top + 1, frame.lift)
        wide, tall = last - first, bottom - top
        hits = 1.0 if covered >= 0 else 0.0
        hits += 2.0 if min3(covered_2, wide - 1, wide - 1) >= 0 else 0.0
        hits += 4.0 if min3(covered_3, tall - 1, tall - 1) >= 0 else 0.0
        hits += 8.0 if min3(covered_4, wide - 1, tall - 1) >= 0 else 0.0
        hits = hits if max3(wide, tall, 0.0) <= 1.0 else OVER_FOUR
        hits = hits if min3(wide, tall, min3(frame.lift - low, high - floor, high - floor)) >= 0 else 0.0
        out[HITS + f] = hits if abs(twice) > frame.grazing * block[9 * LANES + f] else 0.0  # false for NaN
        out[TWICE + f] = twice
        out[FIRST + f], out[LAST + f], out[TOP + f], out[BOTTOM + f] = first, last, top, bottom
        store_face(out, f, face)


@kernel
def raise_cells(projected: np.ndarray, frame: Frame, best: np.ndarray, back: np.ndarray, highest: float) -> float:
    """Raises best (rows, cols) to the heights that `project` wrote; back: if the face is seen from its back.

    Returns the highest of these and of `highest`.

    Of two faces at one height the one seen from its back counts, in any order: where one part stands on another, its
    inside is above both.
    """
    for f in range(LANES):
        hits = int(projected[HITS + f])
        if hits == 0:
            continue
        from_back = (
            projected[TWICE + f] * frame.side > 0
        )  # rows count down, so that a face seen from its front turns back
        i, j = int(projected[TOP + f]), int(projected[FIRST + f])
        if hits < OVER_FOUR:
            for k in range(4):
                if hits >> k & 1:
                    height = projected[HEIGHT + k * LANES + f]
                    highest = max(highest, height)
                    raise_cell(best, back, i + (k >> 1), j + (k & 1), height, from_back)
            continue
        face = load_face(projected, f)
        for row in range(i, int(projected[BOTTOM + f]) + 1):
            for column in range(j, int(projected[LAST + f]) + 1):
                covered, height = crossing(face, column, row, frame.lift)
                if covered >= 0:
                    highest = max(highest, height)
                    raise_cell(best, back, row, column, height, from_back)
    return highest


@helper
def raise_cell(best: np.ndarray, back: np.ndarray, i: int, j: int, height: float, from_back: bool) -> None:
    """Stores the height of a face in the column of a cell, if it is the highest so far."""
    row, column = np.uint32(i), np.uint32(j)  # never negative, and so without a test for it
    if height > best[row, column] or (height == best[row, column] and from_back):
        best[row, column] = height
        back[row, column] = from_back

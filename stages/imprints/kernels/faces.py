"""The faces of one block laid into the plane of an array, compiled by numba.

All 32 faces go through the same arithmetic at once, without a branch, down to the four cells that a face of a cell's
size can cover: which of them, and how high. Only what was hit is looked at face by face.
"""

import numpy as np

from .frame import along
from .jit import inlined, kernel
from .tree import LANES

ROWS = 24  # of 32 numbers, one a face
HITS, TWICE, FIRST, LAST, TOP, BOTTOM = (LANES * k for k in range(6))  # area in cells times two; cells under its box
HEIGHT = LANES * 6  # and the three rows after: how high it passes its first four cells
FACE = LANES * 10  # and the 13 rows after: see `crossing`
MANY = 16.0  # hits: the face has more than four cells under its box


@inlined
def least(a, b, c):
    """The least of three, without a branch."""
    a = b if b < a else a
    return c if c < a else a


@inlined
def most(a, b, c):
    """The greatest of three, without a branch."""
    a = b if b > a else a
    return c if c > a else a


@inlined
def crossing(face, column, row, lift):
    """(0 or more where the face covers the cell not above `lift`, how high it passes) at a column and row.

    face: column, row, height of its first corner; how the weights of its second and third corner and its height change
    by a column and by a row; least and greatest height; how far under 0 the two weights and over 1 their sum may be.
    """
    u, v, w, second_u, second_v, third_u, third_v, w_u, w_v, low, high, spare_second, spare_third, most_both = face
    du, dv = column - u, row - v
    second, third = second_u * du + second_v * dv, third_u * du + third_v * dv
    w = w + w_u * du + w_v * dv
    w = w if w > low else low
    w = w if w < high else high
    covered = least(second + spare_second, third + spare_third, most_both - second - third)
    return covered if w <= lift else -1.0, w


@inlined
def corner_in(block, k, frame):
    """(column, row, height) of the corner whose x is the number k of a block."""
    x = block[k] - frame.centre[0]
    y = block[LANES + k] - frame.centre[1]
    z = block[2 * LANES + k] - frame.centre[2]
    return (
        along(frame.right, x, y, z) + frame.column,
        along(frame.down, x, y, z) + frame.row,
        along(frame.normal, x, y, z),
    )


@inlined
def keep(out, f, face):
    """Writes the 14 numbers of a face; spelt out, since a loop over them would keep eight faces from going at once."""
    at = FACE + f
    out[at], out[at + LANES], out[at + 2 * LANES], out[at + 3 * LANES] = face[0], face[1], face[2], face[3]
    at += 4 * LANES
    out[at], out[at + LANES], out[at + 2 * LANES], out[at + 3 * LANES] = face[4], face[5], face[6], face[7]
    at += 4 * LANES
    out[at], out[at + LANES], out[at + 2 * LANES], out[at + 3 * LANES] = face[8], face[9], face[10], face[11]
    out[at + 4 * LANES], out[at + 5 * LANES] = face[12], face[13]


@inlined
def kept(known, f):
    """The 14 numbers that `keep` wrote."""
    at, far = FACE + f, FACE + 8 * LANES + f
    return (
        known[at], known[at + LANES], known[at + 2 * LANES], known[at + 3 * LANES],
        known[at + 4 * LANES], known[at + 5 * LANES], known[at + 6 * LANES], known[at + 7 * LANES],
        known[far], known[far + LANES], known[far + 2 * LANES], known[far + 3 * LANES],
        known[far + 4 * LANES], known[far + 5 * LANES],
    )  # fmt: skip


@kernel
def project(block, frame, rows, columns, out):
    """Writes what `tell` must know of the 32 faces of a block; HITS is 0 for a face that covers no cell."""
    last_column, last_row = columns - 1.0, rows - 1.0
    for f in range(LANES):
        u, v, w = corner_in(block, f, frame)
        u1, v1, w1 = corner_in(block, 3 * LANES + f, frame)
        u2, v2, w2 = corner_in(block, 6 * LANES + f, frame)
        first, last = np.ceil(least(u, u1, u2) - frame.margin), np.floor(most(u, u1, u2) + frame.margin)
        top, bottom = np.ceil(least(v, v1, v2) - frame.margin), np.floor(most(v, v1, v2) + frame.margin)
        first, last = first if first > 0.0 else 0.0, last if last < last_column else last_column
        top, bottom = top if top > 0.0 else 0.0, bottom if bottom < last_row else last_row
        low, high = least(w, w1, w2), most(w, w1, w2)
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
        hits += 2.0 if least(covered_2, wide - 1, wide - 1) >= 0 else 0.0
        hits += 4.0 if least(covered_3, tall - 1, tall - 1) >= 0 else 0.0
        hits += 8.0 if least(covered_4, wide - 1, tall - 1) >= 0 else 0.0
        hits = hits if most(wide, tall, 0.0) <= 1.0 else MANY
        hits = hits if least(wide, tall, frame.lift - low) >= 0 else 0.0
        out[HITS + f] = hits if abs(twice) > frame.grazing * block[9 * LANES + f] else 0.0  # the last one: not if NaN
        out[TWICE + f] = twice
        out[FIRST + f], out[LAST + f], out[TOP + f], out[BOTTOM + f] = first, last, top, bottom
        keep(out, f, face)


@kernel
def tell(known, frame, best, back):
    """Tells the cells of best (rows, cols) how high the faces pass that `project` knows, and if seen from their back.

    Of two faces at one height the one seen from its back counts, whatever their order: where one part stands on another
    its inside is above both.
    """
    for f in range(LANES):
        hits = int(known[HITS + f])
        if hits == 0:
            continue
        from_back = known[TWICE + f] * frame.side > 0  # rows count down, so that a face seen from its front turns back
        i, j = int(known[TOP + f]), int(known[FIRST + f])
        if hits < MANY:
            if hits & 1:
                raise_cell(best, back, i, j, known[HEIGHT + f], from_back)
            if hits & 2:
                raise_cell(best, back, i, j + 1, known[HEIGHT + LANES + f], from_back)
            if hits & 4:
                raise_cell(best, back, i + 1, j, known[HEIGHT + 2 * LANES + f], from_back)
            if hits & 8:
                raise_cell(best, back, i + 1, j + 1, known[HEIGHT + 3 * LANES + f], from_back)
            continue
        face = kept(known, f)
        for row in range(i, int(known[BOTTOM + f]) + 1):
            for column in range(j, int(known[LAST + f]) + 1):
                covered, height = crossing(face, column, row, frame.lift)
                if covered >= 0:
                    raise_cell(best, back, row, column, height, from_back)


@inlined
def raise_cell(best, back, i, j, height, from_back):
    """Takes note of a face in the column of a cell, if it is the highest so far."""
    if height > best[i, j] or (height == best[i, j] and from_back):
        best[i, j] = height
        back[i, j] = from_back

"""The faces of one block projected onto the plane of an array, compiled by numba.

All 32 faces go through the same arithmetic at once, without a branch, up to the four cells that a face of a cell's size
can cover, and its heights there. Only faces with hits are processed one by one.
"""

import numpy as np

from .frame import Frame, along
from .jit import helper, kernel
from .tree import LANES

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
def project(block: np.ndarray, frame: Frame, rows: int, columns: int, out: np.ndarray) -> None:
    """Writes the projections of the 32 faces of a block for `raise_cells`; HITS is 0 for one that covers no cell."""
    last_column, last_row = columns - 1.0, rows - 1.0
    for f in range(LANES):
        u, v, w = project_corner(block, f, frame)
        u1, v1, w1 = project_corner(block, 3 * LANES + f, frame)
        u2, v2, w2 = project_corner(block, 6 * LANES + f, frame)
        first, last = np.ceil(min3(u, u1, u2) - frame.margin), np.floor(max3(u, u1, u2) + frame.margin)
        top, bottom = np.ceil(min3(v, v1, v2) - frame.margin), np.floor(max3(v, v1, v2) + frame.margin)
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
        hits = hits if min3(wide, tall, frame.lift - low) >= 0 else 0.0
        out[HITS + f] = hits if abs(twice) > frame.grazing * block[9 * LANES + f] else 0.0  # false for NaN
        out[TWICE + f] = twice
        out[FIRST + f], out[LAST + f], out[TOP + f], out[BOTTOM + f] = first, last, top, bottom
        store_face(out, f, face)


@kernel
def raise_cells(projected: np.ndarray, frame: Frame, best: np.ndarray, back: np.ndarray) -> None:
    """Raises best (rows, cols) to the heights that `project` wrote; back: if the face is seen from its back.

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
                    raise_cell(best, back, i + (k >> 1), j + (k & 1), projected[HEIGHT + k * LANES + f], from_back)
            continue
        face = load_face(projected, f)
        for row in range(i, int(projected[BOTTOM + f]) + 1):
            for column in range(j, int(projected[LAST + f]) + 1):
                covered, height = crossing(face, column, row, frame.lift)
                if covered >= 0:
                    raise_cell(best, back, row, column, height, from_back)


@helper
def raise_cell(best: np.ndarray, back: np.ndarray, i: int, j: int, height: float, from_back: bool) -> None:
    """Stores the height of a face in the column of a cell, if it is the highest so far."""
    if height > best[i, j] or (height == best[i, j] and from_back):
        best[i, j] = height
        back[i, j] = from_back

"""Distances of the cells of flat arrays to a surface, compiled by numba.

No ray is cast: faces are laid into the array's plane, and each tells the cells under it how high it passes. The tree of
faces is gone through from the plane outwards, so that what is hidden behind faces already found is left out a box at a
time. All in double precision; a column through an edge meets at least one of its faces.
"""

import numpy as np

from .faces import ROWS, project, tell
from .frame import along, frame_of, half_width
from .jit import inlined, kernel
from .tree import LANES

LOOKED = 64  # cells under a box, up to which it pays to look whether all are hidden from it
DEEP = 64  # levels of a tree: more than any memory holds


@kernel
def measure(blocks, boxes, children, diagonal, lift, cells, centres, axes, pitches):
    """(k, rows, cols) signed distances of arrays at centres (k, 3) with axes (k, 3, 3), inf where missed.

    blocks, boxes, children: the face_tree; lift: how far off the plane a face may lie and still be met on either side.
    """
    rows, columns = cells
    found = np.empty((len(centres), rows, columns))
    above, back, out = np.empty(cells), np.empty(cells, dtype=np.bool_), np.empty(cells, dtype=np.bool_)
    stack, known = np.empty(DEEP, dtype=np.int64), np.empty(ROWS * LANES)
    for k in range(len(centres)):
        below = found[k]
        below[:], back[:], out[:] = -np.inf, False, False
        frame = frame_of(centres[k], axes[k], pitches[k], rows, columns, 1.0, lift, diagonal)
        search(blocks, boxes, children, frame, stack, known, below, back)
        if maybe_inside(back, above):
            frame = frame_of(centres[k], axes[k], pitches[k], rows, columns, -1.0, lift, diagonal)
            search(blocks, boxes, children, frame, stack, known, above, out)
        for i in range(rows):
            for j in range(columns):
                below[i, j] = above[i, j] if out[i, j] else -below[i, j]
    return found


@inlined
def maybe_inside(back, above):
    """Whether any cell sees the face below it from the back, and so must look up: above is -inf there, else inf."""
    some = False
    for i in range(len(back)):
        for j in range(back.shape[1]):
            some = some or back[i, j]
            above[i, j] = -np.inf if back[i, j] else np.inf
    return some


@kernel
def search(blocks, boxes, children, frame, stack, known, best, back):
    """Raises best (rows, cols) to the height of the highest face not above `lift`, and says if it is seen from back.

    A cell that begins at inf asks for nothing. The nearer child, by the height of its middle, comes first: with the
    answer known beforehand hardly a box less is opened.
    """
    rows, columns = best.shape
    size, stack[0] = 1, 0
    while size > 0:
        size -= 1
        node = stack[size]
        x, y, z = from_centre(boxes, node, frame)
        wx, wy, wz = boxes[node, 3], boxes[node, 4], boxes[node, 5]
        height, room = along(frame.normal, x, y, z), half_width(frame.normal, wx, wy, wz) + frame.slack
        if height - room > frame.lift:
            continue
        u, reach_u = along(frame.right, x, y, z) + frame.column, half_width(frame.right, wx, wy, wz) + frame.margin
        v, reach_v = along(frame.down, x, y, z) + frame.row, half_width(frame.down, wx, wy, wz) + frame.margin
        first, last = max(np.ceil(u - reach_u), 0.0), min(np.floor(u + reach_u), columns - 1.0)
        top, bottom = max(np.ceil(v - reach_v), 0.0), min(np.floor(v + reach_v), rows - 1.0)
        if first > last or top > bottom:
            continue
        if (last - first + 1) * (bottom - top + 1) <= LOOKED:
            hidden = True
            for i in range(int(top), int(bottom) + 1):
                for j in range(int(first), int(last) + 1):
                    hidden = hidden and best[i, j] > height + room
            if hidden:
                continue
        child = children[node]
        if child < 0:
            project(blocks[-1 - child], frame, rows, columns, known)
            tell(known, frame, best, back)
            continue
        x, y, z = from_centre(boxes, child, frame)
        one = abs(along(frame.normal, x, y, z))
        x, y, z = from_centre(boxes, child + 1, frame)
        nearer = 0 if one < abs(along(frame.normal, x, y, z)) else 1
        stack[size], stack[size + 1] = child + 1 - nearer, child + nearer
        size += 2


@inlined
def from_centre(boxes, node, frame):
    """The middle of a node's box, seen from the array's centre."""
    return boxes[node, 0] - frame.centre[0], boxes[node, 1] - frame.centre[1], boxes[node, 2] - frame.centre[2]

"""Distances of the cells of flat arrays to a surface, and the depth to which a load presses the array, compiled.

No ray is cast: faces are projected onto the array's plane, and each writes its height to the cells under it. The tree
of faces is traversed from the plane outwards, so that boxes hidden behind faces already found are skipped. All numbers
are in double precision. A column through an edge hits at least one of its faces. A load presses a bed of springs.
"""

import numpy as np

from haptic_glance.base.jit import UntilWorthCompiling, helper

from .faces import (
    LANES,
    ROWS,
    Frame,
    along,
    faces_above,
    frame_of,
    half_width,
    is_placed,
    kernel,
    project,
    raise_cells,
)

MAX_CHECKED = 64  # cells under a box, up to which it pays to check if all of them hide it
DEEP = 64  # levels of a tree: more than fit into any memory


@kernel
def measure(
    blocks: np.ndarray,
    boxes: np.ndarray,
    children: np.ndarray,
    diagonal: float,
    lift: float,
    cells: tuple[int, int],
    centres: np.ndarray,
    axes: np.ndarray,
    pitches: np.ndarray,
    sheet: bool,
) -> np.ndarray:
    """(k, rows, cols) signed distances of arrays at centres (k, 3) with axes (k, 3, 3), inf where missed.

    blocks, boxes, children: the face_tree; lift: the distance from the plane within which a face counts on both sides.
    sheet: whether a cell with nothing below may be inside the object, whose other side was not measured.
    """
    rows, columns = cells
    distances = np.empty((len(centres), rows, columns))
    above, back, out = np.empty(cells), np.empty(cells, dtype=np.bool_), np.empty(cells, dtype=np.bool_)
    stack, projected = np.empty(DEEP, dtype=np.int64), np.empty(ROWS * LANES)
    for k in range(len(centres)):
        below = distances[k]
        below[:], back[:], out[:] = -np.inf, False, False
        frame = frame_of(centres[k], axes[k], pitches[k], rows, columns, 1.0, lift, diagonal)
        search(blocks, boxes, children, frame, cells, stack, projected, below, back, np.inf)
        if maybe_inside(back, below, sheet, above):
            frame = frame_of(centres[k], axes[k], pitches[k], rows, columns, -1.0, lift, diagonal)
            search(blocks, boxes, children, frame, cells, stack, projected, above, out, np.inf)
        for i in range(rows):
            for j in range(columns):
                below[i, j] = above[i, j] if out[i, j] else -below[i, j]
    return distances


@kernel
def first_below(
    blocks: np.ndarray,
    boxes: np.ndarray,
    children: np.ndarray,
    diagonal: float,
    lift: float,
    cells: tuple[int, int],
    centres: np.ndarray,
    axes: np.ndarray,
    pitches: np.ndarray,
    window: float,
) -> np.ndarray:
    """(k, rows, cols) distances to the first surface below arrays, as `measure`'s but of either side of a face.

    inf where it is missed, or more than `window` below the nearest of the array: what is deeper need not be searched.
    """
    rows, columns = cells
    distances, back = np.empty((len(centres), rows, columns)), np.empty(cells, dtype=np.bool_)
    stack, projected = np.empty(DEEP, dtype=np.int64), np.empty(ROWS * LANES)
    for k in range(len(centres)):
        below = distances[k]
        below[:], back[:] = -np.inf, False
        frame = frame_of(centres[k], axes[k], pitches[k], rows, columns, 1.0, lift, diagonal)
        lowest = search(blocks, boxes, children, frame, cells, stack, projected, below, back, window) - window
        for i in range(rows):
            for j in range(columns):
                below[i, j] = -below[i, j] if below[i, j] >= lowest else np.inf
    return distances


@kernel
def press(
    blocks: np.ndarray,
    boxes: np.ndarray,
    children: np.ndarray,
    diagonal: float,
    lift: float,
    cells: tuple[int, int],
    centres: np.ndarray,
    axes: np.ndarray,
    pitch: float,
    unit: float,
    stiffness: float,
    limit: float,
    loads: np.ndarray,
    depths: np.ndarray,
) -> np.ndarray:
    """(k, rows, cols) newtons on the cells of arrays pressed to depths (k,), or to loads (k,) if there are any.

    `force.gaps_at` and `force.forces` in one pass, bit for bit. stiffness: of a cell, in newtons a metre; limit: as in
    `depths_of_loads`. Writes the depths of loads to `depths`, and NaN for a touch that is invalid and left out.
    """
    rows, columns = cells
    forces, back = np.empty((len(centres), rows, columns)), np.empty(cells, dtype=np.bool_)
    stack, projected = np.empty(DEEP, dtype=np.int64), np.empty(ROWS * LANES)
    start, near, weight = np.empty(3), np.empty(rows * columns), np.empty(rows * columns)
    reach, within, loaded = max(rows, columns) * pitch, 0.0, len(loads) > 0
    for k in range(len(centres)):
        valid = loads[k] > 0 if loaded else depths[k] >= 0
        depths[k] = limit if loaded else depths[k]
        if not (valid and is_placed(centres[k], axes[k])):
            depths[k] = np.nan
        elif depths[k] > within:
            within = depths[k]
    window = within / unit
    for k in range(len(centres)):
        if not depths[k] >= 0:
            continue
        felt = forces[k]
        for i in range(rows):
            for j in range(columns):
                felt[i, j], back[i, j] = -np.inf, False
        for axis in range(3):
            start[axis] = centres[k, axis] + reach * axes[k, 2, axis]
        frame = frame_of(start, axes[k], pitch, rows, columns, 1.0, lift, diagonal)
        highest = search(blocks, boxes, children, frame, cells, stack, projected, felt, back, window)
        first = (-highest - reach) * unit if highest > -np.inf else 0.0
        for i in range(rows):
            for j in range(columns):
                gap = (-felt[i, j] - reach) * unit - first
                felt[i, j] = gap if felt[i, j] >= highest - window else np.inf
        if loaded:
            size = 0
            for i in range(rows):
                for j in range(columns):
                    if felt[i, j] <= limit:
                        near[size], weight[size] = felt[i, j], stiffness
                        size += 1
            depths[k] = depth_of_load(near, weight, size, loads[k])
        for i in range(rows):
            for j in range(columns):
                pressed = depths[k] - felt[i, j]
                felt[i, j] = (pressed if pressed > 0 else 0.0) * stiffness
    return forces


MEASURE = UntilWorthCompiling(measure, budget=12_800)  # cells: 50 arrays of 16 x 16
FIRST_BELOW = UntilWorthCompiling(first_below, budget=12_800)
PRESS = UntilWorthCompiling(press, budget=12_800)


@helper
def maybe_inside(back: np.ndarray, below: np.ndarray, sheet: bool, above: np.ndarray) -> bool:
    """True if any cell must search upwards: above is -inf there, else inf.

    A cell that sees the face below from the back, and in a sheet also a cell with no face below.
    """
    any_inside = False
    for i in range(len(back)):
        for j in range(back.shape[1]):
            inside = back[i, j] or (sheet and below[i, j] == -np.inf)
            any_inside = any_inside or inside
            above[i, j] = -np.inf if inside else np.inf
    return any_inside


@kernel
def search(
    blocks: np.ndarray,
    boxes: np.ndarray,
    children: np.ndarray,
    frame: Frame,
    cells: tuple[int, int],
    stack: np.ndarray,
    projected: np.ndarray,
    best: np.ndarray,
    back: np.ndarray,
    window: float,
) -> float:
    """Raises best to the height of the highest face not above `lift`; back: if it is seen from its back.

    Returns the highest of all. Faces deeper than `window` below the highest are not searched, nor, without a window, a
    cell that begins at inf. The nearer child, by the height of its centre, comes first. A perfect order would hardly
    save a box.
    """
    rows, columns = cells
    reach = frame.margin
    size, stack[0], highest = min(1, len(children)), 0, -np.inf
    while size > 0:
        size -= 1
        node = np.uint32(stack[size])
        x, y, z = from_centre(boxes, node, frame)
        wx, wy, wz = boxes[node, 3], boxes[node, 4], boxes[node, 5]
        height, extent = along(frame.normal, x, y, z), half_width(frame.normal, wx, wy, wz) + frame.slack
        floor = highest - window
        if height - extent > frame.lift or height + extent < floor:
            continue
        u, extent_u = along(frame.right, x, y, z) + frame.column, half_width(frame.right, wx, wy, wz) + reach
        v, extent_v = along(frame.down, x, y, z) + frame.row, half_width(frame.down, wx, wy, wz) + reach
        first, last = max(np.ceil(u - extent_u), 0.0), min(np.floor(u + extent_u), columns - 1.0)
        top, bottom = max(np.ceil(v - extent_v), 0.0), min(np.floor(v + extent_v), rows - 1.0)
        if first > last or top > bottom:
            continue
        if window == np.inf and (last - first + 1) * (bottom - top + 1) <= MAX_CHECKED:
            hidden = True
            for i in range(int(top), int(bottom) + 1):
                for j in range(int(first), int(last) + 1):
                    if not best[i, j] > height + extent:
                        hidden = False
                        break
                if not hidden:
                    break
            if hidden:
                continue
        child = children[node]
        if child < 0:
            if faces_above(blocks[-1 - child], frame, floor):
                project(blocks[-1 - child], frame, rows, columns, floor, projected)
                highest = raise_cells(projected, frame, best, back, highest)
            continue
        x, y, z = from_centre(boxes, child, frame)
        away = abs(along(frame.normal, x, y, z))
        x, y, z = from_centre(boxes, child + 1, frame)
        nearer = 0 if away < abs(along(frame.normal, x, y, z)) else 1
        stack[size], stack[size + 1] = child + 1 - nearer, child + nearer
        size += 2
    return highest


@helper
def from_centre(boxes: np.ndarray, node: np.integer | np.ndarray, frame: Frame) -> tuple[float, float, float]:
    """The centre of a node's box, relative to the array's centre."""
    node = np.uint32(node)
    return boxes[node, 0] - frame.centre[0], boxes[node, 1] - frame.centre[1], boxes[node, 2] - frame.centre[2]


@kernel
def depths_of_loads(gaps: np.ndarray, weights: np.ndarray, loads: np.ndarray, limit: float) -> np.ndarray:
    """(k,) depths d, from each row's least gap, at which sum(weights * max(d - gap, 0)) is the load; inf without a gap.

    gaps (k, n), inf where there is nothing; weights (n,), 0 or more; loads (k,), above 0. Springs farther than `limit`
    are left out: a depth above it is too deep, whatever its value. The sum is convex and piecewise linear in d, so that
    Newton's method from above ends at the exact root: springs that are out of contact stay out (Michelot 1986).
    """
    depths, near, weight = np.empty(len(gaps)), np.empty(gaps.shape[1]), np.empty(gaps.shape[1])
    for k in range(len(gaps)):
        first = np.inf
        for gap in gaps[k]:
            first = min(first, gap)
        size = 0
        for j in range(gaps.shape[1]):
            if gaps[k, j] - first <= limit and weights[j] > 0:
                near[size], weight[size] = gaps[k, j] - first, weights[j]
                size += 1
        depths[k] = depth_of_load(near, weight, size, loads[k])
    return depths


@helper
def depth_of_load(near: np.ndarray, weight: np.ndarray, size: int, load: float) -> float:
    """The depth at which the first `size` springs bear the load, inf without any; overwrites `near` and `weight`."""
    count, depth = -1, np.inf
    while count != size:
        size = size if count < 0 else count
        total, moment, count = 0.0, 0.0, 0
        for j in range(size):
            total += weight[j]
            moment += weight[j] * near[j]
        depth = (load + moment) / total
        for j in range(size):
            if near[j] <= depth:
                near[count], weight[count] = near[j], weight[j]
                count += 1
    return depth

"""The half-edge mesh while it is simplified, and one edge collapse on it."""

from typing import NamedTuple

import numpy as np

from .corners import after, before
from .jit import Id, helper, kernel


class HalfEdgeMesh(NamedTuple):
    """A triangle mesh by half-edges; the corners of a removed face are -1."""

    corner: np.ndarray  # (3 m,) vertex at the tail of each half-edge
    opposite: np.ndarray  # (3 m,) half-edge
    start: np.ndarray  # (n,) first half-edge that leaves a vertex
    boundary: np.ndarray  # (n,) boolean
    locked: np.ndarray  # (n,) boolean
    position: np.ndarray  # (n, 3)
    quadric: np.ndarray  # (n, 10)
    parent: np.ndarray  # (n,) the vertex into which each was merged


@helper
def collapse_edge(
    corner: np.ndarray,
    opposite: np.ndarray,
    start: np.ndarray,
    boundary: np.ndarray,
    locked: np.ndarray,
    position: np.ndarray,
    quadric: np.ndarray,
    parent: np.ndarray,
    h: Id,
    x: float,
    y: float,
    z: float,
) -> tuple[Id, Id]:
    """Merges the ends of the edge of half-edge h at x, y, z; a locked end keeps its position.

    Returns a half-edge of each of the two edges that result from merging two.
    """
    t = np.int64(opposite[h])
    i, j = corner[h], corner[t]
    stays, goes = (i, j) if locked[i] else (j, i)
    g = first = start[goes]
    while True:
        corner[g] = stays
        g = opposite[before(g)]
        if g < 0 or g == first:
            break
    up, down = opposite[before(h)], opposite[before(t)]  # half-edges that leave i and j beside the two removed faces
    if start[stays] // 3 == h // 3 or start[stays] // 3 == t // 3:
        start[stays] = down if boundary[stays] and stays == i else up
    left, right = opposite[after(h)], opposite[after(t)]
    left, right = (left if left >= 0 else up), (right if right >= 0 else down)
    for g in (h, t):
        one, two, across = opposite[after(g)], opposite[before(g)], corner[before(g)]
        if start[across] == before(g):
            start[across] = one
        if one >= 0:
            opposite[one] = two
        if two >= 0:
            opposite[two] = one
        f = g - g % 3
        corner[f] = corner[f + 1] = corner[f + 2] = -1
    position[stays, 0], position[stays, 1], position[stays, 2] = x, y, z
    for n in range(10):
        quadric[stays, n] += quadric[goes, n]
    parent[goes] = stays
    return np.int64(left), np.int64(right)


def compact(corner: np.ndarray, locked: np.ndarray, source: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The remaining faces (3 k,) i8, and (n',) the vertex of the surface that each of their vertices is.

    corner, locked: as of a HalfEdgeMesh. source (n,): ids below `count`; locked vertices of one source become one
    vertex again.
    """
    name = np.full(count + len(source), -1, dtype=np.int64)
    faces = np.empty(len(corner), dtype=np.int64)
    used = np.empty(len(source), dtype=np.int64)
    size, ids = _name_corners(corner, locked, source, count, name, faces, used)
    return faces[:size].copy(), used[:ids].copy()


@kernel
def _name_corners(corner, locked, source, count, name, faces, used):
    """Fills what `compact` returns; returns the numbers of corners and of vertices. name: -1 for each key."""
    size = ids = 0
    for v in corner:
        if v < 0:
            continue
        key = source[v] if locked[v] else count + v
        if name[key] < 0:
            name[key], used[ids] = ids, v
            ids += 1
        faces[size] = name[key]
        size += 1
    return size, ids

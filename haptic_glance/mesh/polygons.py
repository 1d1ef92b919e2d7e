"""Polygons of a file that a fan about the first corner would fold, since they are concave, as rings without a fold."""

from collections.abc import Sequence

import numpy as np

ROUNDING = 1e-9  # of the area: a corner on a straight edge may seem concave
FLAT = 0.05  # of the extent: corners farther from the plane leave open which diagonal was meant

FEW_CORNERS = "faces of fewer than three corners"  # which are lines and points, as a warning counts them
Rings = list[tuple[int, ...]]


def refined(ids: np.ndarray, sizes: np.ndarray, vertices: np.ndarray) -> dict[int, Rings]:
    """{number of a polygon: rings of its corners} of those that are concave and whose fan has a flipped triangle.

    ids: the vertices of all polygons (their sizes in sum), one behind the other. A quad becomes one ring, which begins
    at another corner, and a larger polygon triangles. Fans of these rings have no flipped triangle. Polygons that are
    bent, cross themselves, or name vertices that do not exist are left out.
    """
    found, starts = {}, np.cumsum(sizes) - sizes
    for size in np.unique(sizes[sizes > 3]).tolist():
        numbers = np.flatnonzero(sizes == size)
        corners = ids[starts[numbers][:, None] + np.arange(size)]
        known = ((corners >= -len(vertices)) & (corners < len(vertices))).all(axis=1)
        numbers, points = numbers[known], vertices[corners[known]]
        with np.errstate(invalid="ignore", over="ignore"):
            spokes = points[:, 1:] - points[:, :1]
            normals = np.cross(spokes[:, :-1], spokes[:, 1:])
            total = normals.sum(axis=1)
            shares = np.einsum("nij,nj->ni", normals, total)
            folded = (shares < -ROUNDING * (total**2).sum(axis=1)[:, None]).any(axis=1)
        for number, polygon, normal in zip(numbers[folded], points[folded], total[folded], strict=True):
            if rings := _rings(polygon - polygon.mean(axis=0), normal / np.linalg.norm(normal)):
                found[int(number)] = rings
    return found


def fans(rings: Sequence[Sequence[int]]) -> list[tuple[int, int, int]]:
    """The triangles of each ring, about its first corner."""
    return [(ring[0], *pair) for ring in rings for pair in zip(ring[1:], ring[2:], strict=False)]


def _rings(polygon, normal):
    if not np.abs(polygon @ normal).max() <= FLAT * np.linalg.norm(np.ptp(polygon, axis=0)):
        return None
    first = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    flat = polygon @ np.stack([first, np.cross(normal, first)], axis=1)
    sides = _turn(flat[:, None], np.roll(flat, -1, axis=0)[:, None], flat[None])
    apart = sides * np.roll(sides, -1, axis=1) < 0  # the ends of an edge are on both sides of another
    if (apart & apart.T).any():
        return None
    return [(1, 2, 3, 0)] if len(flat) == 4 else _ears(flat)


def _turn(a, b, c):
    """Twice the area of the triangles abc, below 0 where they are clockwise."""
    (x, y), (u, v) = np.moveaxis(b - a, -1, 0), np.moveaxis(c - a, -1, 0)
    return x * v - y * u


def _ears(flat):
    """The triangles of a polygon (k, 2), cut off one by one; None where none can be cut off."""
    ring, triangles, place, missed = list(range(len(flat))), [], 0, 0
    while len(ring) > 3:
        place %= len(ring)
        ear = ring[place - 1], ring[place], ring[(place + 1) % len(ring)]
        if _is_free(flat[list(ear)], flat[ring]):
            triangles.append(ear)
            del ring[place]
            missed = 0
        else:
            place, missed = place + 1, missed + 1
        if missed == len(ring):
            return None
    return [*triangles, tuple(ring)]


def _is_free(ear, points):
    """Whether a triangle is counterclockwise and holds none of the points but those at its corners."""
    a, b, c = ear
    if not _turn(a, b, c) > 0:
        return False
    within = (_turn(a, b, points) >= 0) & (_turn(b, c, points) >= 0) & (_turn(c, a, points) >= 0)
    return not (within & (points[:, None] != ear).any(axis=2).all(axis=1)).any()

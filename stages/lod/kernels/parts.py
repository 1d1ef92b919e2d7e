"""The parts of a surface: fans of faces around a vertex, components joined by edges."""

import numpy as np

from .corners import after, before
from .jit import kernel
from .vectors import between, cross, dot


def split_fans(faces: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, int]:
    """(3 m,) i4: the fan at each corner, and the number of fans; the windings of neighbours may differ.

    faces (3 m,); other (3 m,): their `opposites`.
    """
    fan = np.full(len(faces), -1, dtype=np.int32)
    return fan, _fill_fans(faces, other, fan)


@kernel
def _fill_fans(faces, other, fan):
    """Fills the fans of `split_fans`, all -1 before; returns their number."""
    count = 0
    for seed in range(len(faces)):
        if fan[seed] >= 0:
            continue
        fan[seed] = count
        for side in range(2):  # to one end of the fan, then to the other; around once where it is closed
            edge, tail = (seed, True) if side == 0 else (before(seed), False)  # tail: the corner is that of the edge
            while other[edge] >= 0:
                across = other[edge]
                tail = tail == (faces[across] == faces[edge])
                here = across if tail else after(across)
                if fan[here] >= 0:
                    break
                fan[here] = count
                edge, tail = (before(across), False) if tail else (here, True)
        count += 1
    return count


def face_components(other: np.ndarray) -> tuple[np.ndarray, int]:
    """(m,) i4: the component, joined by edges, of each face, and their number. other (3 m,): see `opposites`."""
    component = np.full(len(other) // 3, -1, dtype=np.int32)
    return component, _fill_components(other, component, np.empty_like(component))


@kernel
def _fill_components(other, component, waiting):
    """Fills the components, all -1 before, and returns their number. waiting (m,): scratch."""
    count = 0
    for seed in range(len(component)):
        if component[seed] >= 0:
            continue
        component[seed], waiting[0], left = count, seed, 1
        while left:
            left -= 1
            f = waiting[left]
            for h in range(3 * f, 3 * f + 3):
                g = other[h] // 3  # -1 on the boundary
                if g >= 0 and component[g] < 0:
                    component[g], waiting[left] = count, g
                    left += 1
        count += 1
    return count


def signed_volumes(vertices: np.ndarray, faces: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(k,) volume inside each component, negative where it is inside out; 0 for one with a boundary."""
    component, count = face_components(other)
    volume, boundary = np.zeros(count), np.zeros(count, dtype=np.bool_)
    _add_volumes(vertices, faces, other, component, np.full(count, -1, dtype=np.int32), volume, boundary)
    volume[boundary] = 0.0
    return volume


@kernel
def _add_volumes(vertices, faces, other, component, origin, volume, boundary):
    """Adds the volume under each face to that of its component. origin: -1, then a vertex of each component."""
    for f in range(len(component)):
        at = component[f]
        if origin[at] < 0:
            origin[at] = faces[
                3 * f
            ]  # a point of the component itself: from afar, small volumes would be lost to rounding
        o, i, j, k = origin[at], faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]
        ax, ay, az = between(vertices, o, i)
        bx, by, bz = between(vertices, o, j)
        cx, cy, cz = between(vertices, o, k)
        nx, ny, nz = cross(bx, by, bz, cx, cy, cz)
        volume[at] += dot(ax, ay, az, nx, ny, nz) / 6
        for h in range(3 * f, 3 * f + 3):
            boundary[at] |= other[h] < 0

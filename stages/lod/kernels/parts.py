"""The parts of a surface: fans of faces around a vertex, pieces joined by edges."""

import numpy as np

from .corners import after, before
from .jit import kernel


@kernel
def split_fans(faces, other):
    """(3 m,) i4 the fan at each corner, and how many there are; neighbours may disagree on which side is out.

    faces, other (3 m,) as `partners` has them.
    """
    fan = np.full(len(faces), -1, dtype=np.int32)
    count = 0
    for seed in range(len(faces)):
        if fan[seed] >= 0:
            continue
        fan[seed] = count
        for side in range(2):  # to one rim, then to the other; once round where there is none
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
    return fan, count


@kernel
def pieces(other):
    """(m,) i4 the piece of each face, and how many there are: faces joined by edges. other (3 m,)."""
    piece = np.full(len(other) // 3, -1, dtype=np.int32)
    waiting = np.empty(len(piece), dtype=np.int32)
    count = 0
    for seed in range(len(piece)):
        if piece[seed] >= 0:
            continue
        piece[seed], waiting[0], left = count, seed, 1
        while left:
            left -= 1
            f = waiting[left]
            for h in range(3 * f, 3 * f + 3):
                g = other[h] // 3  # of a rim -1, which is no face
                if g >= 0 and piece[g] < 0:
                    piece[g], waiting[left] = count, g
                    left += 1
        count += 1
    return piece, count


@kernel
def signed_volumes(vertices, faces, other):
    """(k,) volume inside each piece, negative where its inside is out; 0 for a piece with a rim."""
    piece, count = pieces(other)
    volume = np.zeros(count)
    rim = np.zeros(count, dtype=np.bool_)
    origin = np.full(count, -1, dtype=np.int64)
    for f in range(len(piece)):
        at = piece[f]
        if origin[at] < 0:
            origin[at] = faces[3 * f]  # a point of the piece itself: far from it, small volumes are lost
        o, i, j, k = origin[at], faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]
        ax, ay, az = vertices[i, 0] - vertices[o, 0], vertices[i, 1] - vertices[o, 1], vertices[i, 2] - vertices[o, 2]
        bx, by, bz = vertices[j, 0] - vertices[o, 0], vertices[j, 1] - vertices[o, 1], vertices[j, 2] - vertices[o, 2]
        cx, cy, cz = vertices[k, 0] - vertices[o, 0], vertices[k, 1] - vertices[o, 1], vertices[k, 2] - vertices[o, 2]
        volume[at] += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6
        for h in range(3 * f, 3 * f + 3):
            rim[at] |= other[h] < 0
    volume[rim] = 0.0
    return volume

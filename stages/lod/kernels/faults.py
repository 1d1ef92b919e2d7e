"""Counts of a surface's faults."""

import numpy as np

from .jit import kernel
from .vectors import between, cross, dot, point


def count_faults(
    vertices: np.ndarray, faces: np.ndarray, other: np.ndarray, thin: float, fold: float
) -> tuple[int, int]:
    """(degenerate faces, pairs of neighbours folded onto each other).

    faces (3 m,); other (3 m,): their `opposites`. thin: height of a degenerate face; fold: cosine of the normals.
    """
    return _count(vertices, faces, other, thin, fold, np.zeros((len(faces) // 3, 3)))


@kernel
def _count(vertices, faces, other, thin, fold, normal):
    """`count_faults`; normal (m, 3): zeros."""
    degenerate = folded = 0
    for f in range(len(normal)):
        i, j, k = faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]
        ux, uy, uz = between(vertices, i, j)
        vx, vy, vz = between(vertices, i, k)
        wx, wy, wz = vx - ux, vy - uy, vz - uz
        x, y, z = cross(ux, uy, uz, vx, vy, vz)
        double = np.sqrt(dot(x, y, z, x, y, z))
        sides = max(dot(ux, uy, uz, ux, uy, uz), dot(vx, vy, vz, vx, vy, vz), dot(wx, wy, wz, wx, wy, wz))
        degenerate += double <= thin * np.sqrt(sides)
        if double > 0.0:
            normal[f, 0], normal[f, 1], normal[f, 2] = x / double, y / double, z / double
    for h in range(len(faces)):
        if other[h] > h:
            ux, uy, uz = point(normal, h // 3)
            vx, vy, vz = point(normal, other[h] // 3)
            along = dot(ux, uy, uz, vx, vy, vz)
            folded += (-along if faces[h] == faces[other[h]] else along) < fold  # whatever the winding
    return degenerate, folded

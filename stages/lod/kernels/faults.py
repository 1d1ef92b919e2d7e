"""Counts of a surface's faults."""

import numpy as np

from .jit import kernel


@kernel
def count_faults(
    vertices: np.ndarray, faces: np.ndarray, other: np.ndarray, thin: float, fold: float
) -> tuple[int, int]:
    """(degenerate faces, pairs of neighbours folded onto each other).

    faces (3 m,); other (3 m,): their `opposites`. thin: height of a degenerate face; fold: cosine of the normals.
    """
    count = len(faces) // 3
    normal = np.zeros((count, 3))
    degenerate = folded = 0
    for f in range(count):
        i, j, k = faces[3 * f], faces[3 * f + 1], faces[3 * f + 2]
        ux, uy, uz = vertices[j, 0] - vertices[i, 0], vertices[j, 1] - vertices[i, 1], vertices[j, 2] - vertices[i, 2]
        vx, vy, vz = vertices[k, 0] - vertices[i, 0], vertices[k, 1] - vertices[i, 1], vertices[k, 2] - vertices[i, 2]
        wx, wy, wz = vx - ux, vy - uy, vz - uz
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        double = np.sqrt(x * x + y * y + z * z)
        longest = np.sqrt(max(ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz))
        degenerate += double <= thin * longest
        if double > 0.0:
            normal[f, 0], normal[f, 1], normal[f, 2] = x / double, y / double, z / double
    for h in range(len(faces)):
        if other[h] > h:
            f, g = h // 3, other[h] // 3
            along = normal[f, 0] * normal[g, 0] + normal[f, 1] * normal[g, 1] + normal[f, 2] * normal[g, 2]
            folded += (-along if faces[h] == faces[other[h]] else along) < fold  # whatever the winding
    return degenerate, folded

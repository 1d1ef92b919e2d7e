"""The heights of a surface under small arrays, from samples of it: one disc for each sample."""

import math

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)
EDGE_ON = 0.02  # cosine between the normals of a disc and of an array below which the array does not meet the disc


@kernel
def pressed(
    points: np.ndarray, normals: np.ndarray, radii: np.ndarray, axes: np.ndarray, at: np.ndarray, cells: int,
    width: float,
) -> np.ndarray:  # fmt: skip
    """(k, cells, cells) distances below arrays of a width at points `at` (k,), whose axes (k, 3, 3) are their own.

    Each of the points (s, 3) stands for a disc of its radius, perpendicular to its normal. Of the discs that a cell
    meets from outside, the nearest one counts; a cell that meets none within the width reports the width.
    """
    step, half = width / cells, width / 2
    found = np.full((len(at), cells, cells), width)
    for i in range(len(at)):
        right, up, out = axes[i, 0], axes[i, 1], axes[i, 2]
        for j in range(len(points)):
            x, y, z = points[j, 0] - points[at[i], 0], points[j, 1] - points[at[i], 1], points[j, 2] - points[at[i], 2]
            reach = radii[j]
            height = out[0] * x + out[1] * y + out[2] * z
            if abs(height) > width + reach:
                continue
            u = right[0] * x + right[1] * y + right[2] * z
            if abs(u) > half + reach:
                continue
            v = up[0] * x + up[1] * y + up[2] * z
            if abs(v) > half + reach:
                continue
            x, y, z = normals[j, 0], normals[j, 1], normals[j, 2]
            facing = out[0] * x + out[1] * y + out[2] * z
            if facing <= EDGE_ON:
                continue
            slope_u = (right[0] * x + right[1] * y + right[2] * z) / facing
            slope_v = (up[0] * x + up[1] * y + up[2] * z) / facing
            left = max(int(math.ceil((u - reach + half) / step - 0.5)), 0)
            end = min(int(math.floor((u + reach + half) / step - 0.5)), cells - 1)
            top = max(int(math.ceil((half - v - reach) / step - 0.5)), 0)
            bottom = min(int(math.floor((half - v + reach) / step - 0.5)), cells - 1)
            for column in range(left, end + 1):
                du = (column + 0.5) * step - half - u
                for row in range(top, bottom + 1):
                    dv = half - (row + 0.5) * step - v
                    rise = -(slope_u * du + slope_v * dv)
                    below = -(height + rise)
                    if du * du + dv * dv + rise * rise <= reach * reach and abs(below) < abs(found[i, row, column]):
                        found[i, row, column] = below
    return found

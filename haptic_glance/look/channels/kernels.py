"""Compiled kernels of the channels: entropy in a window, local maxima of a map, surface points under pixels."""

import numpy as np

from haptic_glance.base.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def window_entropy(padded: np.ndarray, side: int) -> np.ndarray:
    """(h, w) f4 entropy in bits of the side x side windows of an image (h + side - 1, w + side - 1) u1 (T eq. 3.7)."""
    height, width, pixels = padded.shape[0] - side + 1, padded.shape[1] - side + 1, side * side
    shares = np.arange(pixels + 1) / pixels
    terms = -shares * np.log2(np.maximum(shares, 1 / pixels))
    entropy = np.empty((height, width), dtype=np.float32)
    for i in range(height):
        counts, total = np.zeros(256, dtype=np.int64), 0.0
        for a in range(i, i + side):
            for b in range(side):
                counts[padded[a, b]] += 1
        for count in counts:
            total += terms[count]
        entropy[i, 0] = total
        for j in range(1, width):
            for a in range(i, i + side):
                total += _moved(counts, terms, padded[a, j - 1], -1) + _moved(counts, terms, padded[a, j + side - 1], 1)
            entropy[i, j] = total
    return entropy


@kernel
def _moved(counts, terms, level, step):
    """The change of the entropy by a pixel of a level that leaves the window (-1) or enters it (1)."""
    before = terms[counts[level]]
    counts[level] += step
    return terms[counts[level]] - before


def mean_of_other_maxima(values: np.ndarray, least: float) -> float:
    """The mean of the local maxima above `least` of values (h, w) f4, without the highest; 0 if there is no other."""
    total, highest, count = _maxima(values, least)
    return (total - highest) / (count - 1) if count > 1 else 0.0


def mean_of_maxima(values: np.ndarray) -> float:
    """The mean of all local maxima of values (h, w) f4, 0 or more; 0 of an even map, which has none above zero."""
    total, _, count = _maxima(values, 0.0)
    return total / count if count else 0.0


@kernel
def _maxima(values: np.ndarray, least: float) -> tuple[float, float, int]:
    """(sum, highest, number) of the local maxima above `least` of values (h, w) f4.

    A local maximum is at least as high as its eight neighbours; a plateau counts as one.
    """
    height, width = values.shape
    total, highest, count = 0.0, 0.0, 0
    counted = np.zeros((height, width), dtype=np.bool_)
    for i in range(height):
        for j in range(width):
            if values[i, j] <= np.float32(least) or counted[i, j] or not _is_peak(values, i, j):
                continue
            total, highest, count = total + values[i, j], max(highest, values[i, j]), count + 1
            counted[i, j], plateau = True, [(i, j)]
            while len(plateau):
                a, b = plateau.pop()
                for r in range(max(a - 1, 0), min(a + 2, height)):
                    for c in range(max(b - 1, 0), min(b + 2, width)):
                        if values[r, c] == values[i, j] and not counted[r, c] and _is_peak(values, r, c):
                            counted[r, c] = True
                            plateau.append((r, c))
    return total, highest, count


@kernel
def _is_peak(values, i, j):
    for r in range(max(i - 1, 0), min(i + 2, values.shape[0])):
        for c in range(max(j - 1, 0), min(j + 2, values.shape[1])):
            if values[r, c] > values[i, j]:
                return False
    return True


@kernel
def locate_pixels(
    right: np.ndarray, up: np.ndarray, heights: np.ndarray, axes: np.ndarray, face_ids: np.ndarray,
    vertices: np.ndarray, faces: np.ndarray, crosses: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """(points (k, 3), barycentric weights (k, 3) in 0..1) of k pixels that show the faces `face_ids` (k,).

    right, up, heights (k,): the coordinates of a point along the camera's axes (3, 3), see Viewpoint.axes.
    vertices (n, 3) and faces (m, 3) of the mesh; crosses (m, 3): the faces' normals, of twice their area.
    """
    count = len(face_ids)
    points, weights = np.empty((count, 3)), np.empty((count, 3))
    for k in range(count):
        px = right[k] * axes[0, 0] + up[k] * axes[1, 0] + heights[k] * axes[2, 0]
        py = right[k] * axes[0, 1] + up[k] * axes[1, 1] + heights[k] * axes[2, 1]
        pz = right[k] * axes[0, 2] + up[k] * axes[1, 2] + heights[k] * axes[2, 2]
        points[k, 0], points[k, 1], points[k, 2] = px, py, pz
        a, b, c = faces[face_ids[k]]
        nx, ny, nz = crosses[face_ids[k]]
        ax, ay, az = vertices[a]
        bx, by, bz = vertices[b, 0] - ax, vertices[b, 1] - ay, vertices[b, 2] - az
        cx, cy, cz = vertices[c, 0] - ax, vertices[c, 1] - ay, vertices[c, 2] - az
        px, py, pz = px - ax, py - ay, pz - az
        square = max(nx * nx + ny * ny + nz * nz, 1e-300)
        second = ((py * cz - pz * cy) * nx + (pz * cx - px * cz) * ny + (px * cy - py * cx) * nz) / square
        third = ((by * pz - bz * py) * nx + (bz * px - bx * pz) * ny + (bx * py - by * px) * nz) / square
        first = min(max(1 - second - third, 0.0), 1.0)
        second, third = min(max(second, 0.0), 1.0), min(max(third, 0.0), 1.0)
        total = first + second + third
        weights[k, 0], weights[k, 1], weights[k, 2] = first / total, second / total, third / total
    return points, weights

"""The surface points under the pixels of a view."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def locate_pixels(
    right: np.ndarray, up: np.ndarray, heights: np.ndarray, axes: np.ndarray, shown: np.ndarray,
    vertices: np.ndarray, faces: np.ndarray, crosses: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """(points (k, 3), barycentric weights (k, 3) in 0..1) of k pixels that show the faces `shown` (k,).

    right, up, heights (k,): the coordinates of a point along the camera's axes (3, 3), see stages.kit.Viewpoint.axes.
    vertices (n, 3) and faces (m, 3) of the mesh; crosses (m, 3): the faces' normals, of twice their area.
    """
    count = len(shown)
    points, weights = np.empty((count, 3)), np.empty((count, 3))
    for k in range(count):
        px = right[k] * axes[0, 0] + up[k] * axes[1, 0] + heights[k] * axes[2, 0]
        py = right[k] * axes[0, 1] + up[k] * axes[1, 1] + heights[k] * axes[2, 1]
        pz = right[k] * axes[0, 2] + up[k] * axes[1, 2] + heights[k] * axes[2, 2]
        points[k, 0], points[k, 1], points[k, 2] = px, py, pz
        a, b, c = faces[shown[k]]
        nx, ny, nz = crosses[shown[k]]
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

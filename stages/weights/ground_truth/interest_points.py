"""Interest points that people marked: the NIST benchmark (Dutagaci, Cheung and Godil 2012, T [7]).

Its folder IP_BENCHMARK holds MODEL_DATASET/NAME.mat (V, F, counted from 1) and OUTPUT_DATA/GROUND_TRUTH_A/NAME.mat (24
models, 23 users) and GROUND_TRUTH_B/NAME.mat (43 models, 16 users). Each file holds GT_MODEL, a cell array of ten radii
by the minimum number of users 2..N by two: the vertices of the points, and for each point the marks of its cluster.
"""

from pathlib import Path

import numpy as np

from stages.meshes.mat import read_mat

SIGMAS = np.arange(1, 11) / 100  # radii of a cluster, as shares of the model's diameter (Dutagaci 2012, section 4)
SIGMA, USERS = 0.03, 8  # half of the 16 users must agree, within the radius most used in the paper


def read_interest_points(
    path_or_bytes: str | Path | bytes, sigma: float = SIGMA, users: int = USERS
) -> tuple[np.ndarray, np.ndarray]:
    """(vertices (k,) i8 from 0, marks (k,) i8): the points on which at least `users` agree within `sigma`.

    sigma: 0.01, 0.02 ... 0.1 of the largest distance of two vertices; marks: the number of marks in the cluster of each
    point, its weight in the weighted miss error. Raises ValueError for a file of another layout, a sigma that it does
    not have, or more users than took part.
    """
    content = path_or_bytes if isinstance(path_or_bytes, bytes) else Path(path_or_bytes).read_bytes()
    (cells,) = read_mat(content, ["GT_MODEL"])
    if cells.dtype != object or cells.ndim != 3 or cells.shape[0] != len(SIGMAS) or cells.shape[2] != 2:
        raise ValueError(f"GT_MODEL must be {len(SIGMAS)} radii by users by two cells, got {cells.dtype} {cells.shape}")
    radius = np.flatnonzero(np.isclose(SIGMAS, sigma))
    if len(radius) == 0:
        raise ValueError(f"sigma {sigma} is not one of {', '.join(f'{value:g}' for value in SIGMAS)}")
    available = cells.shape[1] + 1
    if not 2 <= users <= available:
        raise ValueError(f"users must be in 2..{available}, the number of users of this model, got {users}")
    points, clusters = cells[radius[0], users - 2]
    vertices = np.ravel(points).astype(np.int64) - 1
    marks = [len(_text(cluster).split()) for cluster in np.ravel(clusters)]
    if len(marks) != len(vertices) or (vertices < 0).any():
        raise ValueError(f"{len(vertices)} points, the lowest {vertices.min(initial=0) + 1}, and {len(marks)} clusters")
    return vertices, np.array(marks, dtype=np.int64)


def _text(cell):
    """The marks of one cluster, which are stored as numbers in a text."""
    return " ".join(str(part) for part in np.ravel(cell))

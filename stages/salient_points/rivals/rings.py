"""The local maxima of a function on the vertices of a mesh within rings of edges, which coarse meshes have too."""

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from stages.kit import Mesh

DIGITS = 9  # relative to the largest value: smaller differences are rounding, and count as equal


def ring_maxima(mesh: Mesh, values: np.ndarray, rings: int) -> np.ndarray:
    """(k,) i8 vertex ids where values (n,) is largest within `rings` edges, largest value first.

    Only values above zero count, and only where some vertex of the rings is lower: a plateau has no peak. Of equal
    values the one that comes last by x, then y, then z is the peak, so that the order of the vertices does not matter.
    Raises ValueError when values do not fit the mesh.
    """
    values = np.asarray(values, dtype=np.float64)
    if values.shape != (len(mesh.vertices),) or not np.isfinite(values).all():
        raise ValueError(f"values must be {len(mesh.vertices)} finite numbers, one per vertex, got {values.shape}")
    top = values.max(initial=0)
    if top <= 0:
        return np.zeros(0, dtype=np.int64)
    levels = np.round(values / top, DIGITS)
    order = np.lexsort((*mesh.vertices.T[::-1], levels))
    ranks = np.argsort(order)
    itself = sparse.identity(len(values), dtype=bool)  # pyright: ignore[reportArgumentType] (scipy has no stub)
    around = (mesh.adjacency + itself).tocsr()
    highest, lowest = ranks, levels
    for _ in range(rings):
        highest = np.maximum.reduceat(highest[around.indices], around.indptr[:-1])
        lowest = np.minimum.reduceat(lowest[around.indices], around.indptr[:-1])
    peaks = np.flatnonzero((highest == ranks) & (lowest < levels) & (levels > 0))
    return peaks[np.argsort(-ranks[peaks])]


def representatives(mesh: Mesh, vertices: np.ndarray, distance: float) -> np.ndarray:
    """Vertices of (k,), best first, in the same order, that are farther than distance from all better ones kept."""
    near = cKDTree(mesh.vertices[vertices]).query_ball_point(mesh.vertices[vertices], distance)
    free = np.ones(len(vertices), dtype=bool)
    for rank, others in enumerate(near):
        if free[rank]:
            free[[other for other in others if other > rank]] = False
    return vertices[free]

"""Local maxima of a function on the vertices of a mesh, within a radius or within rings of edges.

Most detectors select maxima within a radius. Rings exist on coarse meshes, too.
"""

from itertools import chain

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from haptic_glance.mesh.mesh import Mesh

NEAREST = 8  # vertices queried first: they rule out nearly all, so that few wide queries remain
SPACING = 0.05  # of the size, between points of detectors that leave it open, as for 3D-Harris
DIGITS = 9  # relative to the largest value or coordinate: smaller differences are rounding, and count as equal


def check_values(mesh: Mesh, values: np.ndarray) -> None:
    """Raises ValueError unless values are finite, one per vertex."""
    if np.shape(values) != (len(mesh.vertices),) or not np.isfinite(values).all():
        raise ValueError(f"values must be {len(mesh.vertices)} finite numbers, one per vertex, got {np.shape(values)}")


def local_maxima(mesh: Mesh, values: np.ndarray, radius: float, among: np.ndarray | None = None) -> np.ndarray:
    """(k,) i8 vertex ids where values (n,) is largest within `radius`, largest value first.

    The radius is Euclidean, in units of the mesh. Only values above zero count, and only where some vertex within the
    radius is lower: a plateau has no peak. Of equal values the one that comes last by x, then y, then z is the peak, so
    that the order of the vertices does not matter. among (n,) boolean: only these may be peaks; None: all. Raises
    ValueError when values do not fit the mesh or radius <= 0.
    """
    levels = _levels(mesh, values)
    if not radius > 0:
        raise ValueError(f"radius must be above 0, in units of the mesh, got {radius}")
    if not levels.any():
        return np.zeros(0, dtype=np.int64)
    order = np.lexsort((*-rounded(mesh.vertices).T[::-1], -levels))
    ranks = np.argsort(order)
    tree = cKDTree(mesh.vertices)
    candidates = np.flatnonzero(levels > 0 if among is None else among & (levels > 0))
    candidates = _above_nearest(tree, candidates, ranks, radius)
    if len(candidates) == 0:
        return candidates
    near = tree.query_ball_point(mesh.vertices[candidates], radius)
    ids = np.fromiter(chain.from_iterable(near), dtype=np.int64)
    starts = np.cumsum([0, *map(len, near[:-1])])  # no list is empty: each vertex is near itself
    highest = np.minimum.reduceat(ranks[ids], starts) == ranks[candidates]
    peaks = candidates[highest & (np.minimum.reduceat(levels[ids], starts) < levels[candidates])]
    return peaks[np.argsort(ranks[peaks])]


def high_maxima(mesh: Mesh, values: np.ndarray, radius: float | None = None) -> np.ndarray:
    """(k,) i8 vertex ids, largest value first: the local maxima within a radius that are above the mean of them all.

    So Dutagaci 2012 selects for mesh saliency. radius: None for SPACING of the size, which is twice the distance of the
    farthest vertex from the middle of the used ones, which no turn changes.
    """
    values = np.asarray(values, dtype=np.float64)
    if not (len(mesh.faces) and values.any()):
        return local_maxima(mesh, values, 1.0)
    if radius is None:
        vertices = mesh.vertices[mesh.used]
        radius = 2 * SPACING * float(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1).max())
    maxima = local_maxima(mesh, values, radius)
    return maxima[values[maxima] >= values[maxima].mean()] if len(maxima) else maxima


def rounded(numbers: np.ndarray) -> np.ndarray:
    """Numbers over the largest absolute one, without their rounding errors; zeros where all are zero.

    Otherwise the units of a mesh would decide between a place and its mirror image.
    """
    top = np.abs(numbers).max(initial=0)
    return np.round(numbers / top, DIGITS) if top > 0 else np.zeros(numbers.shape)


def _levels(mesh, values):
    """(n,) values over the largest, without their rounding errors; zero where no value is above zero."""
    check_values(mesh, values)
    return rounded(np.maximum(np.asarray(values, dtype=np.float64), 0))


def _above_nearest(tree, candidates, ranks, radius):
    """The candidates that none of the nearest vertices within the radius outranks."""
    count = min(NEAREST, tree.n)
    ids = tree.query(tree.data[candidates], k=np.arange(1, count + 1), distance_upper_bound=radius)[1]
    best = np.append(ranks, tree.n)[ids].min(axis=1)  # an empty slot has the id n
    return candidates[ranks[candidates] <= best]


def ring_maxima(mesh: Mesh, values: np.ndarray, rings: int) -> np.ndarray:
    """(k,) i8 vertex ids where values (n,) is largest within `rings` edges, largest value first.

    Values count, and equal values have one peak, as in `local_maxima`.
    """
    levels = _levels(mesh, values)
    if not levels.any():
        return np.zeros(0, dtype=np.int64)
    order = np.lexsort((*rounded(mesh.vertices).T[::-1], levels))
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
    for rank, neighbours in enumerate(near):
        if free[rank]:
            free[[neighbour for neighbour in neighbours if neighbour > rank]] = False
    return vertices[free]

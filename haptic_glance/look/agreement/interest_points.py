"""Interest points of people: peaks of a density of gaze, and errors of detected points.

The errors are false negatives, false positives and weighted misses (Dutagaci, Cheung and Godil, Evaluation of 3D
interest point detection techniques via human-generated ground truth, The Visual Computer 2012; T's reference 7). Peaks
of gaze serve where nobody marked points.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from haptic_glance.mesh.mesh import Mesh, unit


class Geodesics:
    """Distances on one mesh, whose graph is built in advance.

    Paths run along edges, and straight across two neighbouring faces between their opposite corners, if the line lies
    inside the unfolded faces. Vertices at the same position are merged, so that seams do not cut the surface. Between
    connected components the distance is infinite. Dijkstra's algorithm by scipy. On a sphere and on flat grids
    (regular, jittered and sheared) the paths are 1.5 to 5 % too long on average; along edges alone 7 to 30 %.
    """

    def __init__(self, mesh: Mesh) -> None:
        places, place = np.unique(mesh.vertices, axis=0, return_inverse=True)
        self.place = place.reshape(-1)
        faces = self.place[mesh.faces]
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        edge_lengths = np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1)
        across, across_lengths = _across(places, edges, np.concatenate([faces[:, 2], faces[:, 0], faces[:, 1]]))
        ends, lengths = np.concatenate([edges, across]), np.concatenate([edge_lengths, across_lengths])
        self.graph = _distance_graph(ends, lengths, len(places))

    def distances(self, sources: np.ndarray | Sequence[int], limit: float = np.inf) -> np.ndarray:
        """(k, n) from each of the vertices sources (k,) to every vertex; infinite beyond `limit`, units of the mesh."""
        lengths = dijkstra(self.graph, indices=self.place[np.asarray(sources, dtype=np.int64)], limit=limit)
        return lengths[:, self.place]


geodesics = lru_cache(maxsize=2)(Geodesics)  # many methods are evaluated on one mesh, then on the next


def _across(places, edges, opposite):
    """(pairs (p, 2), lengths (p,)): opposite corners of two faces that share an edge, and the line between them."""
    low, high = edges.min(axis=1), edges.max(axis=1)
    order = np.lexsort((high, low))
    first, second = order[:-1], order[1:]
    is_shared = (low[first] == low[second]) & (high[first] == high[second])
    first, second = first[is_shared], second[is_shared]
    start, along = places[low[first]], places[high[first]] - places[low[first]]
    x_c, y_c = _unfold(places[opposite[first]] - start, along)
    x_d, y_d = _unfold(places[opposite[second]] - start, along)
    total_height = y_c + y_d
    crossing = (x_c * y_d + x_d * y_c) / np.where(total_height > 0, total_height, 1.0)
    inside = (total_height > 0) & (crossing > 0) & (crossing < np.linalg.norm(along, axis=1))
    pairs = np.stack([opposite[first], opposite[second]], axis=1)
    return pairs[inside], np.hypot(x_c - x_d, total_height)[inside]


def _unfold(offsets, along):
    """(x, y): coordinates along the edge and away from it, of offsets (p, 3) from its start."""
    direction = unit(along)
    x = np.einsum("ij,ij->i", offsets, direction)
    return x, np.linalg.norm(offsets - x[:, None] * direction, axis=1)


def _distance_graph(ends, lengths, count):
    """(count, count) symmetric sparse matrix of lengths; the shortest one where several lines join two vertices."""
    keys = ends.min(axis=1) * count + ends.max(axis=1)
    order = np.lexsort((lengths, keys))
    unique = order[np.unique(keys[order], return_index=True)[1]]
    (a, b), lengths = ends[unique].T, lengths[unique]
    return sparse.csr_matrix((np.r_[lengths, lengths], (np.r_[a, b], np.r_[b, a])), shape=(count, count))


BATCH = 256  # peaks whose distances are in memory together: 40 MB at 20,000 vertices
DIGITS = 9  # relative to the largest density; values that differ by less are equal


def gaze_peaks(
    mesh: Mesh, density: np.ndarray, radius: float = 0.05, min_weight: float = 0.01
) -> tuple[np.ndarray, np.ndarray]:
    """(points (k,), weights (k,)): the peaks of a density (n,) of gaze, heaviest first, and the gaze around each.

    A peak is a vertex whose neighbourhood has no higher and some lower vertex, so that a plateau has no peak. The
    neighbourhood is the vertices within the geodesic distance `radius`, a share of the bounding-box diagonal, and the
    neighbours by an edge. Of equal vertices, the last by x, then y, then z is the peak, whatever the order of the
    vertices. The weight of a peak is the share of all gaze (density times area) that lies within the radius and nearer
    to it than to other peaks; weights sum to one at most. Peaks with a weight below `min_weight`, or at most that of
    uniform attention, are left out, as Dutagaci et al. (2012) leave out points that fewer than n people marked. Raises
    ValueError for a density that does not fit the mesh, is empty or uniform.
    """
    density = np.asarray(density, dtype=np.float64)
    if density.shape != (len(mesh.vertices),) or not np.isfinite(density).all() or (density < 0).any():
        raise ValueError(f"density must be {len(mesh.vertices)} finite values, not negative, got {density.shape}")
    if not (radius > 0 and 0 <= min_weight < 1):
        raise ValueError(f"radius must be above 0 and min_weight in 0..1, as shares, got {radius} and {min_weight}")
    areas = mesh.vertex_areas
    density = np.where(areas > 0, density, 0.0)
    if not density.any():
        raise ValueError("density is empty, zero on the whole surface: leave this mesh out")
    surface, limit = geodesics(mesh), radius * mesh.diagonal
    peaks = _peaks(mesh, surface, np.round(density / density.max(), DIGITS), limit)
    if len(peaks) == 0:
        raise ValueError("density is uniform, so that it has no peak: leave this mesh out")
    weights, even = _shares(surface.distances(peaks, limit), density * areas, areas)
    order = np.argsort(-weights, kind="stable")
    order = order[((weights >= min_weight) & (weights > even))[order]]
    return peaks[order], weights[order]


def _peaks(mesh, surface, levels, limit):
    """Ids of the vertices that are first by level, then position, in their neighbourhood, and above some of it."""
    order = np.lexsort((*-mesh.vertices.T[::-1], -levels))
    ranks = np.empty(len(order), dtype=np.int64)
    ranks[order] = np.arange(len(order))
    lowest = _neighbour_minimum(mesh, levels)
    candidates = order[((levels > 0) & (_neighbour_minimum(mesh, ranks) == ranks))[order]]
    peaks = [candidates[:0]]
    for start in range(0, len(candidates), BATCH):
        batch = candidates[start : start + BATCH]
        near = np.isfinite(surface.distances(batch, limit))
        first = np.where(near, ranks, len(ranks)).min(axis=1) == ranks[batch]
        above = np.where(near, lowest, np.inf).min(axis=1) < levels[batch]
        peaks.append(batch[first & above])
    return np.concatenate(peaks)


def _neighbour_minimum(mesh, values):
    """(n,) the minimum of values (n,) over each vertex and its neighbours by an edge."""
    tail, head = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    lowest = values.copy()
    np.minimum.at(lowest, tail, values[head])
    np.minimum.at(lowest, head, values[tail])
    return lowest


def _shares(distances, *amounts):
    """For each of amounts (n,), the share (k,) nearest to each peak by distances (k, n), infinite beyond the limit."""
    inside = np.isfinite(distances.min(axis=0))
    owner = np.argmin(distances, axis=0)[inside]
    return [np.bincount(owner, weights=amount[inside], minlength=len(distances)) / amount.sum() for amount in amounts]


TOLERANCES = np.linspace(0.0, 0.12, 13)  # of the diagonal: the range of the paper's curves


def interest_point_errors(
    mesh: Mesh,
    detected: np.ndarray,
    points: np.ndarray,
    weights: np.ndarray | None = None,
    tolerances: np.ndarray = TOLERANCES,
) -> dict[str, np.ndarray]:
    """Errors of the detected vertices against the points of people: dict of fne, fpe and wme, each (t,) in 0..1.

    detected (a,) and points (g,) are vertex ids. A point is found at tolerance r if a detected vertex lies within the
    geodesic distance r of it and no nearer to another point; a detected vertex finds at most one point.
    fne = 1 - found / g; fpe = 1 - found / a; wme = 1 - weight of the found / weight of all. tolerances (t,) are shares
    of the bounding-box diagonal. weights: the number of people who marked each point, (g,), or (g, t) if it is counted
    at each tolerance as in the paper. Any other amount can be used; None weights all equally.

    If two points are equally near, the heavier one gets the vertex. Without detections fpe is 0, fne 1 and wme 1.
    Raises ValueError for no points, a repeated point, ids outside the mesh, or bad weights.
    """
    points, tolerances = _vertex_ids(mesh, points, "points"), _checked_tolerances(tolerances)
    if len(points) == 0 or len(np.unique(points)) < len(points):
        raise ValueError(f"points must be at least one vertex, without repetitions, got {points.tolist()}")
    weights = _checked_weights(weights, len(points), len(tolerances))
    detected = np.unique(_vertex_ids(mesh, detected, "detected"))
    distances = geodesics(mesh).distances(points, _distance_limits(mesh, tolerances).max())[:, detected]
    hits = _nearest_detection(distances, weights)[:, None] <= _distance_limits(mesh, tolerances)
    count = hits.sum(axis=0)
    return {
        "fne": 1 - count / len(points),
        "fpe": 1 - count / len(detected) if len(detected) else np.zeros(len(tolerances)),
        "wme": 1 - (weights * hits).sum(axis=0) / weights.sum(axis=0),
    }


def _nearest_detection(distances, weights):
    """(g,) distance of each point to the nearest detected vertex without a nearer point; infinite if there is none."""
    heavy = np.argsort(-weights.sum(axis=1), kind="stable")
    owner = heavy[np.argmin(distances[heavy], axis=0)]
    owned = owner == np.arange(len(distances))[:, None]
    return np.where(owned, distances, np.inf).min(axis=1, initial=np.inf)


def _distance_limits(mesh, tolerances):
    """(t,) tolerances in units of the mesh; slightly more, so that rounding does not matter at multiples of an edge."""
    return tolerances * mesh.diagonal * (1 + 1e-9)


def _vertex_ids(mesh, ids, name):
    ids = np.asarray(ids)
    if ids.size == 0:
        return np.zeros(0, dtype=np.int64)
    if ids.ndim != 1 or ids.dtype.kind not in "iu" or ids.min() < 0 or ids.max() >= len(mesh.vertices):
        raise ValueError(f"{name} must be vertex ids in 0..{len(mesh.vertices) - 1}, shape (k,), got {ids}")
    return ids.astype(np.int64)


def _checked_tolerances(tolerances):
    values = np.asarray(tolerances, dtype=np.float64)
    if values.ndim != 1 or len(values) == 0 or not np.isfinite(values).all() or values.min() < 0:
        raise ValueError(f"tolerances must be shares of the diagonal, 0 or more, shape (t,), got {values}")
    return values


def _checked_weights(weights, count, steps):
    values = np.ones(count) if weights is None else np.asarray(weights, dtype=np.float64)
    if values.shape not in ((count,), (count, steps)):
        raise ValueError(f"weights must have shape ({count},) or ({count}, {steps}), got {values.shape}")
    values = np.broadcast_to(values.reshape(count, -1), (count, steps))
    if not np.isfinite(values).all() or (values < 0).any() or not values.any(axis=0).all():
        raise ValueError("weights must be finite, not negative and not all zero at any tolerance")
    return values

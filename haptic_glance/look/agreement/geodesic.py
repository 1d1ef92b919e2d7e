"""Distances along a surface: shortest paths over the mesh's edges and straight across pairs of neighbouring faces."""

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

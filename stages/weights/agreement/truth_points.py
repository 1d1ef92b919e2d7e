"""Ground-truth points from a density of gaze, so that detectors of points can be judged where nobody marked any."""

import numpy as np

from .geodesic import geodesics

BATCH = 256  # peaks whose distances are held at once: 40 MB at 20,000 vertices
DIGITS = 9  # of the largest density: what differs less is equal, rounding must not decide


def truth_points(mesh, density, radius=0.05, least=0.01):
    """(points (k,), weights (k,)): the peaks of a density (n,) of gaze, heaviest first, and the gaze around each.

    A peak is a vertex with no higher one around it and some lower one: a plateau has no peak. Around it are the
    vertices within `radius` over the surface, a share of the bounding-box diagonal, and its neighbours by an edge. Of
    equal ones the last by x, then y, then z is the peak, whatever the order of the vertices. Its weight is the share of
    all gaze (density times area) that lies within the radius and nearer to it than to any other peak; the weights sum
    to one at most. Left out are peaks with less than `least`, or with no more than even attention would leave there, as
    Dutagaci et al. (2012) leave out what fewer than n people marked. Raises ValueError for a density that does not fit
    the mesh, is empty or even.
    """
    density = np.asarray(density, dtype=np.float64)
    if density.shape != (len(mesh.vertices),) or not np.isfinite(density).all() or (density < 0).any():
        raise ValueError(f"density must be {len(mesh.vertices)} finite values, not negative, got {density.shape}")
    if not (radius > 0 and 0 <= least < 1):
        raise ValueError(f"radius must be above 0 and least in 0..1, as shares, got {radius} and {least}")
    areas = mesh.vertex_areas
    density = np.where(areas > 0, density, 0.0)
    if not density.any():
        raise ValueError("density is empty, zero on the whole surface: leave this mesh out")
    surface, reach = geodesics(mesh), radius * mesh.diagonal
    peaks = _peaks(mesh, surface, np.round(density / density.max(), DIGITS), reach)
    if len(peaks) == 0:
        raise ValueError("density is even, so that it has no peak: leave this mesh out")
    weights, even = _shares(surface.distances(peaks, reach), density * areas, areas)
    kept = np.argsort(-weights, kind="stable")
    kept = kept[((weights >= least) & (weights > even))[kept]]
    return peaks[kept], weights[kept]


def _peaks(mesh, surface, levels, reach):
    """Vertex ids that come first by level, then position, among those around, and stand above some of them."""
    order = np.lexsort((*-mesh.vertices.T[::-1], -levels))
    ranks = np.empty(len(order), dtype=np.int64)
    ranks[order] = np.arange(len(order))
    lowest = _least_around(mesh, levels)
    candidates = order[((levels > 0) & (_least_around(mesh, ranks) == ranks))[order]]
    found = [candidates[:0]]
    for start in range(0, len(candidates), BATCH):
        batch = candidates[start : start + BATCH]
        near = np.isfinite(surface.distances(batch, reach))
        first = np.where(near, ranks, len(ranks)).min(axis=1) == ranks[batch]
        above = np.where(near, lowest, np.inf).min(axis=1) < levels[batch]
        found.append(batch[first & above])
    return np.concatenate(found)


def _least_around(mesh, values):
    """(n,) the least of values (n,) at each vertex and its neighbours by an edge."""
    tail, head = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    least = values.copy()
    np.minimum.at(least, tail, values[head])
    np.minimum.at(least, head, values[tail])
    return least


def _shares(distances, *amounts):
    """For each of amounts (n,) its share nearest to each peak, (k,), by the distances (k, n) of those in reach."""
    inside = np.isfinite(distances.min(axis=0))
    owner = np.argmin(distances, axis=0)[inside]
    return [np.bincount(owner, weights=one[inside], minlength=len(distances)) / one.sum() for one in amounts]

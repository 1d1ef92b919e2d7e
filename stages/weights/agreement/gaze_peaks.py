"""Ground truth points from a density of gaze, to evaluate detectors of points where nobody marked any."""

import numpy as np

from stages.kit import Mesh

from .geodesic import geodesics

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
    kept = np.argsort(-weights, kind="stable")
    kept = kept[((weights >= min_weight) & (weights > even))[kept]]
    return peaks[kept], weights[kept]


def _peaks(mesh, surface, levels, limit):
    """Ids of the vertices that are first by level, then position, in their neighbourhood, and above some of it."""
    order = np.lexsort((*-mesh.vertices.T[::-1], -levels))
    ranks = np.empty(len(order), dtype=np.int64)
    ranks[order] = np.arange(len(order))
    lowest = _neighbour_minimum(mesh, levels)
    candidates = order[((levels > 0) & (_neighbour_minimum(mesh, ranks) == ranks))[order]]
    found = [candidates[:0]]
    for start in range(0, len(candidates), BATCH):
        batch = candidates[start : start + BATCH]
        near = np.isfinite(surface.distances(batch, limit))
        first = np.where(near, ranks, len(ranks)).min(axis=1) == ranks[batch]
        above = np.where(near, lowest, np.inf).min(axis=1) < levels[batch]
        found.append(batch[first & above])
    return np.concatenate(found)


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
    return [np.bincount(owner, weights=one[inside], minlength=len(distances)) / one.sum() for one in amounts]

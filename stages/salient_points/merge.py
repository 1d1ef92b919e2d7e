"""The points of all views as one list of vertices, most salient first."""

import numpy as np

from stages.kit import Mesh

SAME_PLACE = 1e-6  # of the diagonal: below this spacing, points coincide


def merge_views(
    mesh: Mesh, vertices: np.ndarray, values: np.ndarray, strong: np.ndarray, radius: float
) -> tuple[np.ndarray, int]:
    """Candidates of many views without duplicates: (vertices (k,) i8, how many leading ones are strong).

    vertices, values, strong (c,): vertex, saliency and threshold mark of each candidate. Strong ones come first, then
    by saliency. A candidate within `radius` (units) of one already taken is the same feature seen from another view:
    two points of one view are never that near, since projection only shortens distances. Keeping both would count one
    feature as often as it is seen.
    """
    order = np.lexsort((-values, ~strong))
    kept = spaced(mesh.vertices[vertices[order]], radius)
    return vertices[order][kept], int(strong[order][kept].sum())


def continue_on_surface(mesh: Mesh, points: np.ndarray, saliency: np.ndarray, radius: float, count: int) -> np.ndarray:
    """Points (k,) continued to `count` vertices by the saliency (n,), or to all vertices in a face where fewer.

    The spacing starts at `radius` and halves as the surface fills up. Ties of saliency go by position, never by vertex
    number, so that the order of the vertices plays no role.
    """
    used = np.flatnonzero(mesh.vertex_normals.any(axis=1))
    x, y, z = mesh.vertices[used].round(9).T
    ranked = used[np.lexsort((z, y, x, -saliency[used]))]
    while len(points) < min(count, len(used)):
        both = np.r_[points, ranked[~np.isin(ranked, points)]]
        if radius < SAME_PLACE * mesh.diagonal:  # only coincident vertices are left
            return both[:count]
        points = both[spaced(mesh.vertices[both], radius, first=len(points), limit=count)]
        radius /= 2
    return points[:count]


def spaced(positions: np.ndarray, radius: float, first: int = 0, limit: int | None = None) -> np.ndarray:
    """Indices of positions (k, 3), in order, each farther than radius from all before it; the `first` ones stay.

    limit: stop at so many; None for all.
    """
    alive = np.ones(len(positions), dtype=bool)
    kept = []
    for i in range(len(positions)):
        if limit is not None and len(kept) >= max(limit, first):
            break
        if alive[i] or i < first:
            kept.append(i)
            rest = slice(i + 1, None)
            alive[rest] &= ((positions[rest] - positions[i]) ** 2).sum(axis=1) > radius**2
    return np.array(kept, dtype=np.int64)

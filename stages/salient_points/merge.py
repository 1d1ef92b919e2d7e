"""The points of all views as one list of vertices, most salient first."""

import numpy as np

from stages.kit import Mesh

from .kernels import spaced

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
    kept = spaced(mesh.vertices[vertices[order]], radius, 0, len(order))
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
        points = both[spaced(mesh.vertices[both], radius, len(points), count)]
        radius /= 2
    return points[:count]

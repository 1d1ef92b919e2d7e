"""The points of all views as one list of vertices, most salient first."""

import numpy as np

SAME_PLACE = 1e-6  # of the diagonal: closer than this no spacing is left to halve


def merge_views(mesh, vertices, order_by, strong, radius):
    """Candidates of many views without duplicates: (vertices (k,) i8, how many leading ones are strong).

    vertices, order_by, strong (c,): vertex, brightness and threshold mark of each candidate. Strong ones come first,
    then by brightness. A candidate within `radius` (units) of one already taken is the same feature seen from another
    view: two points of one view are never that near, since a projection only shortens distances, so keeping both
    would count one feature as often as it is seen.
    """
    order = np.lexsort((-order_by, ~strong))
    kept = spaced(mesh.vertices[vertices[order]], radius)
    return vertices[order][kept], int(strong[order][kept].sum())


def continue_on_surface(mesh, points, saliency, radius, count):
    """Points (k,) continued to `count` vertices by the saliency (n,) of the vertices, or to all that a face uses.

    The spacing starts at `radius` and halves as the surface fills up. Equal saliency goes by position, never by
    vertex number, so that the order of the vertices plays no role.
    """
    used = np.flatnonzero(mesh.vertex_normals.any(axis=1))
    x, y, z = mesh.vertices[used].round(9).T
    ranked = used[np.lexsort((z, y, x, -saliency[used]))]
    while len(points) < min(count, len(used)):
        both = np.r_[points, ranked[~np.isin(ranked, points)]]
        if radius < SAME_PLACE * mesh.diagonal:  # coincident vertices are all that is left
            return both[:count]
        points = both[spaced(mesh.vertices[both], radius, first=len(points), most=count)]
        radius /= 2
    return points[:count]


def spaced(positions, radius, first=0, most=None):
    """Indices of positions (k, 3), in order, each farther than radius from all before it; the `first` ones stay."""
    alive = np.ones(len(positions), dtype=bool)
    kept = []
    for i in range(len(positions)):
        if most is not None and len(kept) >= max(most, first):
            break
        if alive[i] or i < first:
            kept.append(i)
            rest = slice(i + 1, None)
            alive[rest] &= ((positions[rest] - positions[i]) ** 2).sum(axis=1) > radius**2
    return np.array(kept, dtype=np.int64)

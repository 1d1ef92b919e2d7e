"""Where the touches of one sample lie: at separate points, in the salient region around one, or in a disc (T6.3)."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from stages.imprints import touchable
from stages.kit import Mesh

EXTENTS = ("points", "region", "disc")


def sample_vertices(
    mesh: Mesh,
    saliency: np.ndarray,
    points: np.ndarray,
    extent: str,
    count: int,
    share: float,
    random: np.random.Generator,
) -> np.ndarray:
    """(k * count,) vertices to touch, each `count` of them one sample that begins with one of the first k points.

    mesh: a Mesh; saliency (n,) in 0..1; points: vertex ids, most salient first, of which k = len(points) // count begin
    a sample. extent `points`: the others are the remaining points, dealt out in turn; `region`: random vertices, by
    area, of `salient_region` around the point; `disc`: of a disc around it with the region's area. So every extent
    touches as often, in as many samples.
    """
    centres = points[: len(points) // count]
    if extent == "points":
        return points[: len(centres) * count].reshape(count, -1).T.ravel()
    chosen = []
    for centre in centres:
        inside = salient_region(mesh, saliency, centre, share, count)
        inside = inside if extent == "region" else disc(mesh, centre, mesh.vertex_areas[inside].sum(), count)
        others = inside[(inside != centre) & touchable(mesh, inside)]
        weights = mesh.vertex_areas[others]
        drawn = random.choice(others, count - 1, replace=len(others) < count - 1, p=weights / weights.sum())
        chosen.append([centre, *drawn])
    return np.ravel(chosen)


def salient_region(mesh: Mesh, saliency: np.ndarray, centre: int, share: float, least: int) -> np.ndarray:
    """Vertices that are connected with `centre` through vertices of at least `share` of its saliency.

    Where fewer than `least` of them have an area, the vertices nearest to the centre.
    """
    strong = np.flatnonzero(saliency >= share * saliency[centre])
    _, labels = connected_components(mesh.adjacency[strong][:, strong], directed=False)
    found = strong[labels == labels[np.searchsorted(strong, centre)]]
    return found if touchable(mesh, found).sum() >= least else disc(mesh, centre, 0.0, least)


def disc(mesh: Mesh, centre: int, area: float, least: int) -> np.ndarray:
    """The vertices nearest to `centre`, as many as have the area together, and `least` that can be touched."""
    order = np.argsort(np.linalg.norm(mesh.vertices - mesh.vertices[centre], axis=1), kind="stable")
    order = order[touchable(mesh, order)]
    return order[: max(least, np.searchsorted(np.cumsum(mesh.vertex_areas[order]), area) + 1)]

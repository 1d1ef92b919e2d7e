"""Where the touches of one sample lie: at separate points, in the salient region around one, or in a disc (T6.3)."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import touchable

EXTENTS = ("points", "region", "disc")
ARRAY = "16-0.01"  # CELLS-PITCH of the array that they are tried with
TOUCHES = 5  # of a sample
SHARE = 0.8  # of a point's saliency, above which what is connected with it is one region


def sample_vertices(
    mesh: Mesh, saliency: np.ndarray, points: np.ndarray, extent: str, random: np.random.Generator
) -> np.ndarray:
    """(k * TOUCHES,) vertices to touch, each TOUCHES of them one sample that begins with one of the first k points.

    saliency (n,) in 0..1; points: vertex ids, most salient first, of which k = len(points) // TOUCHES begin a sample.
    extent `points`: the others are the remaining points, dealt out in turn; `region`: random vertices, by area, of
    `salient_region` around the point; `disc`: of a disc around it with the region's area. So every extent touches as
    often, in as many samples.
    """
    centres = points[: len(points) // TOUCHES]
    if extent == "points":
        return points[: len(centres) * TOUCHES].reshape(TOUCHES, -1).T.ravel()
    chosen = []
    for centre in centres:
        inside = salient_region(mesh, saliency, centre)
        inside = inside if extent == "region" else disc(mesh, centre, mesh.vertex_areas[inside].sum())
        others = inside[(inside != centre) & touchable(mesh, inside)]
        weights = mesh.vertex_areas[others]
        drawn = random.choice(others, TOUCHES - 1, replace=len(others) < TOUCHES - 1, p=weights / weights.sum())
        chosen.append([centre, *drawn])
    return np.ravel(chosen)


def salient_region(mesh: Mesh, saliency: np.ndarray, centre: int) -> np.ndarray:
    """Vertices that are connected with `centre` through vertices of at least SHARE of its saliency.

    Where fewer than TOUCHES of them can be touched, as many vertices nearest to the centre.
    """
    strong = np.flatnonzero(saliency >= SHARE * saliency[centre])
    _, labels = connected_components(mesh.adjacency[strong][:, strong], directed=False)
    found = strong[labels == labels[np.searchsorted(strong, centre)]]
    return found if touchable(mesh, found).sum() >= TOUCHES else disc(mesh, centre, 0.0)


def disc(mesh: Mesh, centre: int, area: float) -> np.ndarray:
    """The touchable vertices nearest to `centre`, as many as have the area together, and at least TOUCHES."""
    order = np.argsort(np.linalg.norm(mesh.vertices - mesh.vertices[centre], axis=1), kind="stable")
    order = order[touchable(mesh, order)]
    return order[: max(TOUCHES, np.searchsorted(np.cumsum(mesh.vertex_areas[order]), area) + 1)]

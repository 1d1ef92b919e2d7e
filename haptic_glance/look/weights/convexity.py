"""The convexity of an object, its share of the volume of its convex hull (T eq. 3.20), and the nearest object in it.

The thesis trains one SVM per object, and uses for a new object the SVM of the object with the closest convexity (end
of section 3.2).
"""

from collections.abc import Mapping

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from haptic_glance.mesh.mesh import Mesh

FLAT = 1e-7  # of the largest extent; a thinner mesh has no meaningful volume
ROUNDING = 1e-6  # convexities closer than this are equal


def convexity(mesh: Mesh) -> float:
    """The volume of a mesh over that of its convex hull, above 0 and at most 1 (T eq. 3.20).

    mesh: consistently wound (haptic_glance.mesh.repair), outwards or inwards. An open mesh is closed first: each
    boundary loop gets a fan of triangles around its centre. A crack adds almost no volume, a bowl made of one sheet
    counts as if it were full, and a bowl with a wall counts by the volume of its wall. The volumes of connected
    components add up; where they overlap so much that the sum exceeds the hull's, the result is 1. For a flat mesh,
    areas replace volumes. Vertices in no face, and faces without area, are ignored.

    Raises ValueError for a mesh without any area.
    """
    corners = mesh.vertices[mesh.faces[mesh.face_areas > 0]]
    if not len(corners):
        raise ValueError("the mesh has no face with an area, so that its convexity is undefined")
    points, faces = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    points = points - points.mean(axis=0)
    points = points @ np.linalg.svd(points, full_matrices=False)[2].T  # to principal axes, the one of least extent last
    extents = np.ptp(points, axis=0)
    points, faces = points / extents[0], faces.reshape(-1, 3)
    tails, heads = _boundary_edges(faces, len(points))
    if extents[2] <= FLAT * extents[0]:
        measure = _area(points, faces) / (1 if len(tails) else 2)  # closed and flat: two coincident sides
        hull = ConvexHull(points[:, :2])
    else:
        measure = abs(_volume(points, faces, tails, heads))
        hull = ConvexHull(points)
    return float(min(measure / hull.volume, 1.0))


def _area(points, faces):
    a, b, c = points[faces].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def _boundary_edges(faces, count):
    """Directed edges without an opposite edge, repeated by multiplicity: (tails, heads)."""
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    size = (count, count)
    edges = sparse.coo_matrix((np.ones(len(tails)), (tails, heads)), shape=size).tocsr()
    unpaired = (edges - edges.T).tocoo()
    times = unpaired.data.clip(0).astype(np.int64)
    return np.repeat(unpaired.row, times), np.repeat(unpaired.col, times)


def _volume(points, faces, tails, heads):
    """The signed volume inside the faces and a fan of triangles over each boundary loop."""
    inside = _tetrahedra(*points[faces].transpose(1, 0, 2))
    if not len(tails):
        return inside
    graph = sparse.coo_matrix((np.ones(len(tails)), (tails, heads)), shape=(len(points), len(points)))
    loop = connected_components(graph, directed=False)[1][tails]
    start, end = points[tails], points[heads]
    length = np.linalg.norm(end - start, axis=1)
    total = np.bincount(loop, length)
    middle = np.stack([np.bincount(loop, length * axis) for axis in ((start + end) / 2).T], axis=1)[loop]
    return inside + _tetrahedra(end, start, middle / total[loop, None])


def _tetrahedra(a, b, c):
    """The summed signed volume between triangles (k, 3) a, b, c and the origin."""
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def nearest_convexity(value: float, others: Mapping[str, float]) -> str:
    """The name of the object with the nearest convexity; others: dict name -> convexity.

    Of equally near ones (to ROUNDING) the first by name, so that neither rounding nor the order of the dict decides
    between convex objects. Raises ValueError when there are no others, or a value is not finite.
    """
    if not others:
        raise ValueError("there is no other object to choose the nearest convexity from")
    if not np.isfinite([value, *others.values()]).all():
        raise ValueError(f"convexities must be finite, got {value} and {others}")
    gaps = {name: abs(other - value) for name, other in others.items()}
    return min(name for name, gap in gaps.items() if gap <= min(gaps.values()) + ROUNDING)

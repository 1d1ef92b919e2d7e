"""How convex an object is: its share of its convex hull (T eq. 3.20), and the object nearest to it in that.

The thesis trains one SVM an object, and gives a new object the SVM of the object with the closest convexity (end of
section 3.2).
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

FLAT = 1e-7  # of the largest extent: a thinner mesh has no volume that could be compared
SAME = 1e-6  # convexities nearer than this differ by rounding


def convexity(mesh):
    """The volume of a mesh over that of its convex hull, above 0 and at most 1 (T eq. 3.20).

    mesh: stages.kit.Mesh, its faces wound alike (stages.meshes.load sees to that); outwards or inwards is the same. An
    open mesh is closed first by a lid over each hole, a fan around the middle of its rim: a crack adds next to
    nothing, but a bowl made of one sheet counts as if it were full, while a bowl with a wall counts by its wall.
    Pieces add up, and where they overlap so much that the sum passes the hull's, the result is 1. A flat mesh has
    areas in the place of volumes. Vertices in no face, and faces without area, count for nothing.

    Raises ValueError for a mesh without any area.
    """
    corners = mesh.vertices[mesh.faces[mesh.face_areas > 0]]
    if not len(corners):
        raise ValueError("the mesh has no face with an area, so that it has no convexity: give it faces")
    points, faces = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    points = points - points.mean(axis=0)
    points = points @ np.linalg.svd(points, full_matrices=False)[2].T  # along the principal axes, the thinnest last
    extents = np.ptp(points, axis=0)
    points, faces = points / extents[0], faces.reshape(-1, 3)
    tails, heads = _rims(faces, len(points))
    if extents[2] <= FLAT * extents[0]:
        measure = _area(points, faces) / (1 if len(tails) else 2)  # closed and flat: two sides, one on the other
        hull = ConvexHull(points[:, :2])
    else:
        measure = abs(_volume(points, faces, tails, heads))
        hull = ConvexHull(points)
    return float(min(measure / hull.volume, 1.0))


def _area(points, faces):
    a, b, c = points[faces].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def _rims(faces, count):
    """Directed edges without a partner in the other direction: (tails, heads), one row for each edge left over."""
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    size = (count, count)
    edges = sparse.coo_matrix((np.ones(len(tails)), (tails, heads)), shape=size).tocsr()
    left = (edges - edges.T).tocoo()
    times = left.data.clip(0).astype(np.int64)
    return np.repeat(left.row, times), np.repeat(left.col, times)


def _volume(points, faces, tails, heads):
    """The signed volume inside the faces and a lid on each rim."""
    inside = _tetrahedra(*points[faces].transpose(1, 0, 2))
    if not len(tails):
        return inside
    graph = sparse.coo_matrix((np.ones(len(tails)), (tails, heads)), shape=(len(points), len(points)))
    rim = connected_components(graph, directed=False)[1][tails]
    start, end = points[tails], points[heads]
    length = np.linalg.norm(end - start, axis=1)
    total = np.bincount(rim, length)
    middle = np.stack([np.bincount(rim, length * axis) for axis in ((start + end) / 2).T], axis=1)[rim]
    return inside + _tetrahedra(end, start, middle / total[rim, None])


def _tetrahedra(a, b, c):
    """The summed signed volume between triangles (k, 3) a, b, c and the origin."""
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def nearest(value, others):
    """The name of the object nearest in convexity: others is a dict name -> convexity.

    Of equally near ones (to SAME) the first by name: all convex objects are 1 but for rounding, and neither that nor
    the order of the dict must decide. Raises ValueError when there are no others, or a value is not finite.
    """
    if not others:
        raise ValueError("no object to choose from: the nearest in convexity needs at least one other")
    if not np.isfinite([value, *others.values()]).all():
        raise ValueError(f"convexities must be finite, got {value} and {others}")
    gaps = {name: abs(other - value) for name, other in others.items()}
    return min(name for name, gap in gaps.items() if gap <= min(gaps.values()) + SAME)

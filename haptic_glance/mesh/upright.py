"""Chooses the axis that points up, y or z, by the shape of a surface, for files that do not say.

Objects stand on a flat or wide support with their middle above it, have legs and room below rather than above, and
differ more between top and bottom than between their sides. A logistic regression on such features of both axes,
learned from objects whose axis is known (benchmarks/up_axis.py), gives the probability. The features are integrals over
the surface, so that they depend neither on the order of faces nor on their number or winding. Source of the idea: Fu,
Cohen-Or, Dror and Sheffer, Upright orientation of man-made objects, ACM TOG 27(3), 2008.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, KDTree, QhullError

from .axes import AUTO, to_z_up
from .mesh import Mesh

CANDIDATES = "z", "y"  # of equal ones the first
EVEN = 0.05  # log of the odds below which the axes are equal: so much a coarse ball has
SURE = 0.8  # probability from which a choice is right about nine times in ten, below it about two times in three
# Lengths in units of the object's diameter.
PIECE = 0.03  # longest edge of a piece of a face
MOST = 200_000  # about a third of the most pieces, but for a mesh of more faces
CELL = 0.035  # side of the cells whose means stand for the surface where points are compared
PIXEL = 0.04  # of the depth pictures from below and above
STEEP = 0.1  # |z| of a normal below which a surface faces to the side
THIN, LOW, SLAB = 0.02, 0.06, 0.12  # heights above the lowest point: of the support, of feet, of legs
# feature -> weight of its difference between two axes in the log of the odds
WEIGHTS = {
    "base": 2.36, "margin": 1.4, "low_margin": 0.8, "tilt": -0.99, "gap_below": 1.37, "gap_above": 2.05,
    "legs": 0.4, "mirror": 10.82, "turn": -1.68, "tall": 0.4, "flat": -0.48,
    "centre": -0.27, "taper": -0.51, "vertical": -0.54,
}  # fmt: skip


def settled(mesh: Mesh) -> Mesh:
    """The Mesh with the axis that its shape suggests where nobody has said which points up; another one as it is."""
    return replace(mesh, up=probable_up(mesh)[0]) if mesh.up == AUTO else mesh


@lru_cache(maxsize=4)  # asked of one mesh for its axis, then for its probability
def probable_up(mesh: Mesh) -> tuple[str, float]:
    """("y" or "z", the probability that this axis points up rather than the other); ("z", 0.5) for a mesh of no area.

    The same holds for a sphere or a cube, whose axes do not differ.
    """
    by_axis = features(mesh)
    if not by_axis:
        return CANDIDATES[0], 0.5
    first, second = (by_axis[axis] for axis in CANDIDATES)
    odds = sum(weight * (first[name] - second[name]) for name, weight in WEIGHTS.items())
    even = abs(odds) < EVEN
    return CANDIDATES[int(odds < 0 and not even)], 0.5 if even else float(1 / (1 + np.exp(-abs(odds))))


def features(mesh: Mesh, axes: tuple[str, ...] = CANDIDATES) -> dict[str, dict[str, float]]:
    """{axis: {feature: value}} of a Mesh, in any place, size and tessellation; empty for one without area."""
    corners = mesh.vertices[mesh.used]
    with np.errstate(over="ignore"):
        extent = np.ptp(corners, axis=0).max() if len(corners) else 0.0
    if not (extent > 0 and np.isfinite(extent)):
        return {}
    points, areas, normals = _pieces(mesh.vertices[mesh.faces] / extent - corners[0] / extent)
    if not len(points):
        return {}
    middle = areas @ points
    corners = corners / extent - corners[0] / extent - middle
    diameter = 2 * np.linalg.norm(corners, axis=1).max()
    points, corners = (points - middle) / diameter, corners / diameter
    hull = _hull(corners)
    corners, faces = (corners, np.zeros((0, 4))) if hull is None else (corners[hull.vertices], hull.equations)
    cells = _cells(points, areas)
    by_axis = {}
    for axis in axes:
        turn = to_z_up(axis).astype(np.float64)
        hull_planes, is_steep = np.column_stack([faces[:, :3] @ turn.T, faces[:, 3]]), np.abs(normals @ turn[2]) < STEEP
        means = cells[0] @ turn.T, cells[1]
        by_axis[axis] = _of_axis(points @ turn.T, areas, is_steep, means, corners @ turn.T, hull_planes)
    return by_axis


def _pieces(corners):
    """(middles (k, 3), shares of the area (k,), unit normals (k, 3)) of faces (m, 3, 3) cut into pieces.

    A face is halved across its longest edge until that is short, so that a sliver is cut along its length alone.
    """
    edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    least = np.sqrt(area / MOST), edges.max(axis=1).sum() / MOST  # of a tangle, whose pieces would fill the memory
    longest, pieces = max(PIECE * np.linalg.norm(np.ptp(corners, axis=(0, 1))), *least), []
    while len(corners):
        edges = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        edge = edges.argmax(axis=1)
        rows = np.arange(len(corners))
        long = edges[rows, edge] > longest
        pieces.append(corners[~long])
        a, b, c = (corners[rows[long], (edge[long] + k) % 3] for k in range(3))
        corners = np.concatenate([np.stack([a, (a + b) / 2, c], axis=1), np.stack([(a + b) / 2, b, c], axis=1)])
    corners = np.concatenate([*pieces, np.zeros((0, 3, 3))])
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(crosses, axis=1)
    solid = areas > 0
    return corners[solid].mean(axis=1), areas[solid] / areas.sum(), crosses[solid] / areas[solid, None]


def _cells(points, areas):
    """(means (c, 3), shares of the area (c,)) of the points in each cell of a grid."""
    key = np.floor(points / CELL).astype(np.int64) @ [1 << 42, 1 << 21, 1]
    cell = np.unique(key, return_inverse=True)[1].ravel()
    share = np.bincount(cell, areas)
    return np.stack([np.bincount(cell, areas * column) for column in points.T], axis=1) / share[:, None], share


def _hull(points):
    """The ConvexHull of points, None where they lie in a plane or on a line."""
    try:
        return ConvexHull(points) if len(points) > points.shape[1] else None
    except QhullError:
        return None


def _of_axis(points, areas, steep, cells, corners, faces):
    """{feature: value} of a surface turned so that an axis is +z, the mean of its area at 0.

    points (k, 3) with areas (k,); steep (k,): whether each faces to the side. cells: (means, shares).
    corners (v, 3) of the convex hull, faces (f, 4) its planes.
    """
    lowest, highest = corners[:, 2].min(), corners[:, 2].max()
    tall, above, below = max(highest - lowest, 1e-3), highest - points[:, 2], points[:, 2] - lowest
    outline = _hull(corners[:, :2])
    foot = max(outline.volume, 1e-3) if outline is not None else 1e-3
    wide, margin = _support(points[below < THIN], foot)
    gap_below, gap_above = _gaps(points[:, :2], below, above)
    slender = float(np.log(tall / np.sqrt(foot)))
    means, shares = cells
    tree = KDTree(means)
    downwards = faces[faces[:, 2] < -1e-9]
    rests_on = downwards[(downwards[:, 3] / downwards[:, 2]).argmin(), 2] if len(downwards) else -1.0
    return {
        "base": wide, "margin": margin, "low_margin": _support(points[below < LOW], foot)[1],
        "tilt": np.arccos(min(-rests_on, 1.0)),
        "gap_below": gap_below.mean() / tall,
        "gap_above": gap_above.mean() - gap_below.mean(), "legs": _legs(means[means[:, 2] - lowest < SLAB]),
        "mirror": _apart(tree, means * [1, 1, -1], shares), "turn": _apart(tree, means * [-1, -1, 1], shares),
        "tall": max(slender, 0.0), "flat": min(slender, 0.0), "centre": -lowest / tall,
        "taper": np.log(_spread(points, areas, below < tall / 3) / _spread(points, areas, above < tall / 3)),
        "vertical": areas[steep].sum(),
    }  # fmt: skip


def _support(points, foot):
    """(root of the share of the outline that the hull of a support covers, how far 0 lies inside it).

    foot: the area of the outline, whose root is the unit of that length; -0.3 without a support.
    """
    hull = _hull(points[:, :2])
    if hull is None:
        return 0.0, -0.3
    inside = -hull.equations[:, 2].max() / np.sqrt(foot)
    return np.sqrt(min(hull.volume / foot, 1.0)), float(np.clip(inside, -0.5, 0.5))


def _gaps(places, below, above):
    """(p,), (p,) the least height above the lowest point, and below the highest, of each pixel that has a point."""
    pixel = np.unique(np.floor(places / PIXEL).astype(np.int64) @ [1 << 21, 1], return_inverse=True)[1].ravel()
    gaps = np.full((2, pixel.max() + 1), np.inf)
    for gap, heights in zip(gaps, (below, above), strict=True):
        np.minimum.at(gap, pixel, heights)
    return gaps[0], gaps[1]


def _legs(means):
    """The log of the number of parts that cells form, up to 5; a part has at least a twentieth of them."""
    pairs = KDTree(means).query_pairs(2 * CELL, output_type="ndarray") if len(means) else np.zeros((0, 2), int)
    graph = coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(len(means), len(means)))
    parts = np.bincount(connected_components(graph, directed=False)[1]) if len(means) else np.ones(1)
    return np.log(min(max((parts > 0.05 * len(means)).sum(), 1), 5))


def _apart(tree, moved, shares):
    """The mean distance, by area, of moved cells from the surface; more than 0.15 counts as that."""
    return shares @ np.minimum(tree.query(moved)[0], 0.15)


def _spread(points, areas, mask):
    """The radius of gyration about the vertical of the points in the mask, at least 0.02."""
    if not mask.any():
        return 0.02
    middle = np.average(points[mask, :2], axis=0, weights=areas[mask])
    return 0.02 + np.sqrt(np.average(((points[mask, :2] - middle) ** 2).sum(axis=1), weights=areas[mask]))

"""The size of the kept neighbourhood of a salient point: fixed, by the mesh's density, or by the region's area."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from stages.kit import Mesh

from .feasibility import Keep, check_keep

RINGS = 3  # T3.1.3
SALIENT_SHARE = 0.3  # of the surface, the most salient: the regions of interest of T3.1.1


def neighbourhoods(
    mesh: Mesh, keep: Keep, rule: str = "fixed", saliency: np.ndarray | None = None, rings: int = RINGS
) -> np.ndarray:
    """(k,) i8: how many rings around each vertex of `keep` to preserve, for `simplify(..., rings=...)`.

    rule: `fixed`, the same for all (T3.1.3, three); `adaptive`, 1 to 3 by the density of the mesh there (T eq. 3.17);
    `area`, by the area of the salient region around the vertex (T3.1.3). saliency: (n,) f8 per vertex, for `area`.
    rings: the number for `fixed`. Raises ValueError for another rule, ids outside the mesh, or `area` without saliency.
    """
    keep = check_keep(mesh, keep)
    if rule not in NEIGHBOURHOODS:
        raise ValueError(f"unknown rule {rule!r} for neighbourhoods: choose one of {', '.join(NEIGHBOURHOODS)}")
    if rule == "fixed":
        return np.full(len(keep), rings, dtype=np.int64)
    return adaptive_rings(mesh, keep) if rule == "adaptive" else area_rings(mesh, keep, saliency)


def adaptive_rings(mesh: Mesh, keep: np.ndarray) -> np.ndarray:
    """(k,) i8, 1 to 3: the number of preserved neighbours NPN of T eq. 3.17, fewer where the mesh is dense.

    dist is the mean length of the edges at the vertex. distmax, in the thesis "the maximum average distance from a
    salient point to its neighbouring vertices", is read as the largest dist over the salient points: the rule is
    meant to distinguish dense regions, so points are compared with each other. (The longest edge at the point itself
    would not do so.) A mesh of even density thus keeps three rings, as with `fixed`.
    """
    length = edge_lengths(mesh, keep)
    longest = length.max(initial=0.0)
    return 1 + (3 * length > longest).astype(np.int64) + (3 * length > 2 * longest)


def area_rings(mesh: Mesh, keep: np.ndarray, saliency: np.ndarray | None) -> np.ndarray:
    """(k,) i8, 1 or more: how many rings fit into the salient region around the vertex, more in larger regions.

    The thesis says only that the regions' average surface gives the size. Here, salient is the most salient
    SALIENT_SHARE of the surface; a region is a part of it connected by edges; its area is shared evenly among the
    points in it; each point keeps as many rings as have no more area than its share. A point outside all regions keeps
    one ring.
    """
    saliency = np.zeros(0) if saliency is None else np.asarray(saliency, dtype=np.float64)
    if saliency.shape != (len(mesh.vertices),) or not np.isfinite(saliency).all():
        raise ValueError(f"neighbourhoods by area need a finite saliency per vertex, ({len(mesh.vertices)},)")
    share = _shares(mesh, keep, _most_salient(mesh, saliency))
    near = np.zeros((len(mesh.vertices), len(keep)), dtype=bool)
    near[keep, np.arange(len(keep))] = True
    rings = np.zeros(len(keep), dtype=np.int64)
    fitting = share > 0
    while fitting.any():
        rings += fitting
        seen = near.sum(axis=0)
        near |= mesh.adjacency @ near
        area = mesh.face_areas @ near[mesh.faces].all(axis=1)
        fitting &= (area <= share) & (near.sum(axis=0) > seen)
    return np.maximum(rings - 1, 1)


def _shares(mesh, keep, salient):
    """(k,) area of the salient region around each vertex over the number of points in it; 0 outside all regions."""
    region = np.full(len(mesh.vertices), -1)
    region[salient] = connected_components(mesh.adjacency[salient][:, salient], directed=False)[1]
    own, inside = region[keep], region[keep] >= 0
    area = np.bincount(region[salient], weights=mesh.vertex_areas[salient], minlength=1)
    points = np.bincount(own[inside], minlength=len(area))
    return np.where(inside, area[own] / np.maximum(points[own], 1), 0.0)


def edge_lengths(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    """(k,) mean length of the edges at each vertex, in units of the mesh; 0 at a vertex in no face."""
    near = mesh.adjacency[vertices].tocoo()
    length = np.linalg.norm(mesh.vertices[vertices][near.row] - mesh.vertices[near.col], axis=1)
    total = np.bincount(near.row, weights=length, minlength=len(vertices))
    return total / np.maximum(np.bincount(near.row, minlength=len(vertices)), 1)


def _most_salient(mesh, saliency):
    """(s,) ids of the vertices of the most salient SALIENT_SHARE of the surface, including ties with the last one.

    The lowest saliency of all is never salient: a map that is even, or zero nearly everywhere, has no region there.
    """
    order = np.argsort(-saliency, kind="stable")
    before = np.cumsum(mesh.vertex_areas[order]) - mesh.vertex_areas[order]
    within = np.searchsorted(before, SALIENT_SHARE * mesh.vertex_areas.sum())
    if within == 0:
        return order[:0]
    return np.flatnonzero((saliency >= saliency[order[within - 1]]) & (saliency > saliency.min()))


NEIGHBOURHOODS = ("fixed", "adaptive", "area")

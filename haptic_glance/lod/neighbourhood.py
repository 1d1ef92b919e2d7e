"""Neighbourhoods of salient points: fixed, by the mesh's density or by the region's area, and how they shrink.

Where the target is too low for all neighbourhoods, those of the least salient points shrink first.
"""

from bisect import bisect_left
from collections.abc import Iterator

import numpy as np
from scipy.sparse.csgraph import connected_components

from haptic_glance.mesh.mesh import Mesh

from .feasibility import InfeasibleTarget, Keep, Rings, check_keep, check_rings, smallest_feasible

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
        sizes = near.sum(axis=0)
        near |= mesh.adjacency @ near
        area = mesh.face_areas @ near[mesh.faces].all(axis=1)
        fitting &= (area <= share) & (near.sum(axis=0) > sizes)
    return np.maximum(rings - 1, 1)


def _shares(mesh, keep, salient):
    """(k,) area of the salient region around each vertex over the number of points in it; 0 outside all regions."""
    region = np.full(len(mesh.vertices), -1)
    region[salient] = connected_components(mesh.adjacency[salient][:, salient], directed=False)[1]
    regions, inside = region[keep], region[keep] >= 0
    area = np.bincount(region[salient], weights=mesh.vertex_areas[salient], minlength=1)
    points = np.bincount(regions[inside], minlength=len(area))
    return np.where(inside, area[regions] / np.maximum(points[regions], 1), 0.0)


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


LOWER = 0.8  # of the target, at each further try


def shrunk_rings(mesh: Mesh, faces: int, keep: Keep, rings: Rings = 3, free_borders: bool = False) -> np.ndarray:
    """(k,) i8 rings, none larger than given, with which `faces` faces are feasible; -1 where a vertex is not kept.

    keep: vertex ids, most salient first. rings: one number, or (k,) per kept vertex. free_borders: as of `simplify`.
    From the least salient vertex to the most salient, each gives up one ring, in rounds until none has a ring left;
    then, from the least salient on, they are not kept. It stops at the first step at which the target is feasible: of
    two points with equal neighbourhoods the more salient one never gets the smaller, and one step less would be
    infeasible. The thesis has no such rule; its meshes are distorted at such targets (T3.1.5).

    Raises InfeasibleTarget when the target is too low even with nothing kept.
    """
    keep = check_keep(mesh, keep)
    rings = check_rings(keep, rings)
    order = _order(rings)

    def after(steps):
        return rings - np.bincount(order[:steps], minlength=len(rings))

    def feasible(steps):
        return smallest_feasible(mesh, keep, after(steps), free_borders) <= faces

    if feasible(0):
        return rings
    steps = bisect_left(range(len(order) + 1), True, lo=1, key=feasible)
    if steps > len(order):
        raise InfeasibleTarget(faces, smallest_feasible(mesh, free_borders=free_borders))
    return after(steps)


def shrinking_rings(
    mesh: Mesh, faces: int, keep: Keep, rings: Rings = 3, free_borders: bool = False
) -> Iterator[np.ndarray]:
    """Yields `shrunk_rings` for the target, then for ever lower ones, at last with nothing kept.

    For a backend that finds no sound mesh although the count is feasible.
    """
    rings, target = check_rings(check_keep(mesh, keep), rings), faces
    while True:
        try:
            shrunk = shrunk_rings(mesh, target, keep, rings, free_borders)
        except InfeasibleTarget:
            shrunk = np.full_like(rings, -1)
        yield shrunk
        if (shrunk < 0).all():
            return
        target = int(LOWER * target)


def _order(rings):
    """(s,) the kept vertex that loses a ring at each step: in rounds, then the vertices themselves."""
    vertex = np.repeat(np.arange(len(rings)), rings + 1)
    step = np.arange(len(vertex)) - np.repeat(np.cumsum(rings + 1) - (rings + 1), rings + 1)
    final = rings.max(initial=0)
    rounds = np.where(step == rings[vertex], final, step)
    return vertex[np.lexsort((-vertex, rounds))]

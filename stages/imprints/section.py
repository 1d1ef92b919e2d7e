"""The section of a mesh by a plane, as ordered curves (T4.4.6)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from stages.kit import Mesh
from stages.kit.mesh import unit

MAX_CRACK = 1e-3  # of the mesh's diagonal: a finger does not notice a gap of a tenth of a sensel


@dataclass(frozen=True)
class SectionCurve:
    """One connected curve of a section: closed, or open with its ends on boundary edges.

    points (k, 3) in order, on the edges of the mesh; edges (k, 2) the vertex ids of each point's edge and weights (k,)
    how far it lies from the first to the second, 0..1; faces: the face of each segment, (k,) of a closed curve, whose
    last segment leads back to the first point, (k - 1,) of an open one.
    """

    points: np.ndarray
    edges: np.ndarray
    weights: np.ndarray
    faces: np.ndarray
    closed: bool

    @cached_property
    def steps(self) -> np.ndarray:
        """(k,) or (k - 1,) lengths of the segments."""
        ahead = np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]
        return np.linalg.norm(ahead - self.points[: len(ahead)], axis=1)

    @property
    def length(self) -> float:
        """In units of the mesh."""
        return float(self.steps.sum())

    def backwards(self) -> "SectionCurve":
        """The same curve in the other direction; a closed one starts at the same point."""
        faces = self.faces[::-1]
        if not self.closed:
            return SectionCurve(self.points[::-1], self.edges[::-1], self.weights[::-1], faces, False)
        points, edges, weights = (np.roll(part[::-1], 1, axis=0) for part in (self.points, self.edges, self.weights))
        return SectionCurve(points, edges, weights, faces, True)


class MeshCutter:
    """A mesh prepared for many sections. Vertices at one position count as one, so that no seam opens a curve."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self.positions: np.ndarray
        self.positions, inverse = np.unique(mesh.vertices, axis=0, return_inverse=True)
        self.corners: np.ndarray = inverse.reshape(-1)[mesh.faces]

    def cut(self, point: ArrayLike, normal: ArrayLike) -> list[SectionCurve]:
        """The curves on the plane through `point` (3,) with `normal` (3,), the longest first; [] if it misses the mesh.

        Each vertex counts as on one side; a distance of exactly 0 as on that of the normal (Edelsbrunner and Muecke
        1990, simulation of simplicity). So a plane through vertices, along edges or in a face is treated as shifted by
        an infinitesimal amount: every face has no or two crossed edges. At an edge of more than two faces the curves
        continue between faces that follow each other in the mesh. Ends that are each other's nearest, across a gap of
        at most a thousandth of the diagonal, are joined.
        """
        origin, direction = _plane(point, normal)
        heights = (self.positions - origin) @ direction
        above = (heights >= 0)[self.corners]
        crossed = np.flatnonzero((above != above[:, :1]).any(axis=1))
        above = above[crossed]
        # The corner that is alone on its side, then the two edges that leave it.
        alone = np.where(above[:, 1] == above[:, 2], 0, np.where(above[:, 0] == above[:, 2], 1, 2))
        ends = (alone[:, None] + [[1, 2]]) % 3
        pairs: np.ndarray = np.stack([np.broadcast_to(alone[:, None], ends.shape), ends], axis=2).reshape(-1, 2)
        faces = np.repeat(crossed, 2)
        corners = np.asarray(self.corners[faces[:, None], pairs])
        nodes = corners.min(axis=1) * len(self.positions) + corners.max(axis=1)
        proper = np.repeat(nodes[::2] != nodes[1::2], 2)  # a face with two corners at one position has no inside
        faces, pairs, corners, nodes = faces[proper], pairs[proper], corners[proper], nodes[proper]
        if len(nodes) == 0:
            return []
        flip = corners[:, 0] > corners[:, 1]  # both faces of an edge then give the same point, bit for bit
        pairs[flip], corners[flip] = pairs[flip, ::-1], corners[flip, ::-1]
        low, high = heights[corners[:, 0]], heights[corners[:, 1]]
        weights = low / (low - high)
        starts, ends = self.positions[corners].transpose(1, 0, 2)
        points = starts * (1 - weights)[:, None] + ends * weights[:, None]
        edges = self.mesh.faces[faces[:, None], pairs]
        curves = [
            SectionCurve(points[ids], edges[ids], weights[ids], faces[ids if closed else ids[:-1]], closed)
            for ids, closed in _trace_curves(_close_cracks(_partners(nodes), points, MAX_CRACK * self.mesh.diagonal))
        ]
        return sorted(curves, key=lambda curve: -curve.length)


def section(mesh: Mesh, point: ArrayLike, normal: ArrayLike) -> list[SectionCurve]:
    """The curves of the section of a mesh by a plane, the longest first; [] if the plane misses the mesh.

    point (3,) on the plane and its normal (3,), of any length, in units of the mesh. Details in
    `MeshCutter.cut`; T4.4.6 calls a curve a contour. Raises ValueError for an invalid plane.
    """
    return MeshCutter(mesh).cut(point, normal)


def _plane(point, normal):
    point, normal = np.asarray(point, dtype=np.float64), np.asarray(normal, dtype=np.float64)
    if point.shape != (3,) or normal.shape != (3,):
        raise ValueError(f"a plane is a point (3,) and a normal (3,), got shapes {point.shape} and {normal.shape}")
    if not (np.isfinite(point).all() and np.isfinite(normal).all() and np.linalg.norm(normal) > 0):
        raise ValueError(f"a plane needs finite numbers and a normal that is not 0, got {point} and {normal}")
    return point, unit(normal)


def _partners(nodes):
    """(k,): for each end of a segment the end of another segment at the same node, -1 on a boundary edge.

    The ends of segment i are 2 i and 2 i + 1.
    """
    order = np.argsort(nodes, kind="stable")
    sorted_nodes = nodes[order]
    first = np.searchsorted(sorted_nodes, sorted_nodes)
    even = (np.arange(len(nodes)) - first) % 2 == 0
    paired = np.flatnonzero(even[:-1] & (sorted_nodes[:-1] == sorted_nodes[1:]))
    partner = np.full(len(nodes), -1)
    partner[order[paired]], partner[order[paired + 1]] = order[paired + 1], order[paired]
    return partner


def _close_cracks(partner, points, gap):
    """The partners, with free ends joined that are each other's nearest and at most `gap` apart."""
    ends = np.flatnonzero(partner < 0)
    if len(ends) < 2:
        return partner
    indices = np.arange(len(ends))
    neighbours = np.asarray(KDTree(points[ends]).query(points[ends], k=2, distance_upper_bound=gap)[1])
    # At one position either of the two may come first.
    nearest = np.where(neighbours[:, 0] == indices, neighbours[:, 1], neighbours[:, 0])
    joined = np.append(nearest, -1)[nearest] == indices  # an end without a neighbour within the gap points to the -1
    partner[ends[joined]] = ends[nearest[joined]]
    return partner


def _trace_curves(partner):
    """[(ends (k,) in order, closed)]: for each curve the ends at which its segments are entered.

    The last end of an open curve is the one at which the curve ends.
    """
    partner = partner.tolist()
    visited, curves = bytearray(len(partner) // 2), []
    ends = [side for side, other in enumerate(partner) if other < 0]
    for start in [*ends, *range(0, len(partner), 2)]:
        side, trace = start, []
        while side >= 0 and not visited[side >> 1]:
            visited[side >> 1] = 1
            trace.append(side)
            side = partner[side ^ 1]
        if trace:
            closed = side >= 0
            curves.append((np.array(trace if closed else [*trace, trace[-1] ^ 1]), closed))
    return curves

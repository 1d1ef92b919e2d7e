"""Sections of a mesh by a plane, as ordered curves (T4.4.6), and positions on the surface that need not be vertices."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.nearest import closest

from .surface import CANCELLED, Surface, as_surface, mean_vertex_normals

IN_PLANE = 1e-9  # of the mesh's diagonal: an edge with both ends within this distance lies in the plane
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

        T4.4.6 calls a curve a contour. Raises ValueError for an invalid plane.

        Each vertex counts as on one side; a distance of exactly 0 as on that of the normal (Edelsbrunner and Muecke
        1990, simulation of simplicity). So a plane through vertices, along edges or in a face is treated as shifted by
        an infinitesimal amount: every face has no or two crossed edges. At an edge of more than two faces the curves
        continue between faces that follow each other in the mesh. Ends that are each other's nearest, across a gap of
        at most a thousandth of the diagonal, are joined.
        """
        heights = self._heights(point, normal)
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

    def _heights(self, point, normal):
        """(n,) of the positions above the plane, exactly 0 at both ends of an edge that lies in it but for rounding."""
        origin, direction = _plane(point, normal)
        heights = (self.positions - origin) @ direction
        near = (np.abs(heights) < IN_PLANE * self.mesh.diagonal)[self.corners]
        heights[self.corners[near & (near.sum(axis=1) >= 2)[:, None]]] = 0
        return heights

    def normals(self, curve: SectionCurve, point: ArrayLike, normal: ArrayLike) -> np.ndarray:
        """(k, 3) unit normals at the segments of a curve of the plane: of the segment's face.

        Where the curve runs along an edge, it is the mean of the normals of all faces at the edge: the curve could as
        well be in any of them.
        """
        normals, corners = self.mesh.face_normals[curve.faces], self.corners[curve.faces]
        level = self._heights(point, normal)[corners] == 0
        along = np.flatnonzero(level.sum(axis=1) == 2)
        if len(along) == 0:
            return normals
        own, back = np.unique(self._edges(corners[along][level[along]].reshape(-1, 2)), return_inverse=True)
        edges = self._edges(self.corners[:, [[0, 1], [1, 2], [2, 0]]])
        total = np.zeros((len(own), 3))
        for side in edges.T:
            slot = np.searchsorted(own, side).clip(max=len(own) - 1)
            at = np.flatnonzero(own[slot] == side)
            np.add.at(total, slot[at], self.mesh.face_normals[at])
        total = total[back.reshape(-1)]
        cancelled = np.linalg.norm(total, axis=1, keepdims=True) <= CANCELLED
        normals[along] = np.where(cancelled, normals[along], unit(total))
        return normals

    def _edges(self, ends):
        """(...) one number per edge of the positions (..., 2)."""
        return ends.min(axis=-1) * len(self.positions) + ends.max(axis=-1)


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
    is_mutual = np.append(nearest, -1)[nearest] == indices  # an end without a neighbour within the gap points to the -1
    partner[ends[is_mutual]] = ends[nearest[is_mutual]]
    return partner


def _trace_curves(partner):
    """[(ends (k,) in order, closed)]: for each curve the ends at which its segments are entered.

    The last end of an open curve is the one at which the curve ends.
    """
    partner = partner.tolist()
    visited, curves = bytearray(len(partner) // 2), []
    ends = [side for side, mate in enumerate(partner) if mate < 0]
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


MAX_OFFSET = 0.01  # of the mesh's diagonal: a point farther from the surface is an error
EDGE_WEIGHT = 1e-6  # weight of a corner, below which a position is on the opposite edge


def snap_to_surface(
    surface: Mesh | Surface, points: ArrayLike, tolerance: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """(positions (k, 3), normals (k, 3)): the positions on the surface nearest to points (k, 3), in units of the mesh.

    A normal is the unweighted average of the unit normals of the faces at the position (T4.3.1): inside a face its own,
    on an edge that of the faces along it, at a vertex that of `sensor_normals`.
    Raises ValueError that names the first point more than `tolerance` units off the surface (by default a hundredth of
    the mesh's diagonal), or the first position at which the faces cancel out.
    """
    mesh = as_surface(surface).mesh
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise ValueError(f"points must be finite and have shape (k, 3), got shape {points.shape}")
    if len(points) == 0:
        return points, points.copy()
    distances_off, face, weights = _closest(mesh, points)
    tolerance = MAX_OFFSET * mesh.diagonal if tolerance is None else tolerance
    if not tolerance >= 0:
        raise ValueError(f"tolerance must be 0 or more units, got {tolerance}")
    outside = np.flatnonzero(distances_off > tolerance)
    if len(outside):
        raise ValueError(
            f"point {points[outside[0]].tolist()} is off the mesh: its surface is {distances_off[outside[0]]:.4g} away "
            f"(the tolerance is {tolerance:.4g}); give a point on the surface, or a larger tolerance"
        )
    positions = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[face]])
    average = _mean_normals(mesh, face, weights > 0)
    bad = np.flatnonzero(np.linalg.norm(average, axis=1) <= CANCELLED)
    if len(bad):
        raise ValueError(f"the surface has no normal at {positions[bad[0]].tolist()}: its faces cancel out there")
    return positions, unit(average)


def _closest(mesh, points):
    """(distances (k,), faces (k,), corner weights (k, 3)) of the nearest positions."""
    distances_off, face, weights = closest(mesh, points)
    weights = np.where(weights > EDGE_WEIGHT, weights, 0.0)
    return distances_off, face, weights / weights.sum(axis=1, keepdims=True)


def _mean_normals(mesh, face, at_corner):
    """(k, 3) mean unit normals at positions on faces (k,); at_corner (k, 3): the corners that a position depends on."""
    average, count = mesh.face_normals[face], at_corner.sum(axis=1)
    at_vertex, on_edge = count == 1, np.flatnonzero(count == 2)
    average[at_vertex] = mean_vertex_normals(mesh)[mesh.faces[face[at_vertex]][at_corner[at_vertex]]]
    if len(on_edge):
        corners = np.sort(mesh.faces, axis=1)[:, [[0, 1], [0, 2], [1, 2]]]
        keys = (corners[..., 0] * len(mesh.vertices) + corners[..., 1]).ravel()
        ends = np.sort(mesh.faces[face[on_edge]][at_corner[on_edge]].reshape(-1, 2), axis=1)
        edges, back = np.unique(ends[:, 0] * len(mesh.vertices) + ends[:, 1], return_inverse=True)
        slot = np.searchsorted(edges, keys).clip(max=len(edges) - 1)
        along = np.flatnonzero(edges[slot] == keys)
        total = np.zeros((len(edges), 3))
        np.add.at(total, slot[along], mesh.face_normals[along // 3])
        average[on_edge] = total[back]
    return average

"""The cut of a mesh by a plane: its loops, in order (T4.4.6)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from stages.kit.mesh import unit

CRACK = 1e-3  # of the mesh's diagonal: a finger does not feel a gap of a tenth of a sensel


@dataclass(frozen=True)
class Loop:
    """One piece of a cut: a closed loop, or an open line from rim to rim.

    points (k, 3) in order, on the edges of the mesh; edges (k, 2) the vertex ids of each point's edge and weights (k,)
    how far it lies from the first to the second, 0..1; faces: the face below each segment, (k,) of a loop, whose last
    segment leads back to the first point, (k - 1,) of an open line.
    """

    points: np.ndarray
    edges: np.ndarray
    weights: np.ndarray
    faces: np.ndarray
    closed: bool

    @cached_property
    def steps(self):
        """(k,) or (k - 1,) lengths of the segments."""
        ahead = np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]
        return np.linalg.norm(ahead - self.points[: len(ahead)], axis=1)

    @property
    def length(self):
        """In units of the mesh."""
        return float(self.steps.sum())

    def backwards(self):
        """The same piece walked the other way, a loop from the same point."""
        faces = self.faces[::-1]
        if not self.closed:
            return Loop(self.points[::-1], self.edges[::-1], self.weights[::-1], faces, False)
        turned = (np.roll(part[::-1], 1, axis=0) for part in (self.points, self.edges, self.weights))
        return Loop(*turned, faces, True)


class Cutter:
    """A mesh made ready for many cuts: vertices at one place count as one, so that a seam does not end a loop."""

    def __init__(self, mesh):
        self.mesh = mesh
        self.places, place = np.unique(mesh.vertices, axis=0, return_inverse=True)
        self.corners = place.reshape(-1)[mesh.faces]

    def cut(self, point, normal):
        """The pieces of the plane through `point` (3,) with `normal` (3,), the longest first; [] where it misses.

        Each vertex counts as on one side: a distance of exactly 0 as on that of the normal (Edelsbrunner and Muecke
        1990, simulation of simplicity). So a plane through vertices, along edges or in a face is cut as one moved by
        less than any number: every face has no or two crossed edges, and the pieces are exact for those sides.
        At an edge of more than two faces the pieces go on between faces that follow each other in the mesh. Ends that
        are nearer to each other than to all others, across a crack of a thousandth of the diagonal or less, are joined.
        """
        point, normal = _plane(point, normal)
        heights = (self.places - point) @ normal
        above = (heights >= 0)[self.corners]
        crossed = np.flatnonzero((above != above[:, :1]).any(axis=1))
        above = above[crossed]
        # The corner that is alone on its side, then the two edges that leave it.
        alone = np.where(above[:, 1] == above[:, 2], 0, np.where(above[:, 0] == above[:, 2], 1, 2))
        ends = (alone[:, None] + [[1, 2]]) % 3
        pairs = np.stack([np.broadcast_to(alone[:, None], ends.shape), ends], axis=2).reshape(-1, 2)
        faces = np.repeat(crossed, 2)
        corners = self.corners[faces[:, None], pairs]
        nodes = corners.min(axis=1) * len(self.places) + corners.max(axis=1)
        both = np.repeat(nodes[::2] != nodes[1::2], 2)  # a face with two corners at one place has no inside to cross
        faces, pairs, corners, nodes = faces[both], pairs[both], corners[both], nodes[both]
        if len(nodes) == 0:
            return []
        flip = corners[:, 0] > corners[:, 1]  # both faces of an edge then give the same point, bit for bit
        pairs[flip], corners[flip] = pairs[flip, ::-1], corners[flip, ::-1]
        low, high = heights[corners[:, 0]], heights[corners[:, 1]]
        weights = low / (low - high)
        points = self.places[corners[:, 0]] * (1 - weights)[:, None] + self.places[corners[:, 1]] * weights[:, None]
        edges = self.mesh.faces[faces[:, None], pairs]
        pieces = [
            Loop(points[ids], edges[ids], weights[ids], faces[ids if closed else ids[:-1]], closed)
            for ids, closed in _walks(_bridge(_partners(nodes), points, CRACK * self.mesh.diagonal))
        ]
        return sorted(pieces, key=lambda piece: -piece.length)


def section(mesh, point, normal):
    """The pieces (Loop) of the cut of a mesh by a plane, the longest first; [] where the plane misses the mesh.

    point (3,) on the plane and its normal (3,), of any length, in units of the mesh. Ways of cutting as in
    `Cutter.cut`; T4.4.6 calls a piece a contour. Raises ValueError for a plane that is none.
    """
    return Cutter(mesh).cut(point, normal)


def _plane(point, normal):
    point, normal = np.asarray(point, dtype=np.float64), np.asarray(normal, dtype=np.float64)
    if point.shape != (3,) or normal.shape != (3,):
        raise ValueError(f"a plane is a point (3,) and a normal (3,), got shapes {point.shape} and {normal.shape}")
    if not (np.isfinite(point).all() and np.isfinite(normal).all() and np.linalg.norm(normal) > 0):
        raise ValueError(f"a plane needs finite numbers and a normal that is not 0, got {point} and {normal}")
    return point, unit(normal)


def _partners(nodes):
    """(k,) for each side of a segment the side of another at the same node, -1 at a rim; the sides of segment i are
    2 i and 2 i + 1."""
    order = np.argsort(nodes, kind="stable")
    sorted_nodes = nodes[order]
    first = np.searchsorted(sorted_nodes, sorted_nodes)
    even = (np.arange(len(nodes)) - first) % 2 == 0
    left = np.flatnonzero(even[:-1] & (sorted_nodes[:-1] == sorted_nodes[1:]))
    partner = np.full(len(nodes), -1)
    partner[order[left]], partner[order[left + 1]] = order[left + 1], order[left]
    return partner


def _bridge(partner, points, gap):
    """The partners, with sides at rims joined where they are each other's nearest, at most `gap` apart."""
    ends = np.flatnonzero(partner < 0)
    if len(ends) < 2:
        return partner
    own = np.arange(len(ends))
    _, near = cKDTree(points[ends]).query(points[ends], k=2, distance_upper_bound=gap)
    nearest = np.where(near[:, 0] == own, near[:, 1], near[:, 0])  # at one place either may come first
    found = np.append(nearest, -1)  # what has none within the gap points there
    joined = found[nearest] == own
    partner[ends[joined]] = ends[nearest[joined]]
    return partner


def _walks(partner):
    """[(sides (k,) in order, closed)]: each piece as the sides at which its segments are entered; the last side of an
    open piece is the one at which it ends."""
    partner = partner.tolist()
    seen, found = bytearray(len(partner) // 2), []
    ends = [side for side, other in enumerate(partner) if other < 0]
    for start in [*ends, *range(0, len(partner), 2)]:
        side, walk = start, []
        while side >= 0 and not seen[side >> 1]:
            seen[side >> 1] = 1
            walk.append(side)
            side = partner[side ^ 1]
        if walk:
            closed = side >= 0
            found.append((np.array(walk if closed else [*walk, walk[-1] ^ 1]), closed))
    return found

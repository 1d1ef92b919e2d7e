"""What a surface is made of: half-edges, pieces, loops, handles, and the faults that simplification must not add."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

FOLD = -0.99  # cosine between neighbouring normals: folded back within 8 degrees of flat
THIN = 1e-7  # height of a face over the bounding-box diagonal, below which it counts as degenerate


@dataclass(frozen=True)
class Topology:
    """Counts of a surface: rim edges, loops of them, pieces (joined by edges), closed pieces, handles."""

    rim: int
    loops: int
    pieces: int
    closed: int
    handles: int


@dataclass(frozen=True)
class Faults:
    """Counts of degenerate faces, of pairs of neighbours folded onto each other, of edges with three or more faces."""

    degenerate: int
    folded: int
    crowded: int

    def added(self, before):
        """The faults that `before` has not, in words; empty when there are none."""
        names = ("degenerate faces", "folded pairs of faces", "non-manifold edges")
        ours, theirs = (self.degenerate, self.folded, self.crowded), (before.degenerate, before.folded, before.crowded)
        return ", ".join(f"{a - b} new {name}" for name, a, b in zip(names, ours, theirs, strict=True) if a > b)


def faults(mesh):
    """The Faults of a mesh."""
    edge, partner = half_edges(mesh.faces)
    here = np.flatnonzero(partner > np.arange(len(partner)))
    facing = np.einsum("ij,ij->i", mesh.face_normals[here // 3], mesh.face_normals[partner[here] // 3])
    corners = mesh.vertices[mesh.faces]
    longest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    flat = 2 * mesh.face_areas <= THIN * mesh.diagonal * longest
    return Faults(int(flat.sum()), int((facing < FOLD).sum()), int((np.bincount(edge) > 2).sum()))


def topology(faces):
    """The Topology of the surface made of faces (m, 3).

    Pieces that touch in one vertex, or in an edge of three or more faces, count apart.
    """
    faces = split_pinches(faces)
    partner = half_edges(faces)[1]
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    n = int(faces.max()) + 1
    rim = partner < 0
    pieces, label = connected_components(_graph(tails, heads, n), directed=False)
    at_rim = np.zeros(n, dtype=bool)
    at_rim[tails[rim]] = at_rim[heads[rim]] = True
    loops = connected_components(_graph(tails[rim], heads[rim], n), directed=False)[0] - int((~at_rim).sum())
    euler = n - (len(tails) + int(rim.sum())) // 2 + len(faces)
    handles = max((2 * pieces - loops - euler) // 2, 0)
    return Topology(int(rim.sum()), loops, pieces, pieces - len(np.unique(label[at_rim])), handles)


def half_edges(faces):
    """Edge id of each half-edge (3 m,), and the half-edge on its other side (3 m,), -1 unless exactly two share it.

    Half-edge 3 f + k runs from corner k of face f to the next.
    """
    ends = np.sort(np.stack([faces.ravel(), np.roll(faces, -1, axis=1).ravel()], axis=1), axis=1)
    key = ends[:, 0] * (int(faces.max()) + 1) + ends[:, 1]
    _, edge, count = np.unique(key, return_inverse=True, return_counts=True)
    order = np.argsort(edge, kind="stable")
    first = (np.cumsum(count) - count)[count == 2]
    partner = np.full(len(edge), -1)
    partner[order[first]], partner[order[first + 1]] = order[first + 1], order[first]
    return edge, partner


def split_pinches(faces):
    """Faces (m, 3) with new vertex ids: a vertex is doubled where fans of faces touch in it alone.

    After it each vertex has one fan, and edges with three or more faces have become rims.
    """
    partner = half_edges(faces)[1]
    corner = np.arange(faces.size)
    after = corner - corner % 3 + (corner + 1) % 3
    here = np.flatnonzero(partner >= 0)
    there = partner[here]
    same = faces.ravel()[here] == faces.ravel()[there]  # neighbours that disagree on which side is out
    start, end = np.where(same, there, after[there]), np.where(same, after[there], there)
    joined = _graph(np.r_[here, after[here]], np.r_[start, end], faces.size)
    return connected_components(joined, directed=False)[1].reshape(-1, 3).astype(np.int64)


def _graph(tails, heads, n):
    return sparse.csr_matrix((np.ones(len(tails), dtype=bool), (tails, heads)), shape=(n, n))

"""What a surface is made of: half-edges, pieces, loops, handles, and the faults that simplification must not add."""

from dataclasses import astuple, dataclass

import numpy as np

from .kernels import components, count_faults, partners

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
    """Counts of degenerate faces, pairs of neighbours folded onto each other, edges of three or more faces, and
    closed pieces whose inside is out."""

    degenerate: int
    folded: int
    crowded: int
    inverted: int

    def added(self, before):
        """The faults that `before` has not, in words; empty when there are none."""
        names = ("degenerate faces", "folded pairs of faces", "non-manifold edges", "pieces inside out")
        ours, theirs = astuple(self), astuple(before)
        return ", ".join(f"{a - b} new {name}" for name, a, b in zip(names, ours, theirs, strict=True) if a > b)


NONE = Faults(degenerate=0, folded=0, crowded=0, inverted=0)


def faults(mesh):
    """The Faults of a mesh."""
    if len(mesh.faces) == 0:
        return NONE
    other, shared = half_edges(mesh.faces)
    counts = count_faults(mesh.vertices, mesh.faces.ravel(), other, shared, THIN * mesh.diagonal, FOLD)
    return Faults(*counts, _inverted(mesh, other))


def _inverted(mesh, other):
    """How many closed pieces have a negative volume: cavities, and what was turned inside out."""
    faces, n = mesh.faces, int(mesh.faces.max()) + 1
    label, pieces = components(faces.ravel(), np.roll(faces, -1, axis=1).ravel(), n)
    piece = label[faces[:, 0]]
    a, b, c = (mesh.vertices[faces] - mesh.vertices[faces[0, 0]]).transpose(1, 0, 2)
    volume = np.bincount(piece, weights=np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=pieces)
    closed = np.ones(pieces, dtype=bool)
    closed[piece[np.flatnonzero(other < 0) // 3]] = False
    return int((closed & (volume < -THIN * mesh.diagonal**3)).sum())


def topology(faces):
    """The Topology of the surface made of faces (m, 3).

    Pieces that touch in one vertex, or in an edge of three or more faces, count apart.
    """
    faces = split_pinches(faces)
    partner = half_edges(faces)[0]
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    n = int(faces.max()) + 1
    rim = partner < 0
    label, pieces = components(tails, heads, n)
    at_rim = np.zeros(n, dtype=bool)
    at_rim[tails[rim]] = at_rim[heads[rim]] = True
    loops = components(tails[rim], heads[rim], n)[1] - int((~at_rim).sum())
    euler = n - (len(tails) + int(rim.sum())) // 2 + len(faces)
    handles = max((2 * pieces - loops - euler) // 2, 0)
    return Topology(int(rim.sum()), loops, pieces, pieces - len(np.unique(label[at_rim])), handles)


def half_edges(faces):
    """The half-edge on the other side of each (3 m,), -1 unless exactly two share it, and how many do share it (3 m,).

    Half-edge 3 f + k runs from corner k of face f to the next.
    """
    return partners(faces.astype(np.int32).ravel(), int(faces.max()) + 1, False)


def split_pinches(faces):
    """Faces (m, 3) with new vertex ids: a vertex is doubled where fans of faces touch in it alone.

    After it each vertex has one fan, and edges with three or more faces have become rims.
    """
    partner = half_edges(faces)[0]
    corner = np.arange(faces.size)
    after = corner - corner % 3 + (corner + 1) % 3
    here = np.flatnonzero(partner >= 0)
    there = partner[here]
    same = faces.ravel()[here] == faces.ravel()[there]  # neighbours that disagree on which side is out
    start, end = np.where(same, there, after[there]), np.where(same, after[there], there)
    return components(np.r_[here, after[here]], np.r_[start, end], faces.size)[0].reshape(-1, 3).astype(np.int64)

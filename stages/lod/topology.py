"""What a surface is made of: half-edges, pieces, loops, handles, and the faults that simplification must not add."""

from dataclasses import astuple, dataclass

import numpy as np

from .kernels import components, count_faults, partners, pieces, signed_volumes, split_fans

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
    """Counts of degenerate faces, pairs of neighbours folded onto each other, half-edges on edges of three or more
    faces, and closed pieces whose inside is out."""

    degenerate: int
    folded: int
    crowded: int
    inverted: int

    def added(self, before):
        """The faults that `before` has not, in words; empty when there are none."""
        names = ("degenerate faces", "folded pairs of faces", "half-edges on non-manifold edges", "pieces inside out")
        ours, theirs = astuple(self), astuple(before)
        return ", ".join(f"{a - b} new {name}" for name, a, b in zip(names, ours, theirs, strict=True) if a > b)


NONE = Faults(degenerate=0, folded=0, crowded=0, inverted=0)


def faults(mesh):
    """The Faults of a mesh."""
    if len(mesh.faces) == 0:
        return NONE
    ids, other, crowded = half_edges(mesh.faces)
    degenerate, folded = count_faults(mesh.vertices, ids, other, THIN * mesh.diagonal, FOLD)
    inverted = int((signed_volumes(mesh.vertices, ids, other) < -THIN * mesh.diagonal**3).sum())
    return Faults(degenerate, folded, crowded, inverted)


def topology(faces):
    """The Topology of the surface made of faces (m, 3).

    Pieces that touch in one vertex, or in an edge of three or more faces, count apart.
    """
    ids, other, _ = half_edges(faces)
    fan, n = split_fans(ids, other)
    piece, count = pieces(other)
    rim = np.flatnonzero(other < 0)
    open_pieces = len(np.unique(piece[rim // 3]))
    tails, heads = fan[rim], fan[np.where(rim % 3 == 2, rim - 2, rim + 1)]
    at_rim = len(np.unique(np.r_[tails, heads]))
    loops = components(tails, heads, n)[1] - (n - at_rim)
    euler = n - (len(ids) + len(rim)) // 2 + len(faces)
    handles = max((2 * count - loops - euler) // 2, 0)
    return Topology(len(rim), loops, count, count - open_pieces, handles)


def half_edges(faces):
    """Faces (3 m,) i4, the half-edge on the other side of each, and how many lie on edges of three or more faces.

    Half-edge 3 f + k runs from corner k of face f to the next. Its other side is -1 unless exactly two share the edge.
    """
    ids = faces.astype(np.int32).ravel()
    return ids, *partners(ids, int(faces.max()) + 1, False)


def split_pinches(faces):
    """Faces (m, 3) with new vertex ids: a vertex is doubled where fans of faces touch in it alone.

    After it each vertex has one fan, and edges with three or more faces have become rims.
    """
    ids, other, _ = half_edges(faces)
    return split_fans(ids, other)[0].reshape(-1, 3).astype(np.int64)

"""How few faces a mesh can have when some of them are frozen, known before anything is collapsed.

A collapse takes one vertex and two faces away and leaves frozen faces, the open boundary and the topology as they are.
By Euler's formula the free part of the surface (R rim edges in L loops, C pieces, genus G) then cannot have fewer than
R + 2 L - 4 C + 4 G faces: the gaps tiled with no free vertex left. Near that number the islands are joined straight to
each other and the surface between them collapses. Measured on twelve household objects with 3, 8 and 20 points kept at
one and three rings (72 cells), the mean error against plain QEM with as many faces as are free here:

    free faces / least number    1.1    1.25   1.5    2      2.5    3      4
    error ratio, median          7.9    4.7    2.6    1.7    1.4    1.3    1.1
    error ratio, 90 % below      19     10     4.6    2.4    1.8    1.6    1.4

At twice the number a hand still lost its thumb; from two and a half times on the islands cost no more than the free
faces that they take (measured with pymeshlab). Handles (often scanning noise) want about 20 faces each, or the surface
between them goes the same way. It is a floor, no promise: close to it a mesh is as coarse as plain QEM with that few
free faces. Asked for exactly the floor, the fast backend gave it on 39 of 39 meshes (household and Princeton) with
eight points kept at one ring. With nothing kept it did on 116 of 164: thin and folded ones, where nothing more may be
collapsed without a fault, end at 6 to 118 faces instead of 4, or at 24 to 70 a handle. That is not known before it is
tried; then the error's `smallest` is the count that was reached, and all 48 could be simplified to it.
"""

import numpy as np

from .topology import topology

RIM_FACTOR = 2.5  # the table above
# Of 33 closed objects with handles, 25 can be collapsed further with the fast backend, to 10 to 16 a handle: at 20 the
# median error is 1.6 times smaller. Seven end above it, at 24 to 70.
FACES_PER_HANDLE = 20
CLOSED_FLOOR = 4  # a tetrahedron: the smallest closed surface, reached by 85 of 126 closed meshes without handles


class InfeasibleTarget(ValueError):
    """The target leaves too few free faces; `smallest` is the least face count that can be had, `faces` the target."""

    def __init__(self, faces, smallest, frozen=0):
        self.faces, self.smallest, self.frozen = int(faces), int(smallest), int(frozen)
        super().__init__(f"{faces} faces cannot be had with {frozen} frozen: the smallest feasible count is {smallest}")

    def __reduce__(self):
        return type(self), (self.faces, self.smallest, self.frozen)


class SimplifyError(ValueError):
    """Every attempt left faces folded, degenerate or non-manifold that were not so before."""


def frozen_faces(mesh, keep=None, rings=3):
    """(m,) boolean: the faces whose corners all lie within `rings` edges of a kept vertex (T3.2.8).

    rings: one number for all or (k,), one a kept vertex. With 0 rings the faces that touch the vertex, which could not
    stay without them; with -1, in an array, the vertex is not kept.
    Raises ValueError for ids outside the mesh, or rings that are no whole numbers, too few or too many.
    """
    keep = check_keep(mesh, keep)
    rings = check_rings(keep, rings)
    keep, rings = keep[rings >= 0], rings[rings >= 0]
    if len(keep) == 0:
        return np.zeros(len(mesh.faces), dtype=bool)
    near = np.zeros(len(mesh.vertices), dtype=bool)
    for left in range(rings.max(), 0, -1):  # the widest neighbourhoods set out first, so that all end together
        near[keep[rings == left]] = True
        near |= mesh.adjacency @ near
    touched = mesh.rings(keep, 0)
    return near[mesh.faces].all(axis=1) | touched[mesh.faces].any(axis=1)


def check_keep(mesh, keep):
    """(k,) i8 vertex ids; raises ValueError for what is none."""
    keep = np.zeros(0, dtype=np.int64) if keep is None or len(keep) == 0 else np.asarray(keep)
    if keep.ndim != 1 or not np.issubdtype(keep.dtype, np.integer):
        raise ValueError(f"keep must be a list of vertex ids, got shape {keep.shape} of {keep.dtype}")
    if len(keep) and (keep.min() < 0 or keep.max() >= len(mesh.vertices)):
        raise ValueError(f"keep names vertices outside 0..{len(mesh.vertices) - 1}")
    return keep.astype(np.int64)


def check_rings(keep, rings):
    """(k,) i8 rings, one a kept vertex; raises ValueError for what is none."""
    found = np.asarray(rings)
    if not np.issubdtype(found.dtype, np.integer) and found.size:
        raise ValueError(f"rings must be whole numbers, got {found.dtype}")
    if found.ndim == 0 and found < 0:
        raise ValueError(f"rings must be 0 or more, got {rings}")
    if found.ndim and found.shape != keep.shape:
        raise ValueError(f"rings must be one number or one a kept vertex, {keep.shape}, got {found.shape}")
    if found.size and found.min() < -1:
        raise ValueError(f"rings must be -1 (not kept), 0 or more, got {found.min()}")
    return np.broadcast_to(found, keep.shape).astype(np.int64)


def smallest_feasible(mesh, keep=None, rings=3):
    """The least number of faces that keeps the frozen faces, the boundary, the topology and a sound surface between.

    keep and rings as in `frozen_faces`. The count of the mesh itself where it has nothing to spare.
    """
    return smallest_with(mesh, frozen_faces(mesh, keep, rings))


def smallest_with(mesh, frozen):
    """As `smallest_feasible`, for frozen faces given as (m,) boolean."""
    free = mesh.faces[~frozen]
    if len(free) == 0:
        return len(mesh.faces)
    found = topology(free)
    tiles = max(found.rim + 2 * found.loops - 4 * (found.pieces - found.closed), 0)
    needed = RIM_FACTOR * tiles + CLOSED_FLOOR * found.closed + FACES_PER_HANDLE * found.handles
    least = int(frozen.sum() + np.ceil(needed))
    return min(least + (len(mesh.faces) - least) % 2, len(mesh.faces))  # each collapse takes two faces

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
faces that they take. Handles (often scanning noise) want about 20 faces each, or the surface between them goes the same
way. It is a floor, no promise: close to it a mesh is as coarse as plain QEM with that few free faces.
"""

import numpy as np

from .topology import topology

RIM_FACTOR = 2.5  # the table above
FACES_PER_HANDLE = 20  # six objects get stuck, ruined, at 10 to 14 a handle; at 20 the error is 2 to 13 times smaller
CLOSED_FLOOR = 4  # a tetrahedron: the smallest closed surface


class InfeasibleTarget(ValueError):
    """The target leaves too few free faces; `smallest` is the least face count that can be had, `faces` the target."""

    def __init__(self, faces, smallest, frozen=0):
        self.faces, self.smallest, self.frozen = int(faces), int(smallest), int(frozen)
        super().__init__(f"{faces} faces cannot be had with {frozen} frozen: the smallest feasible count is {smallest}")

    def __reduce__(self):
        return type(self), (self.faces, self.smallest, self.frozen)


def frozen_faces(mesh, keep=None, rings=3):
    """(m,) boolean: the faces whose corners all lie within `rings` edges of a kept vertex (T3.2.8).

    With 0 rings the faces that touch a kept vertex, which could not stay without them.
    Raises ValueError for ids outside the mesh or a negative number of rings.
    """
    if keep is None or len(keep) == 0:
        return np.zeros(len(mesh.faces), dtype=bool)
    keep = np.asarray(keep)
    if keep.ndim != 1 or not np.issubdtype(keep.dtype, np.integer):
        raise ValueError(f"keep must be a list of vertex ids, got shape {keep.shape} of {keep.dtype}")
    if keep.min() < 0 or keep.max() >= len(mesh.vertices):
        raise ValueError(f"keep names vertices outside 0..{len(mesh.vertices) - 1}")
    if rings < 0:
        raise ValueError(f"rings must be 0 or more, got {rings}")
    return mesh.rings(keep, rings)[mesh.faces].all(axis=1) | mesh.rings(keep, 0)[mesh.faces].any(axis=1)


def smallest_feasible(mesh, keep=None, rings=3):
    """The least number of faces that keeps the frozen faces, the boundary, the topology and a sound surface between.

    keep: vertex ids or None. The count of the mesh itself where it has nothing to spare.
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
    return int(min(frozen.sum() + np.ceil(needed), len(mesh.faces)))

"""The smallest feasible face count of a mesh with frozen faces, before anything is collapsed.

A collapse removes one vertex and two faces, and preserves frozen faces, the boundary and the topology. By Euler's
formula the free part of the surface (B boundary edges in L loops, C components, genus G) then cannot have fewer than
B + 2 L - 4 C + 4 G faces: the gaps tiled with no free vertex left. Near that number the frozen regions are joined
directly to each other and the surface between them collapses. Measured on twelve household objects with 3, 8 and 20
points kept at one and three rings (72 cells), the mean error relative to plain QEM with as many faces as are free here:

    free faces / least number    1.1    1.25   1.5    2      2.5    3      4
    error ratio, median          7.9    4.7    2.6    1.7    1.4    1.3    1.1
    error ratio, 90 % below      19     10     4.6    2.4    1.8    1.6    1.4

At twice the number a hand still lost its thumb; from two and a half times on, the frozen regions cost no more than the
free faces that they replace (measured with pymeshlab). Each unit of genus (often scanning noise) needs about 20 faces,
or the surface around it collapses too. The count is a lower bound, not a guarantee: close to it a mesh is as coarse as
plain QEM with that few free faces. Asked for exactly this bound, the fast backend reached it on 39 of 39 meshes
(household and Princeton) with eight points kept at one ring. With nothing kept it did on 116 of 164: thin and folded
meshes, where no further collapse is sound, end at 6 to 118 faces instead of 4, or at 24 to 70 per unit of genus. That
shows only in the attempt; then the error's `smallest` is the count reached, and all 48 could be simplified to it.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .topology import half_edges, topology

BOUNDARY_FACTOR = 2.5  # the table above
# Of 33 closed objects with genus above 0, 25 can be collapsed further with the fast backend, to 10 to 16 faces per
# unit: at 20 the median error is 1.6 times smaller. Seven end above it, at 24 to 70.
FACES_PER_GENUS = 20
LEAST_LOOP = 3  # edges
CLOSED_FLOOR = 4  # a tetrahedron: the smallest closed surface, reached by 85 of 126 closed meshes of genus 0

Keep = Sequence[int] | np.ndarray | None  # vertex ids
Rings = int | np.ndarray  # one number, or one per vertex


class InfeasibleTarget(ValueError):
    """The target leaves too few free faces.

    Attributes
    ----------
    faces : int
        The target.
    smallest : int
        The smallest feasible face count.
    frozen : int
        Number of frozen faces.
    """

    def __init__(self, faces: int, smallest: int, frozen: int = 0) -> None:
        self.faces, self.smallest, self.frozen = int(faces), int(smallest), int(frozen)
        super().__init__(
            f"a count of {faces} faces is infeasible with {frozen} frozen: the smallest feasible count is {smallest}"
        )

    def __reduce__(self) -> tuple:
        return type(self), (self.faces, self.smallest, self.frozen)


class SimplifyError(ValueError):
    """Every attempt left new folded, degenerate or non-manifold faces."""


def frozen_faces(mesh: Mesh, keep: Keep = None, rings: Rings = 3) -> np.ndarray:
    """(m,) boolean: the faces whose corners all lie within `rings` edges of a kept vertex (T3.2.8).

    rings: one number for all, or (k,) per kept vertex. With 0 rings the faces that touch the vertex, which it needs;
    with -1, in an array, the vertex is not kept.
    Raises ValueError for ids outside the mesh, or rings that are not whole numbers or not as many as the vertices.
    """
    keep = check_keep(mesh, keep)
    rings = check_rings(keep, rings)
    keep, rings = keep[rings >= 0], rings[rings >= 0]
    if len(keep) == 0:
        return np.zeros(len(mesh.faces), dtype=bool)
    near = np.zeros(len(mesh.vertices), dtype=bool)
    for width in range(rings.max(), 0, -1):  # the widest neighbourhoods start first, so that all end together
        near[keep[rings == width]] = True
        near |= mesh.adjacency @ near
    touched = mesh.rings(keep, 0)
    a, b, c = mesh.faces.T
    return (near[a] & near[b] & near[c]) | touched[a] | touched[b] | touched[c]


def check_keep(mesh: Mesh, keep: Keep) -> np.ndarray:
    """(k,) i8 vertex ids; raises ValueError for anything else."""
    keep = np.zeros(0, dtype=np.int64) if keep is None or len(keep) == 0 else np.asarray(keep)
    if keep.ndim != 1 or not np.issubdtype(keep.dtype, np.integer):
        raise ValueError(f"keep must be a list of vertex ids, got shape {keep.shape} of {keep.dtype}")
    if len(keep) and (keep.min() < 0 or keep.max() >= len(mesh.vertices)):
        raise ValueError(f"keep has vertex ids outside 0..{len(mesh.vertices) - 1}")
    return keep.astype(np.int64)


def check_rings(keep: np.ndarray, rings: Rings) -> np.ndarray:
    """(k,) i8 rings per kept vertex; raises ValueError for anything else."""
    counts = np.asarray(rings)
    if not np.issubdtype(counts.dtype, np.integer) and counts.size:
        raise ValueError(f"rings must be whole numbers, got {counts.dtype}")
    if counts.ndim == 0 and counts < 0:
        raise ValueError(f"rings must be 0 or more, got {rings}")
    if counts.ndim and counts.shape != keep.shape:
        raise ValueError(f"rings must be one number or one per kept vertex, {keep.shape}, got {counts.shape}")
    if counts.size and counts.min() < -1:
        raise ValueError(f"rings must be -1 (not kept), 0 or more, got {counts.min()}")
    return np.broadcast_to(counts, keep.shape).astype(np.int64)


def smallest_feasible(mesh: Mesh, keep: Keep = None, rings: Rings = 3, free_borders: bool = False) -> int:
    """The smallest face count that preserves frozen faces, boundary and topology, with a sound surface between.

    keep and rings as in `frozen_faces`. free_borders: the boundary keeps its loops, but not its edges. The mesh's own
    count where no face can be removed.
    """
    keep = check_keep(mesh, keep)
    rings = check_rings(keep, rings)
    return _smallest(mesh, keep[rings >= 0].tobytes(), rings[rings >= 0].tobytes(), free_borders)


@lru_cache(maxsize=64)  # shrinking to several targets asks for the same neighbourhoods
def _smallest(mesh, keep, rings, free_borders):
    frozen = frozen_faces(mesh, *(np.frombuffer(buffer, dtype=np.int64) for buffer in (keep, rings)))
    return smallest_with(mesh, frozen, free_borders)


def smallest_with(mesh: Mesh, frozen: np.ndarray, free_borders: bool = False) -> int:
    """As `smallest_feasible`, for frozen faces given as (m,) boolean."""
    free = mesh.faces[~frozen]
    if len(free) == 0:
        return len(mesh.faces)
    shape = topology(free)
    open_components = shape.components - shape.closed_components
    edges = shape.boundary_edges
    if free_borders:  # each of their loops may shrink to a triangle
        open_edges = int((half_edges(mesh.faces)[1].reshape(-1, 3)[~frozen] < 0).sum())
        edges -= max(open_edges - LEAST_LOOP * shape.boundary_loops, 0)
    # Triangles that share no vertex: one tile each, and just this one face.
    loose = int((np.bincount(mesh.faces.ravel())[free] == 1).all(axis=1).sum())
    tiles = max(edges + 2 * shape.boundary_loops - 4 * open_components - loose, 0)
    free_count = BOUNDARY_FACTOR * tiles + CLOSED_FLOOR * shape.closed_components + FACES_PER_GENUS * shape.genus
    free_count += loose
    smallest = int(frozen.sum() + np.ceil(free_count))
    return min(smallest + (len(mesh.faces) - smallest) % 2, len(mesh.faces))  # each collapse removes two faces

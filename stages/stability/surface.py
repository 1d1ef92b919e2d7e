"""Counts on a surface: boundary edges, connected components, degenerate and duplicate faces, folds, non-manifold parts.

Computed by trimesh and numpy and not by stages.lod, so that an error in its own functions shows here.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from haptic_glance.mesh.mesh import Mesh

FOLDED = 0.99  # cosine between two neighbours seen along their edge: at most 8 degrees apart
FLAT = 1e-8  # height of a face over the diagonal, below which it counts as without area


@dataclass(frozen=True, eq=False)
class Surface:
    """The counts of a mesh, which must have a face."""

    mesh: Mesh

    @cached_property
    def as_trimesh(self) -> trimesh.Trimesh:
        """The mesh in trimesh, with nothing merged, at unit size since trimesh's tolerances are absolute."""
        vertices, size = self.mesh.vertices, self.mesh.diagonal or 1.0
        centre = vertices[self.mesh.faces[0, 0]]
        return trimesh.Trimesh((vertices - centre) / size, self.mesh.faces, process=False, validate=False)

    @cached_property
    def edge_counts(self) -> tuple[np.ndarray, np.ndarray]:
        """((e, 2) edges, (e,) how many faces each has)."""
        edges, count = np.unique(self.as_trimesh.edges_sorted, axis=0, return_counts=True)
        return edges, count

    @cached_property
    def welded(self) -> trimesh.Trimesh:
        """The mesh in trimesh with vertices at equal positions merged, without faces that then name a vertex twice."""
        places, at = np.unique(self.as_trimesh.vertices, axis=0, return_inverse=True)
        faces = at.ravel()[self.mesh.faces]
        whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        return trimesh.Trimesh(places, faces[whole], process=False, validate=False)

    @cached_property
    def boundary_edges(self) -> set[bytes]:
        """The edges that an odd number of faces share once equal positions are merged, as bytes of both ends.

        This is the boundary in the sense of homology. A collapse inside the surface leaves it unchanged, whatever it
        does to non-manifold edges; a hole that opens, closes or moves changes it.
        """
        places, at = np.unique(self.mesh.vertices, axis=0, return_inverse=True)
        ends = np.sort(at.ravel()[self.mesh.faces][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, count = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0, return_counts=True)
        return {pair.tobytes() for pair in places[edges[count % 2 == 1]] + 0.0}  # + 0.0: minus zero is zero

    @cached_property
    def components(self) -> int:
        """The number of connected components: faces are connected by edges that exactly two of them share."""
        return len(
            trimesh.graph.connected_components(self.as_trimesh.face_adjacency, nodes=np.arange(len(self.mesh.faces)))
        )

    @cached_property
    def degenerate_faces(self) -> int:
        """The number of faces without area or with a repeated vertex."""
        return int((~trimesh.triangles.nondegenerate(self.as_trimesh.triangles, height=FLAT)).sum())

    @cached_property
    def folds(self) -> np.ndarray:
        """(2,) numbers of pairs of neighbouring faces that are folded onto each other, of the mesh as it is and welded.

        The first misses a fold at an edge without length, the second one at an edge with a third face.
        """
        return np.array([_folds(self.as_trimesh), _folds(self.welded)])

    @cached_property
    def duplicate_faces(self) -> int:
        """The number of faces with the same corner positions as another one."""
        corners = np.sort(self.welded.faces, axis=1)
        return len(corners) - len(np.unique(corners, axis=0))

    @cached_property
    def non_manifold_edges(self) -> int:
        """The number of edges with three faces or more."""
        return int((self.edge_counts[1] > 2).sum())

    @cached_property
    def non_manifold_vertices(self) -> int:
        """The number of fans of faces that share nothing but a vertex with the others around it."""
        pairs, edges = self.as_trimesh.face_adjacency, self.as_trimesh.face_adjacency_edges
        faces, n = self.mesh.faces, len(self.mesh.faces)
        tails, heads = [], []
        for end in edges.T:
            corner = [3 * face + (faces[face] == end[:, None]).argmax(axis=1) for face in pairs.T]
            tails, heads = [*tails, corner[0]], [*heads, corner[1]]
        ones = np.ones(2 * len(pairs), dtype=bool)
        joined = sparse.csr_matrix((ones, (np.concatenate(tails), np.concatenate(heads))), shape=(3 * n, 3 * n))
        return connected_components(joined, directed=False)[0] - len(np.unique(faces))

    @cached_property
    def volume(self) -> float:
        """The signed volume of a closed surface, in cubed diagonals."""
        return float(np.einsum("ij,ij->", self.as_trimesh.triangles[:, 0], self.as_trimesh.triangles_cross) / 6)

    @cached_property
    def deduplicated(self) -> "Surface":
        """The Surface without duplicate faces and without faces that name a vertex twice."""
        corners = np.sort(self.mesh.faces, axis=1)
        whole = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])
        first = np.zeros(len(corners), dtype=bool)
        first[np.unique(corners, axis=0, return_index=True)[1]] = True
        return Surface(Mesh(self.mesh.vertices, self.mesh.faces[whole & first]))

    @cached_property
    def closed(self) -> bool:
        """True when every edge has two faces with consistent winding."""
        return bool(self.as_trimesh.is_watertight and self.as_trimesh.is_winding_consistent)


def _folds(scene):
    """The number of folds; measured along the edge, so that the winding does not matter."""
    ends = scene.vertices[scene.face_adjacency_edges]
    along = trimesh.util.unitize(ends[:, 1] - ends[:, 0])
    sides = []
    for tip in scene.face_adjacency_unshared.T:
        to = scene.vertices[tip] - ends[:, 0]
        sides.append(trimesh.util.unitize(to - np.einsum("ij,ij->i", to, along)[:, None] * along))
    return int((np.einsum("ij,ij->i", *sides) > FOLDED).sum())

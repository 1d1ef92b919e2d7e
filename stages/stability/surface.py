"""What can be counted on a surface: border, pieces, faces without area, folds, copies, crowded edges, pinches.

By trimesh and plain numpy: an error in stages.lod's own idea of a boundary, a piece or a fold shows here, and is not
shared.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import trimesh
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from stages.kit import Mesh

FOLDED = 0.99  # cosine between two neighbours seen along their edge: folded together within 8 degrees
FLAT = 1e-8  # height of a face over the diagonal, below which it has no area


@dataclass(frozen=True, eq=False)
class Surface:
    """What is counted on a mesh. The mesh must have a face."""

    mesh: Mesh

    @cached_property
    def scene(self):
        """The same as a trimesh, nothing merged, at unit size: trimesh's tolerances are absolute."""
        vertices, size = self.mesh.vertices, self.mesh.diagonal or 1.0
        centre = vertices[self.mesh.faces[0, 0]]
        return trimesh.Trimesh((vertices - centre) / size, self.mesh.faces, process=False, validate=False)

    @cached_property
    def sides(self):
        """((e, 2) edges, (e,) how many faces each has)."""
        edges, count = np.unique(self.scene.edges_sorted, axis=0, return_counts=True)
        return edges, count

    @cached_property
    def welded(self):
        """The same, equal places made one vertex, without the faces that then name a vertex twice."""
        places, at = np.unique(self.scene.vertices, axis=0, return_inverse=True)
        faces = at.ravel()[self.mesh.faces]
        whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        return trimesh.Trimesh(places, faces[whole], process=False, validate=False)

    @cached_property
    def border(self):
        """Set of edges, as bytes of both ends' places, that an odd number of faces share once equal places are one.

        The boundary in the sense of homology: no collapse that leaves the rims alone changes it, whatever it does to
        crowded edges; a hole torn, closed or moved does.
        """
        places, at = np.unique(self.mesh.vertices, axis=0, return_inverse=True)
        ends = np.sort(at.ravel()[self.mesh.faces][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, count = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0, return_counts=True)
        return {pair.tobytes() for pair in places[edges[count % 2 == 1]] + 0.0}  # + 0.0: minus zero is zero

    @cached_property
    def pieces(self):
        """How many pieces: faces joined by edges that two of them share."""
        return len(trimesh.graph.connected_components(self.scene.face_adjacency, nodes=np.arange(len(self.mesh.faces))))

    @cached_property
    def flat_faces(self):
        """How many faces have no area, or a vertex twice."""
        return int((~trimesh.triangles.nondegenerate(self.scene.triangles, height=FLAT)).sum())

    @cached_property
    def folds(self):
        """(2,) pairs of neighbours that lie upon each other, as the mesh is and with equal places made one vertex.

        An edge without length hides a fold from the first, a third face at the edge from the second.
        """
        return np.array([_folds(self.scene), _folds(self.welded)])

    @cached_property
    def copies(self):
        """How many faces have the places of another one."""
        corners = np.sort(self.welded.faces, axis=1)
        return len(corners) - len(np.unique(corners, axis=0))

    @cached_property
    def crowded(self):
        """How many edges have three faces or more."""
        return int((self.sides[1] > 2).sum())

    @cached_property
    def pinches(self):
        """How many fans of faces meet others in a vertex alone."""
        pairs, edges = self.scene.face_adjacency, self.scene.face_adjacency_edges
        faces, n = self.mesh.faces, len(self.mesh.faces)
        tails, heads = [], []
        for end in edges.T:
            corner = [3 * face + (faces[face] == end[:, None]).argmax(axis=1) for face in pairs.T]
            tails, heads = [*tails, corner[0]], [*heads, corner[1]]
        ones = np.ones(2 * len(pairs), dtype=bool)
        joined = sparse.csr_matrix((ones, (np.concatenate(tails), np.concatenate(heads))), shape=(3 * n, 3 * n))
        return connected_components(joined, directed=False)[0] - len(np.unique(faces))

    @cached_property
    def volume(self):
        """Signed volume in diagonals cubed, of a closed surface."""
        return float(np.einsum("ij,ij->", self.scene.triangles[:, 0], self.scene.triangles_cross) / 6)

    @cached_property
    def tidy(self):
        """The Surface without faces that name a vertex twice and without a face's second copy."""
        corners = np.sort(self.mesh.faces, axis=1)
        whole = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])
        first = np.zeros(len(corners), dtype=bool)
        first[np.unique(corners, axis=0, return_index=True)[1]] = True
        return Surface(Mesh(self.mesh.vertices, self.mesh.faces[whole & first]))

    @cached_property
    def closed(self):
        """True when every edge has two faces that agree on which side is out."""
        return bool(self.scene.is_watertight and self.scene.is_winding_consistent)


def _folds(scene):
    """Seen along the edge, so that winding has no say."""
    ends = scene.vertices[scene.face_adjacency_edges]
    along = trimesh.util.unitize(ends[:, 1] - ends[:, 0])
    sides = []
    for tip in scene.face_adjacency_unshared.T:
        to = scene.vertices[tip] - ends[:, 0]
        sides.append(trimesh.util.unitize(to - np.einsum("ij,ij->i", to, along)[:, None] * along))
    return int((np.einsum("ij,ij->i", *sides) > FOLDED).sum())

"""A mesh in a frame of its own, and a few of its vertices that stand for the rest: for detectors of quadratic cost."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from stages.conspicuity.surface_values import smoother
from stages.kit import Mesh
from stages.weights.svm_pixels import select_far_points

DIGITS = 9  # decimals of positions, in sizes: closer vertices are one


@dataclass(frozen=True)
class UnitMesh:
    """The faces with area of a mesh of n vertices, centred on the surface's centroid.

    mesh: its size, twice the distance of the farthest vertex from the centroid, is one; vertices in one place are one,
    and sorted, so that the order of the given ones does not matter. place (n,): the vertex there, -1 in no such face.
    """

    mesh: Mesh
    place: np.ndarray

    def to_vertices(self, values: np.ndarray) -> np.ndarray:
        """(n,) values (k,) of the unit mesh at the given vertices; zero in no face with area."""
        return np.where(self.place >= 0, np.append(values, 0)[self.place], 0)


@dataclass(frozen=True)
class Samples:
    """ids (k,) of vertices as far apart as possible, owner (n,): the sample nearest to each vertex along the edges.

    graph (k, k): Euclidean lengths between the samples whose vertices an edge joins.
    """

    ids: np.ndarray
    owner: np.ndarray
    graph: sparse.csr_matrix

    def spread(self, mesh: Mesh, values: np.ndarray) -> np.ndarray:
        """(n,) values (k,) of the samples on the whole mesh, smoothed over their mean spacing."""
        spacing = np.sqrt(mesh.face_areas.sum() / len(self.ids))
        return smoother(mesh, np.ones(len(mesh.vertices)), spacing)(values[self.owner])


def unit_mesh(mesh: Mesh) -> UnitMesh | None:
    """The UnitMesh of a mesh, None where it has no area."""
    faces, place = mesh.faces[mesh.face_areas > 0], np.full(len(mesh.vertices), -1)
    if not len(faces):
        return None
    centroid = mesh.face_areas @ mesh.vertices[mesh.faces].mean(axis=1) / mesh.face_areas.sum()
    used = np.unique(faces)
    inside = mesh.vertices[used] - centroid
    inside = (inside / (2 * np.linalg.norm(inside, axis=1).max())).round(DIGITS)
    positions, place[used] = np.unique(inside, axis=0, return_inverse=True)
    unit = Mesh(positions, place[faces])
    return UnitMesh(unit, place) if unit.face_areas.any() else None


def samples(mesh: Mesh, count: int) -> Samples:
    """The Samples of a unit mesh, all its vertices where it has no more than count.

    The first is the one farthest from the centroid, then each the farthest from all before it (Gonzalez 1985).
    """
    order = np.argsort(-np.linalg.norm(mesh.vertices, axis=1).round(DIGITS), kind="stable")
    ids = np.sort(order[select_far_points(mesh.vertices[order], count)])
    links = mesh.adjacency.tocoo()
    owner = _owners(mesh, ids, links)
    ends = np.stack([owner[links.row], owner[links.col]], axis=1)
    tails, heads = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0).T
    lengths = np.linalg.norm(mesh.vertices[ids[tails]] - mesh.vertices[ids[heads]], axis=1)
    return Samples(ids, owner, sparse.csr_matrix((lengths, (tails, heads)), shape=(len(ids), len(ids))))


def _owners(mesh, ids, links):
    """(n,) the sample nearest along the edges; the nearest in space for a component without one."""
    lengths = np.linalg.norm(mesh.vertices[links.row] - mesh.vertices[links.col], axis=1)
    edges = sparse.csr_matrix((lengths, (links.row, links.col)), shape=links.shape)
    nearest = dijkstra(edges, indices=ids, min_only=True, return_predecessors=True)[2]
    owner = np.searchsorted(ids, nearest)
    alone = nearest < 0
    owner[alone] = cKDTree(mesh.vertices[ids]).query(mesh.vertices[alone])[1]
    return owner

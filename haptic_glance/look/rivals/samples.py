"""Samples of a mesh that several rivals share: few vertices that stand for the rest, and averages over the surface.

Detectors of quadratic cost use the few vertices. Centre-surround detectors use the Gaussian-weighted averages.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from haptic_glance.base.jit import cached_njit
from haptic_glance.mesh.mesh import Mesh

from ..channels.surface import smoother
from ..weights.svm import select_far_points

kernel = cached_njit()
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
    vertex_ids = np.unique(faces)
    inside = mesh.vertices[vertex_ids] - centroid
    inside = (inside / (2 * np.linalg.norm(inside, axis=1).max())).round(DIGITS)
    positions, place[vertex_ids] = np.unique(inside, axis=0, return_inverse=True)
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


SPACING = 0.01  # of the diagonal: the longest edge of an element; the elements' centres lie about half as far apart
CELLS = 3  # per sigma: elements that share a cell count as one, at their centre; widens the Gaussian by under 1 %


@dataclass(frozen=True)
class SurfaceElements:
    """Small triangles that make up a surface: centres (s, 3), areas (s,) and values there (s, d)."""

    centres: np.ndarray
    areas: np.ndarray
    values: np.ndarray


def surface_elements(mesh: Mesh, values: np.ndarray) -> SurfaceElements:
    """The SurfaceElements of a mesh, with values (n, d) interpolated from the vertices."""
    corners = subdivide(mesh, values)
    areas = area_vectors(corners[..., :3])[1]
    centres = corners.mean(axis=1)
    return SurfaceElements(centres[:, :3], areas, centres[:, 3:])


def subdivide(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(s, 3, 3 + d) corners of the faces, bisected until no edge is longer than SPACING, with the values (n, d)."""
    corners = np.concatenate([mesh.vertices, values], axis=1)[mesh.faces[mesh.face_areas > 0]]
    small = [corners[:0]]
    while len(corners):
        lengths = np.linalg.norm(np.roll(corners, -1, axis=1)[..., :3] - corners[..., :3], axis=2)
        fine = lengths.max(axis=1) <= SPACING * mesh.diagonal
        small.append(corners[fine])
        corners = _halves(corners[~fine], lengths[~fine].argmax(axis=1))
    return np.concatenate(small)


def gaussian_average(mesh: Mesh, elements: SurfaceElements, sigma: float) -> np.ndarray:
    """(n, d) averages over the surface around each vertex, weighted by exp(-distance^2 / (2 sigma^2)) within 2 sigma.

    Distances are Euclidean and sigma is in units of the mesh (Lee, Varshney, Jacobs, Mesh saliency, SIGGRAPH 2005,
    section 3.2). The paper sums over the vertices; an integral over the surface is the same on an even mesh, and on
    an uneven or coarse one it does not follow the tessellation. NaN at a vertex with no surface within 2 sigma.
    """
    near = _merged(elements, sigma / CELLS)
    values = near.areas[:, None] * np.column_stack([np.ones(len(near.areas)), near.values])
    totals = gaussian_sums(mesh.vertices, near.centres, values, sigma)
    return np.divide(totals[:, 1:], totals[:, :1], out=np.full_like(totals[:, 1:], np.nan), where=totals[:, :1] > 0)


def area_vectors(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(normals times areas (s, 3), areas (s,)) of triangles (s, 3, 3)."""
    vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    return vectors, np.linalg.norm(vectors, axis=1)


def _halves(corners, longest):
    """Faces (m, 3, k) bisected at the middle of their longest edge, which runs from corner `longest` to the next."""
    rotated_corners = np.take_along_axis(corners, ((longest[:, None] + np.arange(3)) % 3)[..., None], axis=1)
    a, b, c = rotated_corners.transpose(1, 0, 2)
    middle = (a + b) / 2
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def _merged(elements, size):
    """The elements that share a cell of a grid of the given size as one, at their common centre."""
    columns = np.ascontiguousarray(np.concatenate([elements.centres, elements.values], axis=1).T)
    x, y, z = (np.floor((column - column.min(initial=np.inf)) / size).astype(np.int64) for column in columns[:3])
    cell = np.unique((x * (y.max(initial=0) + 1) + y) * (z.max(initial=0) + 1) + z, return_inverse=True)[1]
    areas = np.bincount(cell, elements.areas)
    means = np.stack([np.bincount(cell, elements.areas * column) / areas for column in columns], axis=1)
    return SurfaceElements(means[:, :3], areas, means[:, 3:])


FINEST = 128  # cells along the longest side, so that a small sigma does not ask for a grid that fills the memory


@kernel
def gaussian_sums(places: np.ndarray, points: np.ndarray, values: np.ndarray, sigma: float) -> np.ndarray:
    """(n, d) f8: at each of places (n, 3) the sum of values (s, d) times exp(-distance^2 / (2 sigma^2)) within 2 sigma.

    points (s, 3) f8, where the values are.
    """
    sums, reach = np.zeros((len(places), values.shape[1])), 2 * sigma
    if len(points) == 0:
        return sums
    low, high = np.empty(3), np.empty(3)
    for axis in range(3):
        low[axis], high[axis] = points[:, axis].min(), points[:, axis].max()
    cell = max(sigma, (high - low).max() / FINEST)
    shape = ((high - low) / cell).astype(np.int64) + 1
    order, starts = _sorted_by_cell(points, low, cell, shape)
    first, last = np.empty(3, np.int64), np.empty(3, np.int64)
    for i in range(len(places)):
        x, y, z = places[i]
        for axis in range(3):
            first[axis] = max(int(np.floor((places[i, axis] - reach - low[axis]) / cell)), 0)
            last[axis] = min(int(np.floor((places[i, axis] + reach - low[axis]) / cell)), shape[axis] - 1)
        if first[0] > last[0]:
            continue
        for a in range(first[2], last[2] + 1):
            for b in range(first[1], last[1] + 1):
                row = (a * shape[1] + b) * shape[0]
                for k in order[starts[row + first[0]] : starts[row + last[0] + 1]]:
                    square = (points[k, 0] - x) ** 2 + (points[k, 1] - y) ** 2 + (points[k, 2] - z) ** 2
                    if square <= reach * reach:
                        weight = np.exp(square / (-2 * sigma * sigma))
                        for column in range(values.shape[1]):
                            sums[i, column] += weight * values[k, column]
    return sums


@kernel
def _sorted_by_cell(points, low, cell, shape):
    """(ids of the points cell by cell, start of each cell's ids and one more at the end)."""
    at = np.empty(len(points), np.int64)
    starts = np.zeros(shape[0] * shape[1] * shape[2] + 1, np.int64)
    for k in range(len(points)):
        x, y, z = ((points[k] - low) / cell).astype(np.int64)
        at[k] = (z * shape[1] + y) * shape[0] + x
        starts[at[k] + 1] += 1
    for k in range(1, len(starts)):
        starts[k] += starts[k - 1]
    order, free = np.empty(len(points), np.int64), starts.copy()
    for k in range(len(points)):
        order[free[at[k]]] = k
        free[at[k]] += 1
    return order, starts

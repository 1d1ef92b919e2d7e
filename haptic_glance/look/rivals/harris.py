"""3D-Harris: the Harris operator on the surface fitted around each vertex (Sipiran and Bustos 2011; thesis "3DH").

I. Sipiran, B. Bustos: Harris 3D: a robust extension of the Harris operator for interest point detection on 3D meshes,
The Visual Computer 27(11), 2011. Section numbers below are those of the paper.
"""

import numpy as np
from scipy import sparse

from haptic_glance.mesh.mesh import Mesh

from .maxima import representatives, ring_maxima

EXTENT = 0.01  # of the size: a neighbourhood grows ring by ring until its outermost vertex is that far away (3.1)
MIN_RINGS = 2  # one ring has some six vertices, no more than there are coefficients
MAX_RINGS = 8  # bounds the cost on very fine meshes
HARRIS = 0.04  # k in det(E) - k tr(E)^2
VARIANCE = 2.0  # of the Gaussian, in squares of the neighbourhood's extent: gives the paper's closed forms of E
SPACING = 0.05  # of the size, between representatives of the clusters (3.3); our choice leaves some 200 of 20,000
RIDGE = 1e-3  # keeps the fit well-conditioned where neighbours are few or almost collinear
DIGITS = 6  # decimals: on a plane the response is rounding error
BLOCK = 4000  # vertices fitted at a time, to limit the memory


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8, at least 0: fourth root of the Harris response, zero where that is negative (edges).

    Lengths are in units of EXTENT times the size, which the paper leaves open, so scale does not matter. The size is
    twice the distance of the farthest vertex from the surface's centroid: the paper's bounding-box diagonal changes as
    the object turns. The response grows with the fourth power of curvature; its root keeps the order of the vertices,
    and so the points, and is less dominated by a few spikes.
    """
    size = _size(mesh)
    if not size > 0:
        return np.zeros(len(mesh.vertices))
    members = _neighbourhoods(mesh, EXTENT * size)
    vertices = mesh.vertices / (EXTENT * size)
    blocks = range(0, len(vertices), BLOCK)
    response = np.concatenate([_response(vertices, members[first : first + BLOCK], first) for first in blocks])
    return (np.maximum(response, 0) ** 0.25).round(DIGITS)


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: maxima over the one-ring, one of each cluster (3.3).

    From the highest down, a maximum is kept when it lies farther than SPACING from all that are kept.
    """
    return representatives(mesh, ring_maxima(mesh, values, 1), SPACING * _size(mesh))


def _response(vertices, members, first):
    """det(E) - k tr(E)^2 of the vertices first, first + 1, ... whose neighbourhoods are the rows of members."""
    counts = np.diff(members.indptr)
    rows = np.repeat(np.arange(len(counts)), counts)
    local = _canonical(vertices[members.indices], vertices[first : first + len(counts)], rows, counts)
    p1, p2, p3, p4, p5, _ = _fit(local, rows, len(counts)).T
    a = p4**2 + VARIANCE * (p1**2 + p2**2)  # the integral of Gaussian times f_x^2, f = p1/2 x^2 + p2 x y + ...
    b = p5**2 + VARIANCE * (p2**2 + p3**2)
    c = p4 * p5 + VARIANCE * p2 * (p1 + p3)
    return a * b - c**2 - HARRIS * (a + b) ** 2


def _canonical(places, origins, rows, counts):
    """Neighbours in the frame of their principal axes, z the thinnest, x = y = 0 at the vertex itself (3.2)."""
    mean = _sums(places, rows, len(counts)) / counts[:, None]
    spread = places - mean[rows]
    scatter = _sums(spread[:, :, None] * spread[:, None, :], rows, len(counts))
    axes = np.linalg.eigh(scatter)[1][:, :, ::-1]
    local = np.einsum("ki,kij->kj", spread, axes[rows])
    local[:, :2] -= np.einsum("ni,nij->nj", origins - mean, axes)[rows, :2]
    return local


def _fit(local, rows, count):
    """(count, 6) coefficients of z = p1/2 x^2 + p2 xy + p3/2 y^2 + p4 x + p5 y + p6 by least squares."""
    x, y, z = local.T
    terms = np.stack([x * x / 2, x * y, y * y / 2, x, y, np.ones_like(x)], axis=1)
    normal = _sums(terms[:, :, None] * terms[:, None, :], rows, count)
    ridge = RIDGE * np.diag([1.0, 2, 1, 1, 1, 1])  # these weights do not change as x and y turn
    return np.linalg.solve(normal + ridge, _sums(terms * z[:, None], rows, count)[:, :, None])[:, :, 0]


def _sums(values, rows, count):
    """Sums of values (k, ...) with equal row: (count, ...)."""
    picker = sparse.csr_matrix((np.ones(len(rows)), (rows, np.arange(len(rows)))), shape=(count, len(rows)))
    return (picker @ values.reshape(len(rows), -1)).reshape(count, *values.shape[1:])


def _neighbourhoods(mesh, extent) -> sparse.csr_matrix:
    """(n, n) sparse: in row v the vertex itself and its rings, up to the first ring that is far enough (3.1)."""
    n = len(mesh.vertices)
    step = (mesh.adjacency + sparse.identity(n, dtype=bool)).tocsr()  # pyright: ignore[reportArgumentType] (scipy has no stub)
    members = step
    for rings in range(2, MAX_RINGS + 1):
        growing = np.arange(n) if rings <= MIN_RINGS else np.flatnonzero(_farthest(mesh, members) < extent)
        if len(growing) == 0:
            break
        grown = (members[growing] @ step).tocoo()
        members = members + sparse.csr_matrix((grown.data, (growing[grown.row], grown.col)), shape=(n, n))
    return members


def _farthest(mesh, members):
    """(n,) distance from each vertex to the farthest one of its neighbourhood."""
    rows = np.repeat(np.arange(members.shape[0]), np.diff(members.indptr))
    distance = np.linalg.norm(mesh.vertices[members.indices] - mesh.vertices[rows], axis=1)
    return np.maximum.reduceat(distance, members.indptr[:-1])


def _size(mesh):
    """Twice the distance of the farthest vertex in a face from the surface's centroid; zero without area."""
    area = mesh.face_areas.sum()
    if not area > 0:
        return 0.0
    centroid = mesh.face_areas @ mesh.vertices[mesh.faces].mean(axis=1) / area
    return 2 * float(np.linalg.norm(mesh.vertices[mesh.used] - centroid, axis=1).max())

"""Heat kernel signature: how much heat remains where it started (Sun, Ovsjanikov, Guibas 2009; thesis "HKS").

J. Sun, M. Ovsjanikov, L. Guibas: A concise and provably informative multi-scale signature based on heat diffusion,
Computer Graphics Forum 28(5), 2009. Heat leaves the tip of a limb slowly, so k_t(x, x) at a large time t is high there.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import LinearOperator, eigsh

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh

from ..channels.surface import laplacian, solver_of
from .maxima import ring_maxima

TIME = 0.1  # of the surface area: limbs and ears stand out, folds are gone; 0.05 to 0.5 give the same peaks on animals
PAIRS = 40  # the paper takes 300; at this time the 41st weighs exp(-50), and 300 take 30 times as long
RINGS = 2  # Sun 2009, section 5: maxima over the 2-ring
DENSE = 200  # vertices; smaller components are solved in full
LEAST_SHARE = 1e-3  # of the mean vertex area: slivers below it would make the problem ill-conditioned
SHIFT = -1.0  # per unit area, below all eigenvalues, so that the shifted matrix can be factored
TOLERANCE = 1e-9  # of the eigenvalue solver
DIGITS = 5  # decimals, well above that: an even component must have no peaks of rounding


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8, at least 0, one on average: k_t(x, x) over its mean on the connected component of x.

    The scaled signature of the paper (section 4) at one time, t = 0.1 of the surface area, so that neither size nor
    pose matters. Connected components exchange no heat: each is divided by its own heat trace, and as all share one
    time, a component much smaller than the whole is even, near one. Vertices without area get zero.
    Obtuse corners count as right angles (haptic_glance.look.channels.surface.laplacian).
    """
    area = mesh.face_areas.sum()
    result = np.zeros(len(mesh.vertices))
    if not area > 0:
        return result
    unit = Mesh(mesh.vertices / np.sqrt(area), mesh.faces)
    stiffness, areas = laplacian(unit).tocsr(), unit.vertex_areas
    for ids in _components(mesh.adjacency):
        if areas[ids].sum() > 0:
            result[ids] = _scaled_signature(stiffness[ids][:, ids], areas[ids])
    return np.where(areas > 0, result, 0).round(DIGITS)


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids: the local maxima of the signature over the 2-ring (section 5), most salient first."""
    return ring_maxima(mesh, values, RINGS)


def _scaled_signature(stiffness, areas):
    """k_t(x, x) of one connected component, divided by its mean over the component."""
    areas = np.maximum(areas, LEAST_SHARE * areas.mean())
    values, functions = _lowest(stiffness, areas)
    heat = functions**2 @ np.exp(-np.maximum(values, 0) * TIME)
    return heat / np.average(heat, weights=areas)


def _lowest(stiffness, areas):
    """(eigenvalues (k,), eigenfunctions (n, k)) of the generalised problem L f = value A f, lowest first."""
    scale = sparse.diags(1 / np.sqrt(areas))
    matrix, n = scale @ stiffness @ scale, len(areas)
    if n <= DENSE:
        values, vectors = np.linalg.eigh(matrix.toarray())
        return values, scale @ vectors
    solve = solver_of(matrix - SHIFT * sparse.identity(n))
    inverse = LinearOperator((n, n), solve, dtype=np.float64)  # pyright: ignore[reportCallIssue] (no stub)
    start = rng(0, "heat kernel").normal(size=n)  # eigsh would draw another one each time
    values, vectors = eigsh(matrix, PAIRS, sigma=SHIFT, OPinv=inverse, v0=start, tol=TOLERANCE)  # pyright: ignore[reportArgumentType]
    return values, scale @ vectors


def _components(adjacency):
    """The vertex ids of each connected component."""
    labels = connected_components(adjacency, directed=False)[1]
    return np.split(np.argsort(labels, kind="stable"), np.cumsum(np.bincount(labels))[:-1])

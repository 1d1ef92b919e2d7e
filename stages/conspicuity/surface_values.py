"""Smooths values over the surface, and fills them in where no view sees it."""

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from stages.kit import Mesh

SMOOTHING = 0.02  # units; a few faces wide, so that single faces do not show in the map
FILL_DISTANCE = 0.2  # units over which values extend into hidden surface; the inside of a teapot must stay dark
MIN_FILL = 1e-6  # keeps the equations solvable without smoothing
MIN_CONFIDENCE = 1e-6  # less is a glance along the surface: where no vertex of a part has more, no view sees it
MIN_AREA = 1e-9  # square units; for vertices in no face and faces without area
MAX_COTANGENT = 1e3  # larger ones come from slivers and would make the equations ill-conditioned


def smoother(mesh: Mesh, confidence: np.ndarray, length: float = SMOOTHING) -> Callable[[np.ndarray], np.ndarray]:
    """A function that smooths values (n,) or (n, d) on the vertices, staying close to them where confidence is high.

    confidence (n,) in 0..1, length in units. Solves (C A + H A + length^2 L) s = C A v: Tikhonov regularisation with
    the cotangent Laplacian L (Pinkall and Polthier 1993) and the vertex areas A, so that the result does not depend on
    the resolution of the mesh. Where confidence C is zero, H = (length / FILL_DISTANCE)^2 fills values in from the
    neighbours, decreasing with distance. A component that no view sees gets zero. Negative cotangents count as zero,
    which keeps the result between zero and the largest value.
    """
    area = np.maximum(mesh.vertex_areas, MIN_AREA)
    hidden = np.where(confidence > MIN_CONFIDENCE, 0, max(length / FILL_DISTANCE, MIN_FILL) ** 2)
    system = sparse.diags((confidence + hidden) * area) + length**2 * laplacian(mesh)
    solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    return lambda values: solver.solve(((confidence * area) * np.asarray(values).T).T)


def laplacian(mesh: Mesh) -> sparse.csr_matrix:
    """(n, n) sparse cotangent Laplacian, positive semi-definite, cotangents clipped to 0..MAX_COTANGENT."""
    n = len(mesh.vertices)
    corners = mesh.vertices[mesh.faces]
    a, b = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    double_area = np.maximum(2 * mesh.face_areas, MIN_AREA)[:, None]
    half_cotangents = np.clip(np.einsum("mki,mki->mk", a, b) / double_area, 0, MAX_COTANGENT).ravel() / 2
    tails, heads = np.roll(mesh.faces, -1, axis=1).ravel(), np.roll(mesh.faces, -2, axis=1).ravel()
    one_way = sparse.coo_matrix((half_cotangents, (tails, heads)), shape=(n, n))
    joined = one_way + one_way.T
    return sparse.diags(np.asarray(joined.sum(axis=1)).ravel()) - joined

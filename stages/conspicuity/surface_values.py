"""Values of views spread over the surface: averaged, filled where nobody looks, and smooth."""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

SMOOTHING = 0.02  # units; a few facets wide, so that the map reads as patches and not as facets
REACH = 0.2  # units: so far do places that nobody sees take after those seen; a teapot's inside must not glow
LEAST_PULL = 1e-6  # keeps the equations solvable without any smoothing
LEAST_AREA = 1e-9  # square units; for vertices in no face and faces without area
STEEPEST = 1e3  # cotangents beyond this come from slivers and would spoil the equations' condition


def smoother(mesh, confidence, length=SMOOTHING):
    """A function from values (n,) or (n, d) on the vertices to smooth ones, near them where confidence is high.

    confidence (n,) in 0..1, length in units. Solves (C A + H A + length^2 L) s = C A v: Tikhonov regularisation with
    the cotangent Laplacian L (Pinkall and Polthier 1993) and the vertex areas A, so the result does not depend on how
    finely the surface is meshed. Where confidence is zero, H = (length / REACH)^2 lets the neighbours fill in and fade
    with distance; a piece of surface that nobody sees gets zero. Negative cotangents count as zero, which keeps the
    result between zero and the largest value.
    """
    area = np.maximum(mesh.vertex_areas, LEAST_AREA)
    hidden = np.where(confidence > 0, 0, max(length / REACH, LEAST_PULL) ** 2)
    system = sparse.diags((confidence + hidden) * area) + length**2 * laplacian(mesh)
    solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    return lambda values: solver.solve(((confidence * area) * np.asarray(values).T).T)


def laplacian(mesh):
    """(n, n) sparse cotangent Laplacian, positive semi-definite, cotangents clipped to 0..STEEPEST."""
    n = len(mesh.vertices)
    corners = mesh.vertices[mesh.faces]
    a, b = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    double_area = np.maximum(2 * mesh.face_areas, LEAST_AREA)[:, None]
    half_cotangents = np.clip(np.einsum("mki,mki->mk", a, b) / double_area, 0, STEEPEST).ravel() / 2
    tails, heads = np.roll(mesh.faces, -1, axis=1).ravel(), np.roll(mesh.faces, -2, axis=1).ravel()
    one_way = sparse.coo_matrix((half_cotangents, (tails, heads)), shape=(n, n))
    joined = one_way + one_way.T
    return sparse.diags(np.asarray(joined.sum(axis=1)).ravel()) - joined

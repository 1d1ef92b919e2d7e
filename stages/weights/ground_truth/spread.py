"""Spreads amounts at vertices over the surface by heat flow, which is a Gaussian in the plane."""

import numpy as np
import robust_laplacian
from scipy import sparse
from scipy.sparse.linalg import splu

from haptic_glance.mesh.mesh import Mesh

STEPS = 32  # errors on a plane: 4 % at the peak and 2.4 % in L1; with 8 steps 15 % and 8 %
MIN_AREA = 1e-12  # of the squared diagonal; for vertices between faces without area


def spread_on_surface(mesh: Mesh, amounts: np.ndarray, sigma: float) -> np.ndarray:
    """(n,) f8 density per square unit: amounts (n,) at the vertices spread over the surface with deviation sigma.

    Heat flow for the time sigma^2 / 2, which in the plane is the Gaussian of deviation sigma, by implicit steps
    (A + dt L) u' = A u with the vertex areas A and the intrinsic Delaunay Laplacian L (Sharp and Crane 2020, A
    Laplacian for Nonmanifold Triangle Meshes). L has no negative weights, so the density is not negative, and it is
    accurate on any triangulation: clipped cotangents spread 4 to 19 % too wide on a plane with jittered vertices. Area
    times density sums to the amounts. Nothing spreads between connected components. Vertices at the same position are
    merged, so that seams do not stop the flow. sigma: in units of the mesh; if it is far below the length of an edge,
    the amounts stay at their vertices.

    Raises ValueError for amounts of another shape, negative or NaN, for amounts at vertices in no face, and for a sigma
    that is not positive.
    """
    amounts = np.asarray(amounts, dtype=np.float64)
    if amounts.shape != (len(mesh.vertices),) or not np.isfinite(amounts).all() or (amounts < 0).any():
        raise ValueError(f"amounts must be {len(mesh.vertices)} finite values, not negative, got {amounts.shape}")
    if not (np.isfinite(sigma) and sigma > 0):
        raise ValueError(f"sigma must be a positive length, got {sigma}")
    density = np.zeros(len(amounts))
    if not amounts.any():
        return density
    size = mesh.diagonal or 1.0  # lengths relative to the diagonal, so that the result does not depend on the unit
    positions, position, faces = _surface(mesh, size)
    used = np.unique(faces)
    heat = np.bincount(position, amounts, minlength=len(positions))
    bare = np.setdiff1d(np.flatnonzero(heat), used)
    if len(bare):
        raise ValueError(f"amounts at {len(bare)} positions in no face, the first at {positions[bare[0]] * size}")
    density = np.zeros(len(positions))
    density[used] = _flow(positions[used], np.searchsorted(used, faces), heat[used], (sigma / size) ** 2 / 2)
    return density[position] / size**2


def _surface(mesh, size):
    """(positions (p, 3), position id per vertex (n,), faces (m', 3)): equal vertices merged, no degenerate faces."""
    positions, position = np.unique(mesh.vertices / size + 0.0, axis=0, return_inverse=True)  # + 0.0: no -0.0
    position = position.reshape(-1)
    a, b, c = position[mesh.faces].T
    return positions, position, position[mesh.faces][(a != b) & (b != c) & (c != a)]


def _flow(vertices, faces, heat, time):
    """Heat (n,) per area after a time."""
    laplacian, _ = robust_laplacian.mesh_laplacian(vertices, faces)
    corners = vertices[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    area = np.bincount(faces.ravel(), np.repeat(areas / 3, 3), minlength=len(vertices))
    area = np.maximum(area, MIN_AREA)
    system = sparse.diags(area) + time / STEPS * laplacian
    solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    for _ in range(STEPS):
        heat = area * solver.solve(heat)
    return np.maximum(heat / area, 0)

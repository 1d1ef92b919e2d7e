"""Amounts at vertices spread along the surface as a Gaussian would in the plane: by letting heat flow."""

import numpy as np
import robust_laplacian
from scipy import sparse
from scipy.sparse.linalg import splu

STEPS = 32  # on a plane the peak is then 4 % and the whole 2.4 % (L1) off the Gaussian; 8 steps: 15 % and 8 %
LEAST_AREA = 1e-12  # of the squared diagonal; for vertices between faces without area


def spread_on_surface(mesh, amounts, sigma):
    """(n,) f8 density per square unit: amounts (n,) at the vertices spread over the surface with deviation sigma.

    Heat flow for the time sigma^2 / 2, which in the plane is the Gaussian of deviation sigma, by implicit steps
    (A + dt L) u' = A u with the vertex areas A and the intrinsic Delaunay Laplacian L (Sharp and Crane 2020, A
    Laplacian for Nonmanifold Triangle Meshes). That one has no negative weights, so that the density has none, and is
    true on any triangulation: clipped cotangents spread 4 to 19 % too wide on a plane with jittered vertices. Areas
    times density sum to the amounts. Nothing passes to a piece that no edge joins, or across a gap; vertices at one
    place count as one, so that a seam does not stop the flow. sigma in units of the mesh; where it is far below the
    length of an edge the amounts stay at their vertices.

    Raises ValueError for amounts of another shape, negative or NaN, for amounts at places in no face, which have no
    surface to spread on, and for a sigma that is not positive.
    """
    amounts = np.asarray(amounts, dtype=np.float64)
    if amounts.shape != (len(mesh.vertices),) or not np.isfinite(amounts).all() or (amounts < 0).any():
        raise ValueError(f"amounts must be {len(mesh.vertices)} finite values, not negative, got {amounts.shape}")
    if not (np.isfinite(sigma) and sigma > 0):
        raise ValueError(f"sigma must be a positive length, got {sigma}")
    density = np.zeros(len(amounts))
    if not amounts.any():
        return density
    size = mesh.diagonal or 1.0  # lengths in diagonals: a mesh in millimetres spreads like the same in metres
    places, place, faces = _surface(mesh, size)
    used = np.unique(faces)
    heat = np.bincount(place, amounts, minlength=len(places))
    bare = np.setdiff1d(np.flatnonzero(heat), used)
    if len(bare):
        raise ValueError(f"amounts at {len(bare)} places in no face, the first at {places[bare[0]] * size}")
    density = np.zeros(len(places))
    density[used] = _flow(places[used], np.searchsorted(used, faces), heat[used], (sigma / size) ** 2 / 2)
    return density[place] / size**2


def _surface(mesh, size):
    """(places (p, 3), place of each vertex (n,), faces (m', 3)): equal vertices are one, faces without area gone."""
    places, place = np.unique(mesh.vertices / size + 0.0, axis=0, return_inverse=True)  # + 0.0: no -0.0
    place = place.reshape(-1)
    a, b, c = place[mesh.faces].T
    return places, place, place[mesh.faces][(a != b) & (b != c) & (c != a)]


def _flow(vertices, faces, heat, time):
    """Heat (n,) after a time, per area."""
    laplacian, _ = robust_laplacian.mesh_laplacian(vertices, faces)
    corners = vertices[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    area = np.bincount(faces.ravel(), np.repeat(areas / 3, 3), minlength=len(vertices))
    area = np.maximum(area, LEAST_AREA)
    system = sparse.diags(area) + time / STEPS * laplacian
    solver = splu(system.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    for _ in range(STEPS):
        heat = area * solver.solve(heat)
    return np.maximum(heat / area, 0)

"""Scale-dependent corners: where the normals turn in all directions, at the best of several scales (thesis "SDC").

J. Novatnack, K. Nishino: Scale-dependent 3D geometric features, IEEE International Conference on Computer Vision, 2007.
"""

import numpy as np
from scipy import sparse

from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh, corner_sum, unit

from ..channels.surface import laplacian, solver_of
from .maxima import check_values, ring_maxima

SCALES = 0.01 * 2 ** (np.arange(6) / 2)  # standard deviations, of the square root of the area: from 1 % to 5.7 %
STEPS = 2  # implicit steps from scale to scale: one alone has a sharper top and longer tails than a Gaussian
NOISE = 0.05  # normals turn by 3 degrees within a standard deviation: uneven parts of a plane; a cube's corner has 0.38
DIGITS = 6  # decimals: on a plane the response is rounding error
LEAST_SHARE = 1e-3  # of the mean vertex area: slivers below it would make the system ill-conditioned


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8, >= 0: standard deviation times the smaller curvature of the smoothed normals, maximum over the scales.

    At each scale the field of normals is smoothed by a Gaussian of geodesic distance and normalised again. The Gram
    matrix of its derivatives has a large smaller eigenvalue at corners alone: not on edges, not on planes. The root of
    its average over a window, times the standard deviation, has no unit (normalised derivatives), so that scales
    compare.

    Differs from the paper, which unrolls the surface onto a plane and widens its Gaussians by the stretch: a closed
    mesh cannot be unrolled without cuts. Here heat flows on the surface itself, for the time variance / 2, in implicit
    steps: the geodesic smoothing that the widening stands for. The window comes after the eigenvalues, not before, as
    planes that meet at a corner share no frame to add matrices in. The square root of the area is the unit of length.
    """
    return _responses(mesh).max(axis=0)


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: peaks over the surface at a scale that is no worse than its neighbours.

    That is a corner at its own scale, however weak beside others: only NOISE is left out. Meshes of 20,000 vertices
    have 100 to 200 such points, those of 3,000 some 30; a round body has a few where its mesh is uneven.
    values: saliency(mesh) up to a factor, by which the points are ordered.
    """
    check_values(mesh, values)
    responses = np.pad(_responses(mesh), ((1, 1), (0, 0)))
    corners = [
        peaks[response[peaks] >= np.maximum(NOISE, np.maximum(finer, coarser)[peaks])]
        for finer, response, coarser in zip(responses, responses[1:], responses[2:], strict=False)
        for peaks in [ring_maxima(mesh, response, 1)]
    ]
    ids = np.unique(np.concatenate(corners))
    return ids[np.lexsort((*-mesh.vertices[ids].T[::-1], -values[ids]))]


@weak_cache
def _responses(mesh):
    """(s, n) f8, >= 0: the response at each of SCALES."""
    area = mesh.face_areas.sum()
    if not area > 0:
        return np.zeros((len(SCALES), len(mesh.vertices)))
    mesh = Mesh(mesh.vertices / np.sqrt(area), mesh.faces)
    normals, variance, responses = mesh.vertex_normals, 0.0, []
    for scale in SCALES:
        smooth = _smoother(mesh, scale**2 - variance)
        normals, variance = smooth(normals), scale**2
        response = scale**2 * smooth(_smaller_eigenvalue(mesh, unit(normals)))[:, 0]
        responses.append(np.sqrt(np.maximum(response, 0)))
    return np.where(_sum_around(mesh, mesh.face_areas) > 0, responses, 0).round(DIGITS)


def _smoother(mesh, variance):
    """A function that smooths values (n, d) along the surface by a Gaussian of this variance."""
    areas = _sum_around(mesh, mesh.face_areas / 3)
    areas = np.maximum(areas, LEAST_SHARE * areas.mean())
    solve = solver_of(sparse.diags(areas) + variance / (2 * STEPS) * laplacian(mesh))

    def smooth(values):
        for _ in range(STEPS):
            values = solve(areas[:, None] * values)
        return values

    return smooth


def _smaller_eigenvalue(mesh, normals):
    """(n, 1): the smaller eigenvalue of the Gram matrix of the normals' derivatives, averaged over the faces around."""
    areas = mesh.face_areas[:, None, None]
    edges = np.roll(mesh.vertices[mesh.faces], 1, axis=1) - np.roll(mesh.vertices[mesh.faces], -1, axis=1)
    gradients = np.cross(mesh.face_normals[:, None], edges)  # over twice the area: the gradients of the hat functions
    slopes = np.einsum("mci,mcj->mij", gradients, normals[mesh.faces])
    slopes = np.divide(slopes, 2 * areas, out=np.zeros_like(slopes), where=areas > 0)
    gram = slopes @ slopes.transpose(0, 2, 1)  # its third eigenvalue, across the face, is zero
    trace, squares = np.trace(gram, axis1=1, axis2=2), (gram**2).sum(axis=(1, 2))
    smaller = (trace - np.sqrt(np.maximum(2 * squares - trace**2, 0))) / 2
    total, area = _sum_around(mesh, np.maximum(smaller, 0) * mesh.face_areas), _sum_around(mesh, mesh.face_areas)
    return np.divide(total, area, out=np.zeros_like(total), where=area > 0)[:, None]


def _sum_around(mesh, values):
    """(n,) sums of values (m,) over the faces around each vertex."""
    return corner_sum(mesh, np.repeat(values[:, None], 3, axis=1))

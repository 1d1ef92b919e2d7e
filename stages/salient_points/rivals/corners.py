"""Scale-dependent corners: where the normals turn in all directions, at the best of several scales (thesis "SDC").

J. Novatnack, K. Nishino: Scale-dependent 3D geometric features, IEEE International Conference on Computer Vision, 2007.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from stages.conspicuity.surface_values import laplacian
from stages.kit import Mesh
from stages.kit.mesh import corner_sum, unit

from .rings import representatives, ring_maxima

SCALES = 0.01 * 2 ** (np.arange(6) / 2)  # standard deviations, of the square root of the area: from 1 % to 5.7 %
STEPS = 2  # implicit steps from scale to scale: one alone has a sharper top and longer tails than a Gaussian
SPACING = 0.02  # of the square root of the area: the least distance between points
THRESHOLD = 0.3  # normals turn by 17 degrees within a standard deviation; a sphere is at 0.2
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
    area = mesh.face_areas.sum()
    best = np.zeros(len(mesh.vertices))
    if not area > 0:
        return best
    mesh = Mesh(mesh.vertices / np.sqrt(area), mesh.faces)
    normals, variance = mesh.vertex_normals, 0.0
    for scale in SCALES:
        smooth = _smoother(mesh, scale**2 - variance)
        normals, variance = smooth(normals), scale**2
        response = scale**2 * smooth(_smaller_eigenvalue(mesh, unit(normals)))[:, 0]
        best = np.maximum(best, np.sqrt(np.maximum(response, 0)))
    return np.where(_sum_around(mesh, mesh.face_areas) > 0, best, 0).round(DIGITS)


def points(mesh: Mesh, values: np.ndarray | None = None) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: peaks over surface and scales together, above THRESHOLD.

    The best scale of a place is where its response is highest, so a peak of the highest response over the scales is a
    corner at its own scale. The threshold and the least distance are ours: without them noise on flat parts gives
    points.
    """
    values = saliency(mesh) if values is None else values
    peaks = ring_maxima(mesh, values, 1)
    return representatives(mesh, peaks[values[peaks] >= THRESHOLD], SPACING * np.sqrt(mesh.face_areas.sum()))


def _smoother(mesh, variance):
    """A function that smooths values (n, d) along the surface by a Gaussian of this variance."""
    areas = _sum_around(mesh, mesh.face_areas / 3)
    areas = np.maximum(areas, LEAST_SHARE * areas.mean())
    system = (sparse.diags(areas) + variance / (2 * STEPS) * laplacian(mesh)).tocsc()
    solver = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})

    def smooth(values):
        for _ in range(STEPS):
            values = solver.solve(areas[:, None] * values)
        return values

    return smooth


def _smaller_eigenvalue(mesh, normals):
    """(n, 1): the smaller eigenvalue of the Gram matrix of the normals' derivatives, averaged over the faces around."""
    areas = mesh.face_areas[:, None, None]
    edges = np.roll(mesh.vertices[mesh.faces], 1, axis=1) - np.roll(mesh.vertices[mesh.faces], -1, axis=1)
    turned = np.cross(mesh.face_normals[:, None], edges)  # over twice the area: the gradients of the hat functions
    slopes = np.einsum("mci,mcj->mij", turned, normals[mesh.faces])
    slopes = np.divide(slopes, 2 * areas, out=np.zeros_like(slopes), where=areas > 0)
    gram = slopes @ slopes.transpose(0, 2, 1)  # its third eigenvalue, across the face, is zero
    trace, squares = np.trace(gram, axis1=1, axis2=2), (gram**2).sum(axis=(1, 2))
    smaller = (trace - np.sqrt(np.maximum(2 * squares - trace**2, 0))) / 2
    total, area = _sum_around(mesh, np.maximum(smaller, 0) * mesh.face_areas), _sum_around(mesh, mesh.face_areas)
    return np.divide(total, area, out=np.zeros_like(total), where=area > 0)[:, None]


def _sum_around(mesh, values):
    """(n,) sums of values (m,) over the faces around each vertex."""
    return corner_sum(mesh, np.repeat(values[:, None], 3, axis=1))

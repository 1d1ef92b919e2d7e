"""Mesh saliency: centre-surround differences of the mean curvature.

Lee, Varshney, Jacobs: Mesh saliency, ACM Transactions on Graphics 24(3) (SIGGRAPH), 2005, section 3. Differences from
the paper: curvature is the robust one of haptic_glance.look.channels instead of Taubin's one-ring fit, spread over one
epsilon; averages are taken over the surface instead of over the vertices; a scale whose contrast stays under FLOOR is
left out, where the paper's normalisation would raise rounding to full saliency; and the sum is divided by its weights.
The paper selects no points: local maxima above the mean of all local maxima follow Dutagaci, Cheung, Godil, Evaluation
of 3D interest point detection techniques via human-generated ground truth, The Visual Computer 28, 2012.
"""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from ..channels.curvature import mean_curvature
from .maxima import high_maxima, local_maxima
from .samples import gaussian_average, surface_elements

EPSILON = 0.003  # of the bounding-box diagonal (section 3.2)
SCALES = (2, 3, 4, 5, 6)  # sigma in epsilon (section 3.3)
FLOOR = 0.25  # curvature contrast in 1 / diagonal: an icosphere of 642 vertices has 0.16 (curvature of a sphere: 3.5)
RADIUS = 8  # epsilon: the least distance between points, the window of the middle scale


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8 in 0..1: mesh saliency at the vertices, whatever the scale and the rotation of the mesh.

    Zero everywhere on a sphere, a plane and a mesh without area.
    """
    contrasts = _contrasts(mesh)
    if not contrasts:
        return np.zeros(len(mesh.vertices))
    weights = [_uniqueness(mesh, contrast, sigma) for sigma, contrast in contrasts.items()]
    return np.average(list(contrasts.values()), axis=0, weights=weights)


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: the local maxima of saliency above the mean of all of them."""
    return high_maxima(mesh, values, RADIUS * EPSILON * mesh.diagonal)


def _contrasts(mesh):
    """dict sigma -> (n,) |G(C, sigma) - G(C, 2 sigma)| over its maximum; scales without contrast are left out."""
    if not mesh.face_areas.any():
        return {}
    surface = surface_elements(mesh, mean_curvature(mesh, smoothing=EPSILON)[:, None])
    sigmas = [scale * EPSILON * mesh.diagonal for scale in SCALES]
    widths = sorted({factor * sigma for sigma in sigmas for factor in (1, 2)})
    means = {sigma: gaussian_average(mesh, surface, sigma)[:, 0] for sigma in widths}
    unused = (mesh.vertex_normals == 0).all(axis=1)  # in no face: not part of the surface
    contrasts = {sigma: np.where(unused, 0, np.abs(means[sigma] - means[2 * sigma])) for sigma in sigmas}
    return {sigma: c / c.max() for sigma, c in contrasts.items() if c.max() * mesh.diagonal > FLOOR}


def _uniqueness(mesh, contrast, sigma):
    """The factor (M - m)^2 of the non-linear suppression: M = 1, m the mean of the other local maxima (section 3.3)."""
    maxima = local_maxima(mesh, contrast, 2 * sigma)[1:]
    mean = contrast[maxima].mean() if len(maxima) else 0
    return max((1 - mean) ** 2, 1e-6)  # two equal maxima, as on an ellipsoid, must not erase the map

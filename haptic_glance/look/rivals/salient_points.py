"""Salient points: how far the surface moves along its normals under Gaussian smoothing, over scales.

Castellani, Cristani, Fantoni, Murino: Sparse points matching by combining 3D mesh saliency with statistical
descriptors, Computer Graphics Forum 27(2) (Eurographics), 2008, section 3. Differences from the paper: the octaves
double sigma on one mesh where the paper decimates it, so that nothing must be transferred back; averages are taken
over the surface instead of over the vertices; scales below SMALLEST, which only dense scans resolve, are left out; so
is a scale whose contrast stays under FLOOR; and the map is not inhibited (the paper clears what does not exceed 85 % of
its neighbours): a local maximum passes that by itself, and a dense map is the stronger rival.
"""

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .maxima import local_maxima
from .samples import gaussian_average, surface_elements

EPSILON = 0.001  # of the bounding-box diagonal
SCALES = (1, 2, 3, 4, 5, 6)  # sigma in epsilon in the first octave
OCTAVES = 3  # each doubles sigma: up to 2.4 % of the diagonal
SMALLEST = 6  # epsilon: the surface is sampled no finer
THRESHOLD = 0.3  # of the largest saliency: points lie above it
FLOOR = 3.0  # contrast of displacement over sigma squared, in 1 / diagonal: an icosphere has 2.8, a plane 0
RADIUS = 24  # epsilon: the least distance between points, sigma of the largest scale


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8 in 0..1: how much farther than the rest of the mesh each vertex moves along its normal, over the scales.

    It does not depend on the scale and the rotation of the mesh. Zero everywhere on a sphere, a plane and a mesh
    without area.
    """
    maps = list(_displacements(mesh).values())
    total = np.sum(maps, axis=0) if maps else np.zeros(len(mesh.vertices))
    return total / total.max() if total.any() else total


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: the local maxima of saliency above 30 % of the maximum."""
    if not values.any():
        return np.zeros(0, dtype=np.int64)
    peaks = local_maxima(mesh, values, RADIUS * EPSILON * mesh.diagonal)
    return peaks[values[peaks] > THRESHOLD * values.max(initial=0)]


def _displacements(mesh):
    """dict sigma -> (n,) |normal . (g(v, sigma) - g(v, 2 sigma))| in 0..1; scales without contrast are left out."""
    if not mesh.face_areas.any():
        return {}
    surface = surface_elements(mesh, mesh.vertices)
    steps = sorted({scale * 2**octave for scale in SCALES for octave in range(OCTAVES)})
    sigmas = [step * EPSILON * mesh.diagonal for step in steps if step >= SMALLEST]
    means = {s: gaussian_average(mesh, surface, s) for s in sorted({k * s for s in sigmas for k in (1, 2)})}
    has_normal = mesh.vertex_normals.any(axis=1)  # a vertex in no face does not move, and must not set the minimum
    scales = {}
    for sigma in sigmas:
        shifts = np.abs(np.einsum("ij,ij->i", mesh.vertex_normals, np.nan_to_num(means[sigma] - means[2 * sigma])))
        lowest, highest = shifts[has_normal].min(), shifts.max()
        if (highest - lowest) / sigma**2 * mesh.diagonal > FLOOR:
            scales[sigma] = np.where(has_normal, (shifts - lowest) / (highest - lowest), 0)
    return scales

"""Regions of interest: surface that is unlike the rest, near what is, or at the end of a limb (Leifman 2012).

G. Leifman, E. Shtrom, A. Tal: Surface regions of interest for viewpoint selection, CVPR 2012; PAMI 38(12), 2016. Of
vertex i with spin images h_i, diffusion distance d (Ling and Okada 2006) and geodesic distance g:

    distinctness  D_i = 1 - exp(-mean of d(h_i, h_j) / (1 + 3 g_ij) over the vertices j most like i), mean over scales
    association   A_i = D_f exp(-g_if^2 / (2 sigma^2)), f the nearest focus: the most distinct fifth of the vertices
    extremity     E_i = exp(-g_ie^2 / (2 sigma^2)), e the nearest end of a limb, where the object has limbs
    interest      max((D_i + A_i) / 2, E_i)

Our choices: SAMPLES vertices far apart instead of a simplified mesh; (D + A) / 2 is scaled to 1 before the maximum;
radii and the number of similar vertices; an end is a local maximum of the mean geodesic distance, LIMB times as far off
as the middle, without the paper's convex hull of a scaled embedding; vertices in two parts count as the farthest of all
pairs. The paper selects no points.
"""

import math

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.distance import cdist

from haptic_glance.base.jit import cached_njit
from haptic_glance.mesh.mesh import Mesh

from .maxima import high_maxima
from .samples import Samples, samples, unit_mesh

kernel = cached_njit()
SAMPLES = 1500
RADII = (0.05, 0.1, 0.2)  # of the size: the supports of the spin images
BINS = 8  # from the normal to the rim
SIMILAR = 64  # vertices most like one, as in Goferman 2010, whose distinctness of images this is
FOCI = 0.2  # of the vertices
SIGMA = 0.05  # of the size
LIMB = 1.3  # a limb's end to the middle, in mean geodesic distance: a ball has 1, a cube 1.1, a body 3 by 1 by 1 1.4
ENDS = 0.1  # of the size: an end is the farthest so far around
FLOOR = 0.15  # distinctness: a ball has up to 0.11, by its tessellation, a cube 0.29


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8 in 0..1: the interest of each vertex, whatever the size and the pose of the mesh; zero in no face."""
    unit = unit_mesh(mesh)
    if unit is None:
        return np.zeros(len(mesh.vertices))
    sample_set = samples(unit.mesh, SAMPLES)
    reach = dijkstra(sample_set.graph, directed=False)
    distances = np.where(np.isfinite(reach), reach, reach[np.isfinite(reach)].max())
    distinct = distinctness(unit.mesh, sample_set, distances)
    interest = (distinct + association(distinct, distances)) / 2
    interest = interest / interest.max() if distinct.max() > FLOOR else np.zeros(len(interest))
    ends = limb_ends(reach)
    if len(ends):
        interest = np.maximum(interest, _fade(distances[:, ends].min(axis=1)))
    return unit.to_vertices(sample_set.spread(unit.mesh, interest).clip(0, 1))


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: the local maxima of saliency above the mean of all of them."""
    return high_maxima(mesh, values)


def distinctness(mesh: Mesh, few: Samples, apart: np.ndarray) -> np.ndarray:
    """(k,) in 0..1: how unlike the vertices most like it each sample of a unit mesh is; apart (k, k): geodesic."""
    similar = min(SIMILAR, len(few.ids) - 1)
    if not similar:
        return np.zeros(len(few.ids))
    maps = []
    for radius in RADII:
        images = spin_images(
            mesh.vertices, mesh.vertex_areas, mesh.vertices[few.ids], mesh.vertex_normals[few.ids], radius, BINS
        )
        unlike = cdist(pyramid(images), pyramid(images), "cityblock") / (1 + 3 * apart / apart.max())
        np.fill_diagonal(unlike, np.inf)
        maps.append(1 - np.exp(-np.partition(unlike, similar - 1, axis=1)[:, :similar].mean(axis=1)))
    return np.mean(maps, axis=0)


def pyramid(images: np.ndarray) -> np.ndarray:
    """(k, d) all levels of images (k, 2 b, b), each half as fine: the diffusion distance is their city-block distance.

    A level is the mean over two by two bins, which a mirrored image shares, where Ling and Okada take every second bin.
    """
    levels = [images]
    while levels[-1].shape[2] > 1:
        smooth = np.asarray(gaussian_filter(levels[-1], (0, 0.5, 0.5), mode="constant"))
        rows, columns = smooth.shape[1] // 2, smooth.shape[2] // 2
        levels.append(smooth.reshape(-1, rows, 2, columns, 2).mean(axis=(2, 4)))
    return np.concatenate([level.reshape(len(images), -1) for level in levels], axis=1)


def association(distinct: np.ndarray, apart: np.ndarray) -> np.ndarray:
    """(k,) distinctness (k,) of the nearest focus, faded by the distance to it; apart (k, k): geodesic."""
    foci = np.flatnonzero(distinct >= np.quantile(distinct, 1 - FOCI))
    nearest = apart[:, foci].argmin(axis=1)
    return distinct[foci][nearest] * _fade(apart[:, foci].min(axis=1))


def limb_ends(reach: np.ndarray) -> np.ndarray:
    """(e,) samples at the ends of limbs; reach (k, k): geodesic, infinite between parts."""
    is_connected = np.isfinite(reach)
    mean = np.where(is_connected, reach, 0).sum(axis=1) / is_connected.sum(axis=1)
    middle = np.where(is_connected, mean, np.inf).min(axis=1)
    farthest = np.where(reach <= ENDS, mean, 0).max(axis=1)
    return np.flatnonzero((mean >= farthest) & (mean > LIMB * middle))


def _fade(distance):
    return np.exp(-(distance**2) / (2 * SIGMA**2))


@kernel
def spin_images(
    positions: np.ndarray, areas: np.ndarray, centres: np.ndarray, normals: np.ndarray, radius: float, bins: int
) -> np.ndarray:
    """(k, 2 bins, bins) shares of the area around each of k centres (k, 3) with normals (k, 3).

    Rows are heights over the tangent plane from -radius to radius, columns distances from the normal's line up to it.
    positions (n, 3) with areas (n,) make up the surface; each within radius counts in the four bins around it. An image
    sums to one, or to zero where nothing is near. Source: Johnson and Hebert, Using spin images for efficient object
    recognition in cluttered 3D scenes, PAMI 21(5), 1999.
    """
    images = np.zeros((len(centres), 2 * bins, bins))
    for k in range(len(centres)):
        for i in range(len(positions)):
            square, height = 0.0, 0.0
            for axis in range(3):
                side = positions[i, axis] - centres[k, axis]
                square += side * side
                height += side * normals[k, axis]
            if square <= radius**2:
                aside = math.sqrt(max(square - height * height, 0.0))
                _add(images[k], (height / radius + 1) * bins - 0.5, aside / radius * bins - 0.5, areas[i])
        total = images[k].sum()
        if total > 0:
            images[k] /= total
    return images


@kernel
def _add(image, row, column, amount):
    """Shares an amount among the four bins around a place; what falls off the edge goes to the bin there."""
    first, left = math.floor(row), math.floor(column)
    for i, down in ((first, first + 1 - row), (first + 1, row - first)):
        for j, right in ((left, left + 1 - column), (left + 1, column - left)):
            place = min(max(i, 0), len(image) - 1), min(max(j, 0), image.shape[1] - 1)
            image[place] += amount * down * right

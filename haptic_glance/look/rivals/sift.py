"""3D-SIFT: extrema of the difference of Gaussians of the voxelised solid, over space and scale.

Godil, Wagan: Salient local 3D features for 3D shape retrieval, Three-Dimensional Imaging, Interaction, and Measurement,
SPIE 7864, 2011; scale space after Lowe, Distinctive image features from scale-invariant keypoints, IJCV 60(2), 2004,
section 3. Differences from the papers: a voxel is the share of it that is solid instead of yes or no. It is computed in
the Fourier domain from the normals on the surface (the gradient of the solid), which needs no closed mesh and depends
little on the directions of the grid. An octave doubles sigma on one grid instead of halving the grid. The paper has
keypoints alone, so the map is these keypoints spread by their own sigma.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from haptic_glance.base.jit import cached_njit
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh

from .maxima import check_values
from .samples import area_vectors, subdivide

kernel = cached_njit()
VOXELS = 96  # across the ball around the surface's centroid: its bounding box would change as the mesh turns
PADDING = 16  # voxels around the box: the Fourier domain is periodic, and the widest Gaussian must not see its copy
SIGMA = 1.0  # voxels: finer scales would show the grid
INTERVALS = 3  # scales per octave (Lowe, section 3.2)
OCTAVES = 2  # keypoints of sigma 1.3 to 4 voxels, 1.3 to 4 % of the ball
CONTRAST = 0.06  # of a solid: beside a plane the difference of neighbouring scales is up to 0.055


@dataclass(frozen=True)
class Keypoints:
    """positions (k, 3) and sigmas (k,) in units of the mesh, responses (k,) as shares of a solid."""

    positions: np.ndarray
    sigmas: np.ndarray
    responses: np.ndarray


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8 in 0..1: the strongest keypoint at each vertex, which fades as exp(-distance^2 / (2 (2 sigma)^2)).

    It is at its full strength on the surface nearest to it. Zero on a plane and on a sphere, which have no keypoint.
    The map does not depend on the size of the mesh. A turned mesh meets the grid differently: keypoints move by up to a
    voxel, and weak ones may appear or vanish.
    """
    values = np.zeros(len(mesh.vertices))
    keypoints = _keypoints(mesh)
    if not len(keypoints.sigmas):
        return values
    tree = cKDTree(mesh.vertices)
    nearest = np.linalg.norm(mesh.vertices[_nearest(mesh, keypoints)] - keypoints.positions, axis=1)
    for position, sigma, response, least in zip(*vars(keypoints).values(), nearest, strict=True):
        near = np.array(tree.query_ball_point(position, least + 6 * sigma))
        squares = ((mesh.vertices[near] - position) ** 2).sum(axis=1) - least**2
        values[near] = np.maximum(values[near], response * np.exp(squares / (-8 * sigma**2)))
    values[(mesh.vertex_normals == 0).all(axis=1)] = 0
    return values / values.max()


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first, by saliency: the vertices nearest to the keypoints."""
    check_values(mesh, values)
    vertices = np.unique(_nearest(mesh, _keypoints(mesh)))
    return vertices[np.lexsort((*-mesh.vertices[vertices].T[::-1], -values[vertices]))]


def _nearest(mesh, keypoints):
    """(k,) i8: the vertex nearest to each keypoint; vertices in no face do not count."""
    if not len(keypoints.sigmas):
        return np.zeros(0, dtype=np.int64)
    vertex_ids = np.flatnonzero((mesh.vertex_normals != 0).any(axis=1))
    return vertex_ids[cKDTree(mesh.vertices[vertex_ids]).query(keypoints.positions)[1]]


@weak_cache
def _keypoints(mesh):
    """The extrema among 80 neighbours in space and scale, within 2 sigma of the surface: the others lie inside."""
    if not mesh.face_areas.any():
        return Keypoints(np.zeros((0, 3)), np.zeros(0), np.zeros(0))
    elements = subdivide(mesh, np.zeros((len(mesh.vertices), 0)))  # small triangles that make up the surface
    origin, step, dogs = _scale_space(elements)
    size = np.abs(dogs)
    peaks = np.unravel_index(scale_peaks(size, CONTRAST), size.shape)
    scale, *cell = peaks
    positions = origin + step * np.array(cell).T
    sigmas = SIGMA * 2 ** (scale / INTERVALS) * step
    near = cKDTree(elements.mean(axis=1)).query(positions)[0] <= 2 * sigmas
    return Keypoints(positions[near], sigmas[near], size[peaks][near].astype(np.float64))


def _scale_space(corners):
    """Of triangles (s, 3, 3): (position of voxel 0, size of a voxel, list of differences of Gaussians (a, b, c) f4)."""
    centre = np.average(corners.mean(axis=1), axis=0, weights=area_vectors(corners)[1])
    step = 2 * np.linalg.norm(corners - centre, axis=2).max() / VOXELS
    origin = corners.min(axis=(0, 1)) - PADDING * step
    shape = [fft.next_fast_len(int(n) + 2 * PADDING + 2, real=True) for n in np.ptp(corners, axis=(0, 1)) / step]
    inside = (corners - origin) / step
    field = splat(inside.mean(axis=1), area_vectors(inside)[0], tuple(shape)).astype(np.float32)
    axes = [fft.fftfreq(n) for n in shape[:2]] + [fft.rfftfreq(shape[2])]
    waves = [2 * np.pi * w.astype(np.float32) for w in np.meshgrid(*axes, indexing="ij", sparse=True)]
    square = np.asarray(sum(wave**2 for wave in waves))
    square[0, 0, 0] = 1  # the mean, which no difference has
    gradient = [1j * wave * np.asarray(fft.rfftn(part)) for wave, part in zip(waves, field, strict=True)]
    solid = np.asarray(sum(gradient)) / square
    sigmas = SIGMA * 2 ** (np.arange(OCTAVES * INTERVALS + 3) / INTERVALS)
    blurs = [np.exp(square * np.float32(-(sigma**2) / 2)) for sigma in sigmas]
    dogs = [np.asarray(fft.irfftn(solid * (b - a), shape)) for a, b in zip(blurs, blurs[1:], strict=False)]
    return origin, step, dogs


@kernel
def scale_peaks(values: np.ndarray, floor: float) -> np.ndarray:
    """(k,) i8 flat ids, in order, of values (scales, a, b, c) above `floor` that no neighbour of 80 exceeds.

    The first and the last scale have none. At the border of the grid there are fewer neighbours.
    """
    scales, a, b, c = values.shape
    peaks = []
    for s in range(1, scales - 1):
        for i in range(a):
            for j in range(b):
                for k in range(c):
                    value = values[s, i, j, k]
                    if value > floor and not _exceeded(values, value, s, i, j, k):
                        peaks.append(((s * a + i) * b + j) * c + k)
    return np.array(peaks, dtype=np.int64)


@kernel
def _exceeded(values, value, s, i, j, k):
    _, a, b, c = values.shape
    for scale in range(s - 1, s + 2):
        for x in range(max(i - 1, 0), min(i + 2, a)):
            for y in range(max(j - 1, 0), min(j + 2, b)):
                for z in range(max(k - 1, 0), min(k + 2, c)):
                    if values[scale, x, y, z] > value:
                        return True
    return False


@kernel
def splat(places: np.ndarray, values: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """(d, a, b, c) f8 sums of values (s, d) over the eight grid points nearest to each of places (s, 3), by nearness.

    places are in steps of the grid; all of these grid points must lie in its shape (a, b, c).
    """
    field = np.zeros((values.shape[1], *shape))
    for i in range(len(places)):
        x, y, z = np.floor(places[i]).astype(np.int64)
        for a in range(2):
            for b in range(2):
                for c in range(2):
                    near = abs(1 - a - (places[i, 0] - x))
                    near *= abs(1 - b - (places[i, 1] - y))
                    near *= abs(1 - c - (places[i, 2] - z))
                    for column in range(values.shape[1]):
                        field[column, x + a, y + b, z + c] += near * values[i, column]
    return field

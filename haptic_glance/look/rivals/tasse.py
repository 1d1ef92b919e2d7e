"""Cluster-based saliency: clusters of the surface unlike the others and in one place (Tasse, Kosinka, Dodgson 2015).

F. P. Tasse, J. Kosinka, N. A. Dodgson: Cluster-based point set saliency, ICCV 2015. The vertices, with fast point
feature histograms (FPFH) as descriptors, are parted into fuzzy clusters. Cluster j has the mean descriptor f_j, the
centre c_j and the weight w_j:

    uniqueness    U_j = sum_k w_k chi2(f_j, f_k) a_jk / sum_k a_jk, a_jk = 1 / (1 + |c_j - c_k|^2)
    distribution  D_j = sum_k w_k |c_k - m_j|^2 b_jk / sum_k b_jk, b_jk = exp(-chi2(f_j, f_k) / variance), m_j = sum_k
                  b_jk c_k / sum_k b_jk: low where clusters like it lie in one place
    saliency      S_j = (1 - exp(-U_j) + exp(-D_j)) / 2, both scaled to 0..1 before

A vertex has the mean of S_j over its clusters, by their probabilities. Numbers are those of the authors' program. Our
choices: lengths are in sizes of the object; clusters start at vertices far apart instead of at voxels; a vertex may
belong to the NEAREST clusters instead of those within three steps. The paper's keypoints are local maxima.
"""

import math

import numpy as np
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from haptic_glance.base.jit import cached_njit
from haptic_glance.mesh.mesh import Mesh

from ..weights.svm import select_far_points
from .maxima import high_maxima
from .samples import unit_mesh

kernel = cached_njit()
BINS = 11  # per angle of a descriptor; an odd number, so that a plane lies in the middle of one
RADIUS = 0.01  # of the size: the neighbourhood of a vertex
GROWTH, FEWEST = 1.1, 6  # it grows by this until a vertex has so many neighbours on average
WIDER = 1.2  # the neighbourhood of a descriptor over that
CLUSTERS = 500
TINY = 1e-30  # two empty bins differ by nothing
ROUNDS = 5  # of clustering; our choice
NEAREST = 27  # clusters that a vertex may belong to; some so many lie within three steps
ALIKE = 5.0  # weight of the descriptors beside that of the places
FLOOR = 1e-3  # variance of the clusters' descriptors: a sphere and a plane have less, and are not salient


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8 in 0..1: the saliency of the clusters of each vertex, whatever the size and the pose of the mesh.

    Zero on a sphere, on a plane and in no face.
    """
    unit = unit_mesh(mesh)
    if unit is None:
        return np.zeros(len(mesh.vertices))
    places = unit.mesh.vertices
    described = _descriptors(places, unit.mesh.vertex_normals)
    near, owner = _cluster(places, described)
    centres, means = _means(places, owner), _means(described, owner)
    variance, spread = _variance(means, chi_squares), _variance(centres, squares)
    if variance < FLOOR:
        return np.zeros(len(mesh.vertices))
    distances = _to_each(squares, places, centres, near) / spread
    fit = np.exp(-(distances + ALIKE * _to_each(chi_squares, described, means, near) / variance) / 2)
    weights = np.bincount(near.ravel(), fit.ravel(), len(centres))
    fit /= weights[near]
    values = _cluster_saliency(centres, means, weights / weights.sum(), variance)
    return unit.to_vertices(_stretched((fit * values[near]).sum(axis=1) / fit.sum(axis=1)))


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: the local maxima of saliency above the mean of all of them."""
    return high_maxima(mesh, values)


def squares(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Squared distances of vectors along the last axis."""
    return ((a - b) ** 2).sum(axis=-1)


def chi_squares(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Chi-squared distances sum (a - b)^2 / (a + b) of histograms along the last axis."""
    return ((a - b) ** 2 / (a + b + TINY)).sum(axis=-1)


def _descriptors(places, normals):
    """(n, 33) fast point feature histograms of the vertices."""
    tree, radius = cKDTree(places), RADIUS
    while tree.count_neighbors(tree, radius) < (1 + min(FEWEST, len(places) - 1)) * len(places):
        radius *= GROWTH
    near = tree.query_ball_point(places, WIDER * radius)
    starts = np.cumsum([0, *map(len, near)])
    return fpfh(places, normals, np.concatenate([np.sort(ids) for ids in near]).astype(np.int64), starts)


def _cluster(places, described):
    """(near (n, k) the clusters next to each vertex, owner (n,) its own by place and descriptor)."""
    order = np.argsort(-np.linalg.norm(places, axis=1).round(9), kind="stable")
    seeds = np.sort(order[select_far_points(places[order], CLUSTERS)])
    centres, means = places[seeds], described[seeds]
    variance, spread = _variance(means, chi_squares), _variance(centres, squares)
    for _ in range(ROUNDS):
        near = _nearest(centres, places)
        distances = _to_each(squares, places, centres, near) / spread
        distances += ALIKE * _to_each(chi_squares, described, means, near) / max(variance, FLOOR)
        owner = np.unique(near[np.arange(len(places)), distances.argmin(axis=1)], return_inverse=True)[1]
        centres, means = _means(places, owner), _means(described, owner)
    return _nearest(centres, places), owner


def _nearest(centres, places):
    """(n, k) the clusters whose centres are nearest to each place."""
    return cKDTree(centres).query(places, np.arange(1, 1 + min(NEAREST, len(centres))))[1]


def _to_each(squared, values, means, near):
    """(n, k) squared distances of values (n, d) to the means of the clusters near each."""
    return np.stack([squared(values, means[ids]) for ids in near.T], axis=1)


def _cluster_saliency(centres, means, weights, variance):
    """(k,) in 0..1: how unique and how compact each cluster is."""
    unlike = np.stack([chi_squares(mean, means) for mean in means])
    square_distances = squares(centres[:, None], centres)
    close = 1 / (1 + square_distances)
    unique = (close * unlike) @ weights / close.sum(axis=1)
    similarity = np.exp(-unlike / variance)
    middle = similarity @ centres / similarity.sum(axis=1)[:, None]
    spread = (similarity * squares(middle[:, None], centres)) @ weights / similarity.sum(axis=1)
    return _stretched(1 - np.exp(-_stretched(unique)) + np.exp(-_stretched(spread)))


def _means(values, owner):
    """(k, d) mean of the values (n, d) of each cluster."""
    sums = np.stack([np.bincount(owner, column) for column in values.T], axis=1)
    return sums / np.bincount(owner)[:, None]


def _variance(values, squared):
    """Mean squared distance of values (k, d) from their mean."""
    return float(squared(values, values.mean(axis=0)).mean())


def _stretched(values):
    """Values (n,) from 0 to 1; zero where all are equal."""
    return (values - values.min()) / (np.ptp(values) or 1)


@kernel
def fpfh(positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(n, 33) histograms of three angles, each of sum one, of positions (n, 3) with unit normals (n, 3).

    neighbours: of point i, those at starts[i] to starts[i + 1], which may hold i. A point without neighbours, or with a
    zero normal, has zeros. Source: Rusu, Blodow, Beetz, Fast point feature histograms (FPFH) for 3D registration, ICRA
    2009, with the weights 1 / distance^2 of the Point Cloud Library, which do not depend on the unit of length.
    """
    spfh, result = np.zeros((len(positions), 3 * BINS)), np.zeros((len(positions), 3 * BINS))
    for i in range(len(positions)):
        for j in neighbours[starts[i] : starts[i + 1]]:
            _count(spfh[i], positions[j] - positions[i], normals[i], normals[j])
        _normalise(spfh[i])
    for i in range(len(positions)):
        for j in neighbours[starts[i] : starts[i + 1]]:
            line = positions[j] - positions[i]
            square = _dot(line, line)
            if square > 0:
                result[i] += spfh[j] / square
        _normalise(result[i])
        result[i] += spfh[i]
        _normalise(result[i])
    return result


@kernel
def _count(histogram, line, first, second):
    """Adds the three angles of a pair of normals to a histogram; the pair's frame is of the one nearer to the line."""
    length = math.sqrt(_dot(line, line))
    if length == 0:
        return
    line = line / length
    source, target, along = first, second, _dot(first, line)
    if abs(_dot(second, line)) > abs(along):
        source, target, line, along = second, first, -line, -_dot(second, line)
    v = _cross(line, source)
    size = math.sqrt(_dot(v, v))
    if size < 1e-9 or not _dot(target, target) > 0:
        return
    turn = math.atan2(_dot(_cross(source, v), target) / size, _dot(source, target))
    for k, share in enumerate((turn / math.pi, _dot(v, target) / size, along)):
        histogram[k * BINS + min(max(int((share + 1) / 2 * BINS), 0), BINS - 1)] += 1


@kernel
def _normalise(histogram):
    """Gives each of the three histograms the sum one, in place, where it holds anything."""
    for k in range(0, 3 * BINS, BINS):
        total = histogram[k : k + BINS].sum()
        if total > 0:
            histogram[k : k + BINS] /= total


@kernel
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]

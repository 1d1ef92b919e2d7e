"""Spectral saliency: where the spectrum of the mesh Laplacian is irregular (Song, Liu, Martin, Rosin 2014).

R. Song, Y. Liu, R. R. Martin, P. L. Rosin: Mesh saliency via spectral processing, ACM Transactions on Graphics 33(1),
2014. W_ij = 1 / |v_i - v_j|^2 on the edges, L = D - W = B diag(lambda) B^T with D the row sums of W:

    irregularity  R(f) = |log lambda_f - mean of log lambda over the NEIGHBOURS eigenvalues around f|
    saliency      S_i = sum over j of (B diag(exp R) B^T)_ij W_ij
    over scales   sum over t of |log |S(2 t)| - log |S(t)||, S(t) of the mesh smoothed by a variance of t EPSILON^2

Scales and numbers are those of public programs after the paper. Our choices: SAMPLES vertices far apart instead of a
simplified mesh, smoothed with the whole mesh before, by heat, which is a Gaussian along the surface; 2 instead of a
factor near 2 that differs between vertices; differences of logarithms, where such a program takes the logarithm of the
sum; zero eigenvalues, one of each part, are regular; equal eigenvalues share the mean of R, so that S does not depend
on the basis; |S| counts as at least LEAST of its median, since its logarithm has spikes where S changes sign. The map
is smoothed over the spacing of the samples. The paper selects no points.
"""

import numpy as np
from scipy import linalg, sparse
from scipy.ndimage import uniform_filter1d

from haptic_glance.mesh.mesh import Mesh

from ..channels.surface import smoother
from .maxima import high_maxima
from .samples import samples, unit_mesh

SAMPLES = 1000  # the time of the decomposition grows with the cube
EPSILON = 0.002  # of the size
SCALES = (1, 2, 3, 4, 5)  # variances, in EPSILON^2
NEIGHBOURS = 9  # eigenvalues of the local average
LEAST = 0.1
EQUAL = 1e-7  # of an eigenvalue, to the next: they are one
ZERO = 1e-9  # of the largest eigenvalue


def saliency(mesh: Mesh) -> np.ndarray:
    """(n,) f8, at least 0: how much the spectral saliency of each vertex changes over the scales; zero in no face.

    It does not depend on the size and the pose of the mesh, and is nearly even on a ball.
    """
    unit = unit_mesh(mesh)
    if unit is None:
        return np.zeros(len(mesh.vertices))
    sample_set, everywhere, logs = samples(unit.mesh, SAMPLES), np.ones(len(unit.mesh.vertices)), {}
    for variance in sorted({factor * scale for scale in SCALES for factor in (1, 2)}):
        length = EPSILON * np.sqrt(variance / 2)  # heat that reaches so far has spread by a Gaussian of this variance
        smooth = smoother(unit.mesh, everywhere, length)(unit.mesh.vertices)
        values = np.abs(spectral_saliency(smooth[sample_set.ids], sample_set.graph))
        logs[variance] = np.log(np.maximum(values, LEAST * np.median(values) or 1))
    change = np.sum([np.abs(logs[2 * scale] - logs[scale]) for scale in SCALES], axis=0)
    return unit.to_vertices(sample_set.spread(unit.mesh, change).clip(0))


def points(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(k,) i8 vertex ids, most salient first: the local maxima of saliency above the mean of all of them."""
    return high_maxima(mesh, values)


def spectral_saliency(positions: np.ndarray, graph: sparse.csr_matrix) -> np.ndarray:
    """(k,) S of positions (k, 3) joined by a graph (k, k)."""
    tails, heads = graph.nonzero()
    weights = np.zeros((len(positions), len(positions)))
    weights[tails, heads] = 1 / np.maximum(((positions[tails] - positions[heads]) ** 2).sum(axis=1), ZERO**2)
    values, functions = linalg.eigh(np.diag(weights.sum(axis=1)) - weights, driver="evd")
    rough = np.exp(irregularity(values))
    return (((functions * rough) @ functions.T) * weights).sum(axis=1)


def irregularity(values: np.ndarray) -> np.ndarray:
    """(k,) R of ascending eigenvalues (k,); zero where they are zero."""
    result = np.zeros(len(values))
    above = values > ZERO * values[-1]
    if above.any():
        logs = np.log(values[above])
        rough = np.abs(logs - uniform_filter1d(logs, NEIGHBOURS, mode="nearest"))
        group = np.cumsum(np.diff(logs, prepend=logs[0]) > EQUAL)
        result[above] = (np.bincount(group, rough) / np.bincount(group))[group]
    return result

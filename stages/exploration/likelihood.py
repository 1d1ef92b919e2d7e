"""How likely an imprint is under each object: a kernel density over the touches known from training."""

import numpy as np

FEATURE_WIDTH = 0.6  # of twelve standardised components; 0.3 to 1 give the same single-touch likelihood within 6 %
PLACE_WIDTH = 0.05  # units: a third of the array, within which neighbouring touches feel alike
FLOOR = 1e-30  # of a density that rounds to nothing


def feature_kernel(first, second):
    """(k, n): how alike the components (k, d) and (n, d) are, exp(-distance / width).

    Exponential rather than normal: a touch unlike all known ones then does not decide everything (by the likelihood of
    single held-out touches the better of the two, and better than naive Bayes and linear discriminants).
    """
    return np.exp(-_gaps(first, second) / FEATURE_WIDTH)


def place_kernel(first, second):
    """(k, n): how near the places (k, 3) and (n, 3) are to each other, exp(-distance / width)."""
    return np.exp(-_gaps(first, second) / PLACE_WIDTH)


def log_likelihood(kernel, truth, counts=None):
    """(..., k, classes) log density of touches under each object, up to one constant.

    kernel (..., k, n): of the touches with the known ones, products of `feature_kernel` and, where the place counts,
    `place_kernel`; 0 where a known touch must not count. truth (n,): whose the known touches are. counts (k, classes):
    how many known touches of each object count; all by default.
    """
    belongs = np.eye(int(truth.max()) + 1)[truth]
    counts = np.maximum(belongs.sum(axis=0) if counts is None else counts, 1)
    return np.log(np.maximum(kernel @ belongs / counts, FLOOR))


def _gaps(first, second):
    """(k, n) Euclidean distances."""
    squares = (first**2).sum(axis=1)[:, None] + (second**2).sum(axis=1)[None] - 2 * first @ second.T
    return np.sqrt(np.maximum(squares, 0))

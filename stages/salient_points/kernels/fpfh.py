"""Fast point feature histograms: how the normals around a point lie to each other."""

import math

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)

BINS = 11  # per angle; an odd number, so that a plane lies in the middle of one


@kernel
def fpfh(positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(n, 33) histograms of three angles, each of sum one, of positions (n, 3) with unit normals (n, 3).

    neighbours: of point i, those at starts[i] to starts[i + 1], which may hold i. A point without neighbours, or with a
    zero normal, has zeros. Source: Rusu, Blodow, Beetz, Fast point feature histograms (FPFH) for 3D registration, ICRA
    2009, with the weights 1 / distance^2 of the Point Cloud Library, which do not depend on the unit of length.
    """
    own, result = np.zeros((len(positions), 3 * BINS)), np.zeros((len(positions), 3 * BINS))
    for i in range(len(positions)):
        for j in neighbours[starts[i] : starts[i + 1]]:
            _count(own[i], positions[j] - positions[i], normals[i], normals[j])
        _normalise(own[i])
    for i in range(len(positions)):
        for j in neighbours[starts[i] : starts[i + 1]]:
            line = positions[j] - positions[i]
            square = _dot(line, line)
            if square > 0:
                result[i] += own[j] / square
        _normalise(result[i])
        result[i] += own[i]
        _normalise(result[i])
    return result


@kernel
def _count(histogram, line, one, other):
    """Adds the three angles of a pair of normals to a histogram; the pair's frame is of the one nearer to the line."""
    length = math.sqrt(_dot(line, line))
    if length == 0:
        return
    line = line / length
    source, target, along = one, other, _dot(one, line)
    if abs(_dot(other, line)) > abs(along):
        source, target, line, along = other, one, -line, -_dot(other, line)
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

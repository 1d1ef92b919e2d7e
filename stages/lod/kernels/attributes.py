"""Attributes within the quadric error: the disagreement of the faces around a vertex on what it shows (Hoppe 1999).

Each face predicts an attribute anywhere in space, as a gradient and a constant: g.x + d. At a merged vertex the best
single value is the mean of the predictions, and their squared distances to it are the error. It is quadratic in x, and
zero where the attribute is linear over the surface.

A seam splits the faces around a vertex into wedges, each with a value of its own; edges of a seam collapse wedge by
wedge (section 4.2 there).
"""

from typing import NamedTuple

import numpy as np

from .corners import after
from .jit import Id, helper
from .quadrics import best_place, error_at


class Wedges(NamedTuple):
    """The wedges of a surface, whose quadrics hold the predictions' squares; here are those of their means."""

    wedge: np.ndarray  # (3 m,) i4: that of each corner
    merged: np.ndarray  # (w + 1,) i4: the wedge into which each was merged; the last one is none and stays empty
    following: np.ndarray  # (w + 1,) i4: the next wedge of the same vertex, in a ring
    sums: np.ndarray  # (w + 1, 1 + 4 k): of the areas of the faces, and of g and d times them for each attribute
    error: np.ndarray  # (2, 10) scratch: the quadric that is left, and zeros
    ends: np.ndarray  # (2, 3) scratch


@helper
def attribute_cost(
    opposite: np.ndarray, position: np.ndarray, quadric: np.ndarray, wedges: Wedges, h: Id, i: Id, j: Id, held: Id
) -> tuple[float, float, float, float]:
    """(error, x, y, z) of a collapse of half-edge h from i to j: at vertex `held`, or if -1 at the best place."""
    wedge, merged, following, sums, error, ends = wedges
    for n in range(10):
        error[0, n] = quadric[i, n] + quadric[j, n]
    for n in range(3):
        ends[0, n], ends[1, n] = position[i, n], position[j, n]
    a, b, c, d = _pairs(opposite, wedge, merged, h)
    nobody = np.int64(len(merged) - 1)
    for first in (a, b):
        w = np.int64(first)
        while True:
            if w != a and w != b and w != c and w != d:
                _take_mean(error, sums, w, nobody, nobody)
            w = np.int64(following[w])
            if w == first:
                break
    if a == c or b == d:
        _take_mean(error, sums, a, b, nobody if a == c and b == d else c if b == d else d)
    else:
        _take_mean(error, sums, a, b, nobody)
        _take_mean(error, sums, c, d, nobody)
    if held >= 0:
        x, y, z = position[held, 0], position[held, 1], position[held, 2]
        return error_at(error, 0, 1, x, y, z), x, y, z
    return best_place(error, ends, 0, 1)


@helper
def _pairs(opposite, wedge, merged, h):
    """The wedges at the two ends of half-edge h in its own face, then in the face across."""
    t = opposite[h]
    a, b = _root(merged, wedge[h]), _root(merged, wedge[after(h)])
    return a, b, _root(merged, wedge[after(t)]), _root(merged, wedge[t])


@helper
def _root(merged, w):
    while merged[w] != w:
        merged[w] = merged[merged[w]]  # halves the path for later calls
        w = merged[w]
    return np.int64(w)


@helper
def _take_mean(error, sums, a, b, c):
    """Takes the square of the mean prediction of wedges a, b, c, times their area, off the sum of the squares."""
    area = sums[a, 0] + sums[b, 0] + sums[c, 0]
    if area == 0.0:
        return
    for n in range(1, sums.shape[1], 4):
        x = sums[a, n] + sums[b, n] + sums[c, n]
        y = sums[a, n + 1] + sums[b, n + 1] + sums[c, n + 1]
        z = sums[a, n + 2] + sums[b, n + 2] + sums[c, n + 2]
        d = sums[a, n + 3] + sums[b, n + 3] + sums[c, n + 3]
        error[0, 0] -= x * x / area
        error[0, 1] -= x * y / area
        error[0, 2] -= x * z / area
        error[0, 3] -= y * y / area
        error[0, 4] -= y * z / area
        error[0, 5] -= z * z / area
        error[0, 6] -= x * d / area
        error[0, 7] -= y * d / area
        error[0, 8] -= z * d / area
        error[0, 9] -= d * d / area


@helper
def merge_wedges(opposite: np.ndarray, wedges: Wedges, h: Id) -> None:
    """Merges the wedges at the ends of half-edge h, which is about to collapse, on both of its sides."""
    a, b, c, d = _pairs(opposite, wedges.wedge, wedges.merged, h)
    following = wedges.following
    following[a], following[b] = following[b], following[a]  # one ring of two
    _merge(wedges, a, b)
    c, d = _root(wedges.merged, c), _root(wedges.merged, d)
    if c != d:
        _merge(wedges, c, d)


@helper
def _merge(wedges, stays, goes):
    """Merges a wedge into another one of the same ring."""
    before = goes
    while wedges.following[before] != goes:
        before = np.int64(wedges.following[before])
    wedges.following[before] = wedges.following[goes]
    wedges.merged[goes] = stays
    for n in range(wedges.sums.shape[1]):
        wedges.sums[stays, n] += wedges.sums[goes, n]

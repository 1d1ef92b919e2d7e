"""How much of what was found is found again: repeatability, drift, breaking point."""

import numpy as np
from scipy.spatial import cKDTree

from stages.salient_points.chance import random_vertices
from stages.weights.features import standardise

REACH = 0.02  # of the diagonal: a point found again lies within this
BROKEN = 0.5  # of the points; below it a method finds more other points than the same
DRAWS = 10  # of random points, whose mean is the level of chance


def repeatability(before, after, reach):
    """The share of the points of both sets that have one of the other set within reach, 0..1.

    before (k, 3) and after (k', 3) in one frame and unit. 1 for equal sets, 0 when one of them is empty, NaN when both
    are. Source: Schmid, Mohr and Bauckhage, Evaluation of interest point detectors, IJCV 37(2), 2000, made
    symmetric, so that neither many nor few points pay. Raises ValueError for a negative reach.
    """
    if not reach >= 0:
        raise ValueError(f"reach must not be negative, got {reach}")
    before, after = (np.asarray(points, dtype=np.float64).reshape(-1, 3) for points in (before, after))
    if len(before) == 0 and len(after) == 0:
        return np.nan
    if len(before) == 0 or len(after) == 0:
        return 0.0
    found = (cKDTree(after).query(before)[0] <= reach).sum() + (cKDTree(before).query(after)[0] <= reach).sum()
    return float(found / (len(before) + len(after)))


def chance_repeatability(before, perturbed, count, generator, reach):
    """What `count` vertices drawn by area from a Perturbed would reach against `before`: the mean of DRAWS."""
    drawn = [perturbed.places[random_vertices(perturbed.mesh, count, generator)] for _ in range(DRAWS)]
    return float(np.mean([repeatability(before, points, reach) for points in drawn]))


def carried_back(mesh, perturbed, saliency):
    """Saliency on the vertices of a Perturbed, read at the vertices of the original mesh: (n,).

    From the nearest vertex by place, since decimation and remeshing change the ids. Vertices in no face have no say.
    """
    used = np.unique(perturbed.mesh.faces)
    return saliency[used[cKDTree(perturbed.places[used]).query(mesh.vertices)[1]]]


def drift(before, after, areas):
    """One minus Pearson's correlation of two maps (n,) on one surface, each vertex weighing its area: 0..2.

    0 for maps that are equal up to scale, 1 for unrelated ones. A constant map says nothing: beside another constant
    the drift is 0, beside anything else 1.
    """
    one, other = standardise(before, areas), standardise(after, areas)
    if not one.any() and not other.any():
        return 0.0
    return float(max(1 - (areas * one * other).sum() / areas.sum(), 0.0))  # rounding may pass beyond equal


def breaking_point(severities, values, unharmed):
    """The mildest severity at which the repeatability falls below BROKEN, interpolated; NaN if it never does.

    severities (s,) from mild to harsh, in either direction; values (s,); at `unharmed` the value is one.
    """
    severities, values = [unharmed, *severities], [1.0, *values]
    for k in range(1, len(values)):
        if values[k] < BROKEN:
            share = (values[k - 1] - BROKEN) / (values[k - 1] - values[k])
            return float(severities[k - 1] + share * (severities[k] - severities[k - 1]))
    return np.nan

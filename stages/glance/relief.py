"""Bumps, dents and thickness of a surface at several scales, from a graph of neighbouring points."""

import numpy as np
from scipy.spatial import KDTree

from .samples import Samples, nearest

FINE, COARSE = 2, 6  # steps over the graph of the finest relief, and of a coarser one
BLENDED = 4  # centres whose counts are interpolated
AROUND = 18  # steps over which relief is averaged: how rich in relief the neighbourhood is
COUNTED, CENTRES = 7500, 3750  # about as many points are counted around about as many


def relief(samples: Samples) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(convexity, detail, relief around) of each point, each (s,).

    Convexity: how far a point stands out of the mean of its neighbours along its normal, over their distance (the mean
    curvature times a length). Detail: how much this differs between two scales (centre and surround, as in Lee 2005).
    """
    mean, stands_out = samples.points, {}
    for step in range(1, COARSE + 1):
        mean = samples.average @ mean
        if step in (FINE, COARSE):
            out = np.einsum("ij,ij->i", samples.normals, samples.points - mean)
            stands_out[step] = out / (np.sqrt(step) * samples.spacing)
    around = np.abs(stands_out[COARSE])
    for _ in range(AROUND):
        around = samples.average @ around
    return stands_out[FINE], np.abs(stands_out[FINE] - stands_out[COARSE]), around


def fullness(samples: Samples, radius: float) -> np.ndarray:
    """(s,) log of the surface within a radius of each point over that of a disc of the size of the object.

    High where a part is thin or folded, low at a tip: an integral invariant, which noise does not move (Pottmann et
    al., Integral invariants for robust geometry processing, CAGD 2009).
    """
    counted, centres = (samples.points[:: max(len(samples.points) // count, 1)] for count in (COUNTED, CENTRES))
    found = KDTree(counted).query_ball_point(centres, radius, return_length=True)
    share = np.asarray(found) / len(counted) * np.ptp(samples.points, axis=0).max() ** 2 / radius**2
    distance, near = nearest(KDTree(centres), samples.points, BLENDED)
    weight = 1 / (distance + 1e-3 * radius) ** 2
    return (np.log(np.maximum(share, 1e-6))[near] * weight).sum(axis=1) / weight.sum(axis=1)

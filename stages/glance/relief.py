"""Bumps, dents and thickness of a surface at several scales, from a graph of neighbouring points."""

import numpy as np
from scipy import ndimage

from .samples import Samples

FINE, COARSE = 1, 6  # steps over the graph of the finest relief, and of a coarser one
AROUND = 18  # steps over which relief is averaged: how rich in relief the neighbourhood is
VOXELS = 48  # in a unit of length, in which the surface around a point is counted
CUT = 3.0  # deviations at which the Gaussian of that count ends


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
    """(s,) log of the share of the surface around each point over that of a disc of the size of the object.

    The surface is weighted by a Gaussian with the second moment of a ball of this radius. High where a part is thin or
    folded, low at a tip: an integral invariant, which noise does not move (Pottmann et al., Integral invariants for
    robust geometry processing, CAGD 2009).
    """
    deviation = radius / np.sqrt(5)
    reach = np.ceil(np.abs(samples.local).max(axis=0) * VOXELS).astype(np.int64)
    places, shape = samples.local * VOXELS + reach, 2 * reach + 1
    voxels = np.ravel_multi_index(np.rint(places).astype(np.int64).T, shape)
    amounts = np.bincount(voxels, samples.shares, minlength=shape.prod()).reshape(shape).astype(np.float32)
    around = ndimage.gaussian_filter(amounts, deviation * VOXELS, mode="constant", truncate=CUT)
    found = ndimage.map_coordinates(around, places.T, order=1) * (np.sqrt(2 * np.pi) * deviation * VOXELS) ** 3
    return np.log(np.maximum(found / radius**2, 1e-6))

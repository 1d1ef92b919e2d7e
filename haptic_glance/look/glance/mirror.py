"""The upright planes in which a surface is symmetric: people look along them."""

import numpy as np
from scipy import ndimage

from .samples import Samples

TURNS, RADII, HEIGHTS = 120, 12, 24  # bins around the axis, across it and along it
BLUR = 1.0  # deviation of the Gaussian over the bins
EQUAL = 0.1  # lack of correlation at which a plane counts 1 / e as much as a perfect one
LEAST = 0.1  # of the share of the best plane, below which one is left out
NARROW = 0.05  # distance from the plane, in units of the size, at which its effect has fallen to 1 / e
WALL, DIGITS = 1e-9, 12  # radians from a wall between two bins of turn, and digits of a length: less is rounding


def symmetry(samples: Samples) -> tuple[np.ndarray, np.ndarray]:
    """(distance from the mirror plane, nearness to it) of each point, each (s,), both 0 without a symmetry.

    The planes go through the z axis of the points' mean. A plane counts by how well the surface, in bins of turn,
    radius and height, correlates with its mirror image; the correlations at all planes are one Fourier transform. Both
    values are means over the planes, times how much better these fit than a plane does on average, so that a body of
    revolution, which has no plane of its own, has 0.
    """
    x, y, z = samples.local.T
    amounts = _amounts(np.arctan2(y, x), np.hypot(x, y).round(DIGITS), z.round(DIGITS), samples.shares)
    amounts = ndimage.gaussian_filter(ndimage.gaussian_filter1d(amounts, BLUR, axis=0, mode="wrap"), (0, BLUR, BLUR))
    waves = np.fft.rfft(amounts, axis=0)
    correlation = np.fft.irfft((waves**2).sum(axis=(1, 2)), TURNS) / (amounts**2).sum()
    fits = np.exp((correlation - 1) / EQUAL)
    share = fits / fits.sum()
    score = max(float(share @ fits - fits.mean()), 0.0)
    peaks = np.flatnonzero(share > LEAST * share.max())
    angles = np.pi * (peaks + 1) / TURNS - np.pi  # bin k of one image lies over bin j of the other: half of their sum
    distances = np.abs(np.outer(x, np.sin(angles)) - np.outer(y, np.cos(angles)))
    share = share[peaks] / share[peaks].sum()
    return score * (distances @ share), score * (np.exp(-((distances / NARROW) ** 2)) @ share)


def _amounts(turn, radius, z, shares):
    """(TURNS, RADII, HEIGHTS) the share of the surface in each bin.

    A point on the wall between two bins of turn counts half in both. Rounding would put it into either, and a symmetric
    surface would no longer be its own mirror image.
    """
    bins, amounts = (TURNS, RADII, HEIGHTS), np.zeros((TURNS, RADII, HEIGHTS))
    ranges = (-np.pi, np.pi), (0, max(radius.max(), 1e-9)), (z.min() - 1e-9, z.max() + 1e-9)
    for side in (-WALL, WALL):
        places = np.stack([(turn + side + np.pi) % (2 * np.pi) - np.pi, radius, z], axis=1)
        amounts += np.histogramdd(places, bins, ranges, weights=shares / 2)[0]
    return amounts

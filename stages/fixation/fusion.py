"""Fuses the maps of several tasks: EWIGC and EWIGC_L4 (T eq. 3.24, 3.25), and subtractive clustering.

Clustering: Chiu 1994, T [243].
"""

import numpy as np
from skimage.filters import threshold_multiotsu

GREYS = 256  # grey levels of an image, as for Matlab's entropy
BINS = 64  # of the histogram for the thresholds: they move by a hundredth, and take a thirtieth of the time of 256
LEVELS = 4


def entropy(picture: np.ndarray) -> float:
    """The entropy of a map (h, w) in 0..1 as an image of 256 greys, in bits, 0 to 8; 0 for a constant one."""
    greys = np.bincount(np.rint(np.asarray(picture) * (GREYS - 1)).astype(np.int64).ravel(), minlength=GREYS)
    shares = greys[greys > 0] / greys.sum()
    return float(-(shares * np.log2(shares)).sum()) + 0.0  # + 0.0: no -0.0


def fuse(pictures: np.ndarray) -> np.ndarray:
    """(h, w): the mean of maps (t, h, w) in 0..1, weighted by their entropy (T eq. 3.24).

    A constant map has no entropy and no weight. Zero where all maps are constant.
    Raises ValueError for values outside 0..1.
    """
    pictures = _checked(pictures)
    weights = np.array([entropy(picture) for picture in pictures])
    if not weights.any():
        return np.zeros(pictures.shape[1:])
    return np.tensordot(weights / weights.sum(), pictures, 1)


def highest_level(pictures: np.ndarray) -> np.ndarray:
    """Maps (t, h, w) in 0..1 with all values below the highest of four levels set to zero (T3.3.4, Otsu, T [242]).

    A map with fewer than four values stays unchanged.
    """
    return np.stack([_highest_level(picture) for picture in _checked(pictures)])


def _highest_level(picture):
    binned = np.rint(picture * (BINS - 1)).astype(np.uint8)
    if (np.bincount(binned.ravel()) > 0).sum() < LEVELS:
        return picture
    # The binned image has exactly the bins that are searched, whatever its lowest and highest value.
    highest = threshold_multiotsu(binned, LEVELS)[-1]
    return np.where(binned > highest, picture, 0)


def _checked(pictures):
    pictures = np.asarray(pictures, dtype=np.float64)
    if pictures.ndim != 3 or not len(pictures):
        raise ValueError(f"pictures must have shape (t, h, w), at least one, got {pictures.shape}")
    if not ((pictures >= 0) & (pictures <= 1)).all():
        raise ValueError("pictures must hold values in 0..1, and no NaN: divide each by its maximum")
    return pictures


SQUASH = 1.25  # radius within which a centre takes away potential, over the radius of influence; Matlab's subclust
ACCEPT, REJECT = 0.5, 0.15  # of the first centre's potential; Chiu 1994
BLOCK = 1000  # points whose distances to all others are computed at once


def subtractive_clusters(points: np.ndarray, radius: float = 0.5) -> np.ndarray:
    """(c,) i8: which of points (k, d) are centres of clusters, the densest first.

    Chiu, Fuzzy model identification based on cluster estimation, Journal of Intelligent and Fuzzy Systems 2, 1994: the
    points are scaled to the unit hypercube, and the potential of each is the sum of exp(-4 d^2 / radius^2) over all.
    The point with the highest potential becomes a centre, and the potential of the points near it is reduced. This
    repeats until the highest potential is below REJECT of the first. Between REJECT and ACCEPT a point becomes a centre
    only if its distance to the other centres over the radius plus its share of the first potential is one or more.
    radius 0.5 and a squash factor of 1.25 (Chiu: 1.5) are the defaults of Matlab's subclust, which the thesis used. Of
    equal potentials the first point is taken. Raises ValueError for no points or values that are not finite.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or not len(points) or not np.isfinite(points).all():
        raise ValueError(f"points must be finite and of shape (k, d), at least one, got {points.shape}")
    if not radius > 0:
        raise ValueError(f"radius must be above 0, got {radius}")
    extent = np.ptp(points, axis=0)
    scaled = (points - points.min(axis=0)) / np.where(extent > 0, extent, 1)
    potential = np.concatenate(
        [_near(scaled[k : k + BLOCK], scaled, radius).sum(axis=1) for k in range(0, len(scaled), BLOCK)]
    )
    first, centres = potential.max(), []
    while True:
        best = int(potential.argmax())
        share = potential[best] / first
        if share <= REJECT:
            return np.array(centres, dtype=np.int64)
        gap = np.linalg.norm(scaled[centres] - scaled[best], axis=1).min(initial=np.inf)
        if share > ACCEPT or gap / radius + share >= 1:
            centres.append(best)
            potential = potential - potential[best] * _near(scaled[best : best + 1], scaled, SQUASH * radius)[0]
        potential[best] = 0


def _near(some, points, radius):
    squared = ((some[:, None] - points[None]) ** 2).sum(axis=2)
    return np.exp(-4 * squared / radius**2)

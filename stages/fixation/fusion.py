"""The fusion of the maps of several tasks: EWIGC and EWIGC_L4 (T eq. 3.24, 3.25)."""

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

"""Features of a contour: 19 series of imprint features and normals, their wavelets, three statistics (T4.4.9)."""

import numpy as np
import pywt
from numpy.typing import ArrayLike

from .contourlet import DIRECTIONS, directional_std

WAVELET, LEVELS = "db2", 3  # T4.4.9
MODE = "symmetric"  # at the ends of a series; the thesis names none, and this is the default of Matlab, which it used
STATISTICS = ("rms", "std", "skewness")
BANDS = (*(f"detail{level}" for level in range(1, LEVELS + 1)), "sequence")
CHANNELS = (*(f"direction{k}" for k in range(DIRECTIONS)), "normal_x", "normal_y", "normal_z")
FEATURES = tuple(f"{channel}.{band}.{name}" for channel in CHANNELS for band in BANDS for name in STATISTICS)
CONSTANT = 1e-6  # of the largest value of its series: a smaller standard deviation is rounding error


def series(images: ArrayLike, normals: ArrayLike) -> np.ndarray:
    """(n, frames, 19) f8: sixteen directional features of each imprint, then the array's normal (T4.4.9).

    images (n, frames, rows, cols) u1 0..255 or floats 0..1, normals (n, frames, 3).
    """
    images, normals = np.asarray(images), np.asarray(normals, dtype=np.float64)
    if images.ndim != 4 or normals.shape != (*images.shape[:2], 3):
        raise ValueError(
            f"images must have shape (n, frames, rows, cols), normals (n, frames, 3): {images.shape}, {normals.shape}"
        )
    count, frames, *cells = images.shape
    directions = directional_std(images.reshape(count * frames, *cells)).reshape(count, frames, DIRECTIONS)
    return np.concatenate([directions, normals], axis=2)


def sequence_features(values: ArrayLike) -> np.ndarray:
    """(n, 12 s) f8: root mean square, standard deviation and skewness of s series and of their wavelets.

    values: (n, frames, s). The statistics are taken of the series itself and of its detail coefficients in three levels
    of db2, level 1 the finest. The 19 series of `series` give 228 numbers, named by FEATURES. A constant series has
    skewness 0. Short series have three levels too, although their coefficients mostly depend on the ends.
    Raises ValueError for another shape, fewer than 2 frames, or NaN.
    """
    values = np.asarray(values, dtype=np.float64)
    if values.ndim != 3 or values.shape[1] < 2:
        raise ValueError(f"values must have shape (n, frames, s) with 2 frames or more, got {values.shape}")
    if not np.isfinite(values).all():
        raise ValueError("values hold NaN or infinite numbers")
    bands, approximation = [], values
    for _ in range(LEVELS):
        approximation, detail = pywt.dwt(approximation, WAVELET, mode=MODE, axis=1)
        bands.append(detail)
    least = CONSTANT * np.abs(values).max(axis=1)
    statistics = np.stack([_statistics(band, least) for band in (*bands, values)], axis=2)
    return statistics.reshape(len(values), np.prod(statistics.shape[1:]))


def _statistics(band, least):
    """(n, s, 3): the STATISTICS over the coefficients (n, k, s); least (n, s): the spread of a constant."""
    mean = band.mean(axis=1)
    deviations = band - mean[:, None]
    std = np.sqrt((deviations**2).mean(axis=1))
    varies = std > least
    skewness = np.divide((deviations**3).mean(axis=1), std**3, out=np.zeros_like(std), where=varies)
    return np.stack([np.sqrt((band**2).mean(axis=1)), np.where(varies, std, 0), skewness], axis=2)

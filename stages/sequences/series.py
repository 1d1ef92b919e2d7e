"""How the features of the imprints vary along a contour: 19 series, their wavelets, three statistics (T4.4.9)."""

import numpy as np
import pywt

from .contourlet import DIRECTIONS, directions

WAVELET, LEVELS = "db2", 3  # T4.4.9
MODE = "symmetric"  # at the ends of a series; the thesis is silent, and it is the default of the Matlab it used
STATISTICS = ("rms", "std", "skewness")
BANDS = (*(f"detail{level}" for level in range(1, LEVELS + 1)), "sequence")
CHANNELS = (*(f"direction{k}" for k in range(DIRECTIONS)), "normal_x", "normal_y", "normal_z")
FEATURES = tuple(f"{channel}.{band}.{name}" for channel in CHANNELS for band in BANDS for name in STATISTICS)
CONSTANT = 1e-9  # of the largest value of its series: a spread below it is rounding, and has no skewness


def series(images, normals):
    """(n, frames, 19) f8: sixteen directions of each imprint, then its normal (T4.4.9).

    images (n, frames, rows, cols) u1 0..255 or floats 0..1, normals (n, frames, 3).
    """
    images, normals = np.asarray(images), np.asarray(normals, dtype=np.float64)
    if images.ndim != 4 or normals.shape != (*images.shape[:2], 3):
        raise ValueError(
            f"images (n, frames, rows, cols) and normals (n, frames, 3) are wanted: {images.shape}, {normals.shape}"
        )
    count, frames, *cells = images.shape
    felt = directions(images.reshape(count * frames, *cells)).reshape(count, frames, DIRECTIONS)
    return np.concatenate([felt, normals], axis=2)


def sequence_features(values):
    """(n, 12 s) f8: root mean square, standard deviation and skewness of s series each, and of their wavelets.

    values: (n, frames, s). Of every series the detail coefficients of three levels of db2, level 1 the finest, and the
    series itself: for the 19 of `series` 228 numbers, named by FEATURES. A constant series has skewness 0. Three
    levels are taken of short series too; their coefficients then mostly tell of the ends.
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
    found = np.stack([_statistics(band, least) for band in (*bands, values)], axis=2)
    return found.reshape(len(values), np.prod(found.shape[1:]))


def _statistics(band, least):
    """(n, s, 3): the STATISTICS over the coefficients (n, k, s); least (n, s): the spread of a constant."""
    mean = band.mean(axis=1)
    apart = band - mean[:, None]
    std = np.sqrt((apart**2).mean(axis=1))
    varies = std > least
    skewness = np.divide((apart**3).mean(axis=1), std**3, out=np.zeros_like(std), where=varies)
    return np.stack([np.sqrt((band**2).mean(axis=1)), np.where(varies, std, 0), skewness], axis=2)

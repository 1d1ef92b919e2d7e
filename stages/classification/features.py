"""Forty-one features of an imprint: wavelet coefficients, brightness and centre of mass (T4.2.3.4)."""

import numpy as np
import pywt

WAVELET = "db2"  # T4.2.3.4 names none; T4.4.9 uses db2
LEVELS = 3
SMALLEST = 2**LEVELS  # rows and columns that can be halved three times
IMAGE = 5  # features of the imprint itself, the last ones
_STATISTICS = ("norm", "mean", "std", "entropy")
FEATURES = (
    *(f"{band}{level}_{name}" for level in range(1, LEVELS + 1) for band in "hvd" for name in _STATISTICS),
    "max",
    "mean",
    "std",
    "centre_row",
    "centre_column",
)


def features(images: np.ndarray) -> np.ndarray:
    """(k, 41) f8 features, named by FEATURES, of imprints (k, rows, cols) in 0..1, at least 8 x 8 cells.

    Of the horizontal (h), vertical (v) and diagonal (d) coefficients of each of three wavelet levels, level 1 the
    finest: Euclidean norm, mean, standard deviation and entropy. Then maximum, mean, standard deviation and centre of
    mass (row and column, 0..1 over the imprint; 0.5 in an imprint without mass) of the imprint itself.

    T4.2.3.4 does not give the wavelet and the entropy. Here the wavelet is db2 with symmetric borders. The entropy is
    Shannon's, in nats, of the coefficients' shares of the energy (Coifman and Wickerhauser 1992), 0 if all are zero.
    Raises ValueError for another shape, fewer cells, or NaN.
    """
    images = np.asarray(images, dtype=np.float64)
    if images.ndim != 3 or min(images.shape[1:]) < SMALLEST:
        raise ValueError(f"images must have shape (k, rows, cols), at least {SMALLEST} x {SMALLEST}: {images.shape}")
    if not np.isfinite(images).all():
        raise ValueError("images hold NaN or infinite values")
    return np.hstack([wavelet_features(images), image_features(images)])


def wavelet_features(images: np.ndarray) -> np.ndarray:
    """The first 36 of `features`."""
    columns, approximation = [], images
    for _ in range(LEVELS):
        approximation, details = pywt.dwt2(approximation, WAVELET, mode="symmetric", axes=(1, 2))
        for band in details:
            flat = band.reshape(len(images), np.prod(band.shape[1:]))
            columns += [np.linalg.norm(flat, axis=1), flat.mean(axis=1), flat.std(axis=1), _entropy(flat)]
    return np.stack(columns, axis=1)


def image_features(images: np.ndarray) -> np.ndarray:
    """The last five of `features`."""
    statistics = [images.max(axis=(1, 2)), images.mean(axis=(1, 2)), images.std(axis=(1, 2))]
    return np.stack([*statistics, *_centre(images)], axis=1)


def _entropy(coefficients):
    """(k,) entropy of the energy of coefficients (k, n)."""
    energy = coefficients**2
    total = energy.sum(axis=1, keepdims=True)
    share = np.divide(energy, total, out=np.zeros_like(energy), where=total > 0)
    return -np.sum(share * np.log(np.where(share > 0, share, 1)), axis=1)


def _centre(images):
    """Centre of mass: rows (k,) and columns (k,), 0..1."""
    mass = images.sum(axis=(1, 2))
    _, rows, columns = images.shape
    along = ((2, rows), (1, columns))
    moments = [images.sum(axis=other) @ np.linspace(0, 1, count) for other, count in along]
    return [np.divide(m, mass, out=np.full(len(images), 0.5), where=mass > 0) for m in moments]

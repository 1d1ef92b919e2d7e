"""Features of an imprint (T4.2.3.4), and the similarity of imprints by normalised cross-correlation (T4.2.3.3).

The 41 features are wavelet coefficients, brightness and the centre of mass.
"""

import numpy as np
from numpy.typing import ArrayLike

# The filters of the wavelet db2, low and high; T4.2.3.4 names none, T4.4.9 uses db2.
LOW = (-0.12940952255126037, 0.2241438680420134, 0.8365163037378079, 0.48296291314453416)
HIGH = (-0.48296291314453416, 0.8365163037378079, -0.2241438680420134, -0.12940952255126037)
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
        low, high = _halves(approximation)
        (approximation, vertical), (horizontal, diagonal) = (
            (part.swapaxes(1, 2) for part in _halves(half.swapaxes(1, 2))) for half in (low, high)
        )
        for band in (horizontal, vertical, diagonal):
            flat = band.reshape(len(images), np.prod(band.shape[1:]))
            columns += [np.linalg.norm(flat, axis=1), flat.mean(axis=1), flat.std(axis=1), _entropy(flat)]
    return np.stack(columns, axis=1)


def _halves(images):
    """The (low, high) half of images (k, n, m) along the second axis, whose borders are mirrored.

    Sums are in the order of PyWavelets, so that no bit differs from its `dwt`.
    """
    odd = images.shape[1] % 2
    padded = np.pad(images, ((0, 0), (3, 3 + odd), (0, 0)), mode="symmetric")
    for weights in (LOW, HIGH):
        a, b, c, d = (weight * padded[:, 4 - k : padded.shape[1] - 1 - k : 2] for k, weight in enumerate(weights))
        half = a + b + c + d
        if odd:
            half[:, -1] = (c + b + a + d)[:, -1]
        yield half


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
    moments = [images.sum(axis=axis) @ np.linspace(0, 1, count) for axis, count in along]
    return [np.divide(m, mass, out=np.full(len(images), 0.5), where=mass > 0) for m in moments]


SIMILARITY_THRESHOLD = 0.85  # T4.2.3.3: imprints with at least this correlation are confusable
FLAT = 1e-6  # of the full range: a smaller standard deviation is rounding error


def similarity(images: ArrayLike, others: ArrayLike | None = None) -> np.ndarray:
    """(k, l) f8 normalised cross-correlation in -1..1 of imprints (k, rows, cols) with others (l, rows, cols), or all.

    At zero lag, of images minus their mean: Pearson's correlation of the cells (Lewis, Fast normalized
    cross-correlation, 1995, eq. 2). The arrays stand upright on the object, so no shift is searched for. An imprint
    without relief (all cells equal, such as one without contact) has no correlation. Here it is 1 with another such
    imprint, since the two are indistinguishable, and 0 with any other.
    Raises ValueError for other shapes, or for NaN.
    """
    first, flat = _unit(images)
    second, second_flat = (first, flat) if others is None else _unit(others)
    if first.shape[1] != second.shape[1]:
        raise ValueError(f"imprints must have the same number of cells: {first.shape[1]} and {second.shape[1]}")
    return np.clip(first @ second.T, -1, 1) + (flat[:, None] & second_flat[None])


def confusable(similarities: np.ndarray, labels: ArrayLike, among: ArrayLike | None = None) -> np.ndarray:
    """(k,) boolean: the imprints with a correlation of 0.85 or more with an imprint of another object.

    similarities: (k, k) from `similarity`; labels: (k,) objects; among: indices of the imprints to compare with, or
    all.
    """
    labels = np.asarray(labels)
    among = np.arange(len(labels)) if among is None else np.asarray(among)
    other_object = labels[:, None] != labels[among][None]
    return ((similarities[:, among] >= SIMILARITY_THRESHOLD) & other_object).any(axis=1)


def as_many(labels: ArrayLike, kept: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(k,) boolean: of each object as many random imprints as the mask `kept` (k,) has, a control of selection."""
    labels, chosen = np.asarray(labels), np.zeros(len(kept), dtype=bool)
    for label in np.unique(labels):
        chosen[random.permutation(np.flatnonzero(labels == label))[: kept[labels == label].sum()]] = True
    return chosen


def _unit(images):
    """((k, cells): images minus their mean, of length 1, or 0 if flat; (k,) boolean: flat)."""
    images = np.asarray(images, dtype=np.float64)
    if images.ndim != 3 or not np.isfinite(images).all():
        raise ValueError(f"images must be finite, of shape (k, rows, cols): {images.shape}")
    cells = images.reshape(len(images), np.prod(images.shape[1:]))
    cells = cells - cells.mean(axis=1, keepdims=True)
    length = np.linalg.norm(cells, axis=1, keepdims=True)
    flat = length <= FLAT * np.sqrt(cells.shape[1])
    return np.where(flat, 0, cells / np.where(flat, 1, length)), flat[:, 0]

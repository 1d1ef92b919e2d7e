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
    """The 41 features of imprints, named by FEATURES (T4.2.3.4).

    Parameters
    ----------
    images : (k, rows, cols) array of float
        Imprints in 0..1, at least 8 x 8 cells.

    Returns
    -------
    (k, 41) array of float
        Euclidean norm, mean, standard deviation and entropy of the horizontal (h), vertical (v) and diagonal (d)
        coefficients of each of three wavelet levels, level 1 the finest; then maximum, mean, standard deviation and
        centre of mass (row and column, 0..1 over the imprint; 0.5 in an imprint without mass) of the imprint itself.

    Raises
    ------
    ValueError
        For another shape, fewer cells, or NaN.

    Notes
    -----
    T4.2.3.4 does not give the wavelet and the entropy. Here the wavelet is db2 with symmetric borders. The entropy is
    Shannon's, in nats, of the coefficients' shares of the energy, 0 if all are zero.

    References
    ----------
    Coifman and Wickerhauser, Entropy-based algorithms for best basis selection, IEEE Transactions on Information Theory
    38(2), 1992.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.know import features
    >>> features(np.zeros((2, 16, 16))).shape
    (2, 41)
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
    """Normalised cross-correlation of imprints, at zero lag.

    Parameters
    ----------
    images : (k, rows, cols) array_like
        Imprints.
    others : (l, rows, cols) array_like, optional
        Imprints to compare with. None: `images`.

    Returns
    -------
    (k, l) array of float
        Correlations in -1..1.

    Raises
    ------
    ValueError
        For other shapes, or for NaN.

    Notes
    -----
    The value is Pearson's correlation of the cells. The arrays stand upright on the object, so no shift is searched
    for. An imprint without relief (all cells equal, such as one without contact) has no correlation. Here it is 1 with
    another such imprint, since the two are indistinguishable, and 0 with any other.

    References
    ----------
    Lewis, Fast normalized cross-correlation, 1995, eq. 2.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.know import similarity
    >>> ramp = np.arange(16.0).reshape(1, 4, 4)
    >>> similarity(ramp, -ramp).round(6).tolist()
    [[-1.0]]
    """
    first, flat = _unit(images)
    second, second_flat = (first, flat) if others is None else _unit(others)
    if others is not None and np.shape(images)[1:] != np.shape(others)[1:]:
        raise ValueError(f"imprints must have equal cells: {np.shape(images)[1:]} and {np.shape(others)[1:]}")
    return np.clip(first @ second.T, -1, 1) + (flat[:, None] & second_flat[None])


def confusable(similarities: np.ndarray, labels: ArrayLike, among: ArrayLike | None = None) -> np.ndarray:
    """Finds the imprints with a correlation of 0.85 or more with an imprint of another object (T4.2.4).

    Parameters
    ----------
    similarities : (k, k) array of float
        From `similarity`.
    labels : (k,) array_like
        Object of each imprint.
    among : (l,) array_like of int, optional
        Imprints to compare with. None: all.

    Returns
    -------
    (k,) array of bool
        Whether an imprint can be confused.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.know import confusable
    >>> confusable(np.array([[1.0, 0.9, 0.2], [0.9, 1.0, 0.1], [0.2, 0.1, 1.0]]), ["cup", "mug", "pen"]).tolist()
    [True, True, False]
    """
    labels = np.asarray(labels)
    among = np.arange(len(labels)) if among is None else np.asarray(among)
    other_object = labels[:, None] != labels[among][None]
    return ((similarities[:, among] >= SIMILARITY_THRESHOLD) & other_object).any(axis=1)


def as_many(labels: ArrayLike, kept: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """(k,) boolean: of each object as many random imprints as the mask `kept` (k,) has, a control of selection."""
    labels, selection = np.asarray(labels), np.zeros(len(kept), dtype=bool)
    for label in np.unique(labels):
        selection[random.permutation(np.flatnonzero(labels == label))[: kept[labels == label].sum()]] = True
    return selection


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

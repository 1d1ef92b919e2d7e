"""Similarity of imprints by normalised cross-correlation, and imprints confusable between objects (T4.2.3.3)."""

import numpy as np
from numpy.typing import ArrayLike

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
    for one in np.unique(labels):
        chosen[random.permutation(np.flatnonzero(labels == one))[: kept[labels == one].sum()]] = True
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

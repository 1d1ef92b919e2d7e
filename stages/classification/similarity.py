"""How alike two imprints are: normalised cross-correlation, and the imprints that other objects have too (T4.2.3.3)."""

import numpy as np

ALIKE = 0.85  # T4.2.3.3: imprints correlated as much as this are taken for one another
FLAT = 1e-6  # of the full range: less spread than this is rounding, not relief


def similarity(images, others=None):
    """(k, l) f8 normalised cross-correlation in -1..1 of imprints (k, rows, cols) with others (l, rows, cols), or all.

    At zero lag, of images less their mean: Pearson's correlation of the cells (Lewis, Fast normalized
    cross-correlation, 1995, eq. 2). The arrays stand upright on the object, so no shift is searched for. An imprint
    without relief (all cells equal, such as one that touched nothing) has no correlation: here it is 1 with another
    such imprint, since nothing tells the two apart, and 0 with any other.
    Raises ValueError for other shapes, or for NaN.
    """
    ours, flat = _unit(images)
    theirs, level = (ours, flat) if others is None else _unit(others)
    if ours.shape[1] != theirs.shape[1]:
        raise ValueError(f"imprints must have equally many cells: {ours.shape[1]} and {theirs.shape[1]}")
    return np.clip(ours @ theirs.T, -1, 1) + (flat[:, None] & level[None])


def shared(alike, labels, among=None):
    """(k,) boolean: the imprints that correlate by 0.85 or more with an imprint of another object.

    alike: (k, k) from `similarity`; labels: (k,) objects; among: indices of the imprints to compare with, all if None.
    """
    labels = np.asarray(labels)
    among = np.arange(len(labels)) if among is None else np.asarray(among)
    foreign = labels[:, None] != labels[among][None]
    return ((alike[:, among] >= ALIKE) & foreign).any(axis=1)


def _unit(images):
    """(k, cells) images less their mean, of length 1, or 0 where flat; (k,) whether flat."""
    images = np.asarray(images, dtype=np.float64)
    if images.ndim != 3 or not np.isfinite(images).all():
        raise ValueError(f"images must be finite, of shape (k, rows, cols): {images.shape}")
    cells = images.reshape(len(images), np.prod(images.shape[1:]))
    cells = cells - cells.mean(axis=1, keepdims=True)
    length = np.linalg.norm(cells, axis=1, keepdims=True)
    flat = length <= FLAT * np.sqrt(cells.shape[1])
    return np.where(flat, 0, cells / np.where(flat, 1, length)), flat[:, 0]

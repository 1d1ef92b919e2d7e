"""Training and test parts with the same share of every class."""

import numpy as np


def stratified_split(labels, share, rng):
    """(first, second): sorted ids of two disjoint parts that together hold all; first holds `share` of each class.

    labels: (k,) integers. Every class keeps one touch or more on both sides. The thesis splits touches at random, 75 %
    to 25 % (T5.3), and so does this: touches of one object, neighbours even, lie on both sides, so a result says how
    well a known object is recognised, not how well an unseen one of its class. Raises ValueError for a share outside
    (0, 1) or a class with less than two touches.
    """
    labels = np.asarray(labels)
    if labels.ndim != 1 or not np.issubdtype(labels.dtype, np.integer):
        raise ValueError(f"labels must be integers of shape (k,), got {labels.dtype} {labels.shape}")
    if not 0 < share < 1:
        raise ValueError(f"share must lie between 0 and 1, got {share}")
    first = []
    for label in np.unique(labels):
        ids = np.flatnonzero(labels == label)
        if len(ids) < 2:
            raise ValueError(f"class {label} has one touch alone: it cannot be split")
        count = min(max(round(share * len(ids)), 1), len(ids) - 1)
        first.append(rng.permutation(ids)[:count])
    first = np.sort(np.concatenate(first))
    return first, np.setdiff1d(np.arange(len(labels)), first)

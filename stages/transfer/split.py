"""Which touches train and which test: drawn at random, as in the thesis, or those of whole objects left out."""

from typing import NamedTuple

import numpy as np

SPLITS = ("random", "objects")


class Split(NamedTuple):
    """Sorted ids of touches: train and test are disjoint and hold all; check is a part of train to choose rates on."""

    train: np.ndarray
    check: np.ndarray
    test: np.ndarray

    @property
    def fit(self):
        """The part of train that is not in check."""
        return np.setdiff1d(self.train, self.check)


def by_touches(objects, train_share, check_share, rng):
    """A share of every object's touches trains, the rest tests; check is a share of those that train.

    objects: (k,) i8, which object each touch is of. The thesis splits touches at random, 75 % to 25 % (T5.1.3), and so
    does this: touches of one object, neighbours even, lie on both sides, so a result says how well a known object is
    recognised, not how well an unseen one of its class.
    """
    train, test = stratified_split(objects, train_share, rng)
    check, _ = stratified_split(objects[train], check_share, rng)
    return Split(train, train[check], test)


def by_objects(labels, ranks, number, check_share, rng):
    """One object of each class tests, that of rank `number` modulo the objects of its class; the others train.

    labels, ranks: (k,) i8, the class of each touch and which object of its class it is of, 0 the first. The next object
    of every class is the check, so that the learning rate too is chosen on objects that the tried network has not felt;
    where a class has two objects alone, the check is a share of the touches that train. Raises ValueError for a class
    with one object.
    """
    counts = np.array([len(np.unique(ranks[labels == label])) for label in range(labels.max() + 1)])
    if counts.min() < 2:
        raise ValueError(f"class {counts.argmin()} has one object alone: it cannot be left out")
    turn = (ranks - number) % counts[labels]  # 0: tests, 1: the next one
    train, test = np.flatnonzero(turn != 0), np.flatnonzero(turn == 0)
    if counts.min() > 2:
        return Split(train, np.flatnonzero(turn == 1), test)
    check, _ = stratified_split(labels[train], check_share, rng)
    return Split(train, train[check], test)


def stratified_split(labels, share, rng):
    """(first, second): sorted ids of two disjoint parts that together hold all; first holds `share` of each label.

    labels: (k,) integers. Each label keeps one touch or more on both sides. Raises ValueError for a share outside
    (0, 1) or a label with less than two touches.
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

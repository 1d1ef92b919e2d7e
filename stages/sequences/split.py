"""Which sequences train and which test: at random, as in the thesis, or whole objects held out."""

from typing import NamedTuple

import numpy as np

TEST = 0.2  # T4.4.10: 80:20
CHECK = 0.2  # of the training sequences, where a setting has to be chosen


class Split(NamedTuple):
    """Ids of sequences: train and test are disjoint and hold all; check is a part of train, to choose settings on."""

    train: np.ndarray
    check: np.ndarray
    test: np.ndarray

    @property
    def fit(self):
        """The part of train that is not in check."""
        return np.setdiff1d(self.train, self.check)


def by_sequences(labels, random):
    """A fifth of every class, drawn at random, tests: objects, and planes that nearly coincide, stand on both sides."""
    test = _drawn(labels, np.arange(len(labels)), TEST, random)
    train = np.setdiff1d(np.arange(len(labels)), test)
    return Split(train, _drawn(labels, train, CHECK, random), test)


def by_objects(labels, ranks, fold, folds, random):
    """The object of rank `fold` of every class tests, the others train; the next object of every class is the check.

    With two objects a class the check is a fifth of the training sequences.
    """
    test, train = np.flatnonzero(ranks == fold), np.flatnonzero(ranks != fold)
    if folds < 3:
        return Split(train, _drawn(labels, train, CHECK, random), test)
    return Split(train, np.flatnonzero(ranks == (fold + 1) % folds), test)


def _drawn(labels, ids, share, random):
    """Sorted ids: a share of those of every class, one or more of each that has two."""
    labels, found = np.asarray(labels), []
    for label in np.unique(labels[ids]):
        own = random.permutation(ids[labels[ids] == label])
        found.append(own[: min(max(round(share * len(own)), 1), len(own) - 1)])
    return np.sort(np.concatenate(found))

"""Training, validation and test sequences: drawn at random, as in the thesis, or with whole objects held out."""

import numpy as np

from stages.kit.holdout import Split as Parts

TEST_SHARE = 0.2  # T4.4.10: 80:20
VALIDATION_SHARE = 0.2  # of the training sequences, to choose settings on


def split_by_sequences(labels: np.ndarray, generator: np.random.Generator) -> Parts:
    """The Parts that tests a random fifth of every class. Both sides share objects and nearly equal planes."""
    test = _draw_share(labels, np.arange(len(labels)), TEST_SHARE, generator)
    train = np.setdiff1d(np.arange(len(labels)), test)
    return Parts(train, _draw_share(labels, train, VALIDATION_SHARE, generator), test)


def split_by_objects(
    labels: np.ndarray, ranks: np.ndarray, fold: int, folds: int, generator: np.random.Generator
) -> Parts:
    """The Parts that tests the object of rank `fold` of every class; the next object of every class is for validation.

    With two objects per class, a random fifth of the training sequences is for validation.
    """
    test, train = np.flatnonzero(ranks == fold), np.flatnonzero(ranks != fold)
    if folds < 3:
        return Parts(train, _draw_share(labels, train, VALIDATION_SHARE, generator), test)
    return Parts(train, np.flatnonzero(ranks == (fold + 1) % folds), test)


def _draw_share(labels, ids, share, generator):
    """Sorted indices: a share of every class, at least one of each class that has two."""
    labels, drawn = np.asarray(labels), []
    for label in np.unique(labels[ids]):
        members = generator.permutation(ids[labels[ids] == label])
        drawn.append(members[: min(max(round(share * len(members)), 1), len(members) - 1)])
    return np.sort(np.concatenate(drawn))

"""Which pictures teach, which choose, which test (T3.3.2)."""

import numpy as np

TRAIN, VALIDATION = 0.6, 0.2  # of the views, the rest tests; T3.3.2


def random_views(count, generator):
    """(train, validation, test): sorted ids of `count` pictures, 60, 20 and 20 %, whatever their object (T3.3.2).

    Views of one object, neighbours even, lie on all sides: a result says how well known objects are named from new
    directions, not how well new objects are.
    """
    order, first, second = generator.permutation(count), round(TRAIN * count), round((TRAIN + VALIDATION) * count)
    return np.sort(order[:first]), np.sort(order[first:second]), np.sort(order[second:])


def hold_out(labels, folds, generator):
    """(k,) i8: the fold 0..folds-1 in which each object is tested, -1 for one whose class has no other object.

    labels (k,): the objects' classes. Each class is dealt out over the folds, so that what is tested has an object of
    its class among those that teach.
    """
    labels = np.asarray(labels)
    fold, start = np.full(len(labels), -1), 0
    for label in np.unique(labels):
        ids = generator.permutation(np.flatnonzero(labels == label))
        if len(ids) > 1:
            fold[ids] = (start + np.arange(len(ids))) % folds
            start += len(ids)
    return fold

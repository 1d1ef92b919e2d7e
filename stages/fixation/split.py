"""The division of pictures and objects into training, validation and test sets (T3.3.2)."""

import numpy as np

TRAIN, VALIDATION = 0.6, 0.2  # shares of the views, the rest is for testing; T3.3.2


def random_views(count: int, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(train, validation, test): sorted ids of `count` pictures, 60, 20 and 20 %, whatever their object (T3.3.2).

    Views of one object, even neighbouring ones, are in all three sets. So the accuracy is that of known objects from
    new directions, not of new objects.
    """
    order, first, second = generator.permutation(count), round(TRAIN * count), round((TRAIN + VALIDATION) * count)
    return np.sort(order[:first]), np.sort(order[first:second]), np.sort(order[second:])


def object_folds(labels: np.ndarray, folds: int, generator: np.random.Generator) -> np.ndarray:
    """(k,) i8: the fold 0..folds-1 in which each object is tested, -1 for one whose class has no other object.

    labels (k,): the objects' classes. Each class is spread over the folds, so that the training set of each tested
    object has another object of its class.
    """
    labels = np.asarray(labels)
    fold, start = np.full(len(labels), -1), 0
    for label in np.unique(labels):
        ids = generator.permutation(np.flatnonzero(labels == label))
        if len(ids) > 1:
            fold[ids] = (start + np.arange(len(ids))) % folds
            start += len(ids)
    return fold

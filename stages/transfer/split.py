"""The division into training and test touches: at random, as in the thesis, or by objects that are left out."""

import numpy as np

from stages.kit.holdout import Split

SPLITS = ("random", "objects")


def by_touches(objects: np.ndarray, train_share: float, validation_share: float, rng: np.random.Generator) -> Split:
    """The Split with a share of every object's touches for training, and the rest for testing.

    objects: (k,) i8, the object of each touch; validation_share: of the training touches. The thesis splits touches at
    random, 75 % to 25 % (T5.1.3). Touches of one object, even neighbouring ones, are then on both sides, so the
    accuracy is that on known objects, not on unseen ones of the same class.
    """
    train, test = stratified_split(objects, train_share, rng)
    validation, _ = stratified_split(objects[train], validation_share, rng)
    return Split(train, train[validation], test)


def by_objects(
    labels: np.ndarray, ranks: np.ndarray, number: int, validation_share: float, rng: np.random.Generator
) -> Split:
    """The Split with one object of each class for testing, and the others for training.

    labels, ranks: (k,) i8, the class of each touch and the index of its object in the class. The test object has rank
    `number` modulo the number of objects. The next object of every class is for validation, so that the learning rate,
    too, is chosen on unseen objects. Where a class has only two objects, validation is a share of the training touches.
    Raises ValueError for a class with one object.
    """
    counts = np.array([len(np.unique(ranks[labels == label])) for label in range(labels.max() + 1)])
    if counts.min() < 2:
        raise ValueError(f"class {counts.argmin()} has one object alone: it cannot be left out")
    turn = (ranks - number) % counts[labels]  # 0: test, 1: validation
    train, test = np.flatnonzero(turn != 0), np.flatnonzero(turn == 0)
    if counts.min() > 2:
        return Split(train, np.flatnonzero(turn == 1), test)
    validation, _ = stratified_split(labels[train], validation_share, rng)
    return Split(train, train[validation], test)


def stratified_split(labels: np.ndarray, share: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(first, second): sorted ids of two disjoint parts that together hold all; first holds `share` of each label.

    labels: (k,) integers. Each label has at least one item in both parts. Raises ValueError for a share outside
    (0, 1) or a label with fewer than two items.
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

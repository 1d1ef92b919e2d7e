"""Which recorded touches train, which choose the learning rate, and which test."""

import numpy as np

from haptic_glance.know.split import Split
from stages.recorded.splits import SPLITS

from .sources import Recording

QUARTER = 0.25  # of the objects or recordings, held out; as many as of the touches (T5.3)


def parts(recording: Recording, split: str, number: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(train, validation, test): ids of a split; validation is cut from the training part in the same way.

    random: a random quarter of each class; blocks: of each class a run of neighbours, a quarter of it; objects: a
    quarter of the objects or recordings; test_objects: those that the publisher keeps, validation a quarter of the
    other objects. Raises ValueError where a class has one object or recording alone.
    """
    if split == Split.TEST_OBJECTS:
        out = np.isin(groups_of(recording), recording.test_objects)
        train, test, inner = np.flatnonzero(~out), np.flatnonzero(out), str(Split.OBJECTS)
    else:
        inner = split
        train, test = _cut(recording, np.arange(len(recording.touches.labels)), split, number)
    fit, validation = _cut(recording, train, inner, number)
    return fit, validation, test


def object_split(labels: np.ndarray, groups: np.ndarray, number: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test): a quarter of the groups of each class, one at least, all its touches in the test.

    A group with touches of several classes counts for the lowest of them. Raises ValueError where too few are left.
    """
    random, out = np.random.default_rng(number), []
    names = np.unique(groups)
    lowest = np.array([labels[groups == name].min() for name in names])
    for label in np.unique(lowest):
        own = names[lowest == label]
        out.append(random.choice(own, max(1, round(QUARTER * len(own))), replace=False))
    held = np.isin(groups, np.concatenate(out))
    for part in (held, ~held):
        if missing := set(labels) - set(labels[part]):
            raise ValueError(f"class {min(missing)} has too few groups to hold one out")
    return np.flatnonzero(~held), np.flatnonzero(held)


def groups_of(recording: Recording) -> np.ndarray:
    """(k,) names of the object or recording of each touch; ValueError where nobody knows them."""
    if recording.touches.groups is None:
        raise ValueError("these recordings do not say which object a touch is of: no object can be held out")
    return recording.touches.groups


def _cut(recording: Recording, ids: np.ndarray, split: str, number: int) -> tuple[np.ndarray, np.ndarray]:
    labels = recording.touches.labels[ids]
    if split == Split.OBJECTS:
        first, second = object_split(labels, groups_of(recording)[ids], number)
    else:
        first, second = SPLITS[Split(split)](labels, number)
    return ids[first], ids[second]

"""Splits of recorded touches, at random or in blocks of time; all stages on recorded touches split the same way."""

import numpy as np
from sklearn.model_selection import train_test_split

from haptic_glance.base.rng import rng
from haptic_glance.know.protocol import HOLDOUT
from haptic_glance.know.split import Split


def split_number(seed: int, repetition: int) -> int:
    """The seed of one repetition's split: all stages on recorded touches split the same way."""
    return int(rng(seed, f"repetition {repetition}").integers(2**31))


def random_split(labels: np.ndarray, number: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test): a random quarter of each class, as stages.classification draws it."""
    parts = train_test_split(np.arange(len(labels)), test_size=HOLDOUT, stratify=labels, random_state=number)
    return np.asarray(parts[0]), np.asarray(parts[1])


def block_split(labels: np.ndarray, number: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test): of each class a run of neighbours, a quarter of its touches; the labels in order of recording."""
    random, train, test = np.random.default_rng(number), [], []
    for label in np.unique(labels):
        ids = np.flatnonzero(labels == label)
        length = round(HOLDOUT * len(ids))
        start = random.integers(len(ids) - length + 1)
        test.append(ids[start : start + length])
        train.append(np.delete(ids, np.arange(start, start + length)))
    return np.concatenate(train), np.concatenate(test)


SPLITS = {Split.RANDOM: random_split, Split.BLOCKS: block_split}

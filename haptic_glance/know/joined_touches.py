"""Several touches as one sample: each imprint as a position on a self-organising map (T4.2.3.5)."""

from typing import Any

import numpy as np

NEURONS = 100  # of the self-organising map: 10 x 10, the default of RapidMiner, the thesis's software


def touch_map() -> Any:
    """Reduces the features (k, d) of imprints to two numbers: their position on a map of 10 x 10 neurons.

    Features are standardised by those that `fit` is given.
    """
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from .self_organising_map import SelfOrganisingMap

    return make_pipeline(StandardScaler(), SelfOrganisingMap(2, NEURONS))


def draw_combinations(truth: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """(k, count) indices: one combination per imprint, itself and count - 1 random others of its object.

    The thesis gives neither the number of combinations nor whether an imprint may occur twice. One per imprint keeps
    the number of samples equal from one touch to five, and no imprint occurs twice in a combination. Raises ValueError
    if an object has fewer imprints than a combination needs.
    """
    truth = np.asarray(truth)
    combinations = np.empty((len(truth), count), dtype=np.int64)
    for label in np.unique(truth):
        members = np.flatnonzero(truth == label)
        if len(members) < count:
            raise ValueError(f"an object has {len(members)} imprints, a combination needs {count}")
        keys = random.random((len(members), len(members)))
        np.fill_diagonal(keys, -1)  # the imprint itself comes first
        combinations[members] = members[keys.argsort(axis=1)[:, :count]]
    return combinations


def concatenate_touches(numbers: np.ndarray, combinations: np.ndarray) -> np.ndarray:
    """(k, count * d): the numbers (n, d) of the imprints of each combination (k, count), one after another."""
    return numbers[combinations].reshape(len(combinations), -1)

"""Splits of the touches of objects into training and test touches."""

import numpy as np

from stages.kit.split import Split

SHARE = 0.25  # of each object's touches held out, as in T4.2.4
# Each split by its word in reports/metrics and in the seeds of the random numbers, on which the results depend.
SPLITS: dict[str, str] = {Split.RANDOM: "anywhere", Split.REGIONS: "apart"}


def split_touches(
    truth: np.ndarray, places: np.ndarray, split: str, min_distance: float, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """(train, test) indices of touches (k,) with objects truth (k,) and places (k, 3), in rising order.

    A quarter of each object's touches is held out: `random`, so that test arrays overlap training arrays; or `regions`,
    one region of each object, where only touches farther than `min_distance` units from all of the region remain for
    training. Raises ValueError for an object without touches to train on.
    """
    if split not in SPLITS:
        raise ValueError(f"unknown split {split}: choose one of {', '.join(SPLITS)}")
    train, test = [], []
    for label in np.unique(truth):
        members = np.flatnonzero(truth == label)
        count = round(SHARE * len(members))
        if split == Split.RANDOM:
            held_out, kept = np.split(random.permutation(members), [count])
        else:
            distances = np.linalg.norm(places[members][:, None] - places[members][None], axis=2)
            region, others = np.split(np.argsort(distances[random.integers(len(members))], kind="stable"), [count])
            held_out, kept = members[region], members[others[(distances[others][:, region] > min_distance).all(axis=1)]]
        if len(held_out) == 0 or len(kept) == 0:
            raise ValueError(f"object {label} has too few touches ({len(members)}) to hold some out: {split}")
        test.append(np.sort(held_out))
        train.append(np.sort(kept))
    return np.concatenate(train), np.concatenate(test)

"""How measurements divide into training and test: one vocabulary for all stages."""

from enum import StrEnum

import numpy as np


class Split(StrEnum):
    """The column `split` of the measurements: what was kept out of training."""

    RANDOM = "random"
    FOLDS = "folds"
    REGIONS = "regions"
    RANDOM_FEWER = "random_fewer"
    BLOCKS = "blocks"
    OBJECTS = "objects"
    TEST_OBJECTS = "test_objects"
    VIEWS = "views"

    @property
    def words(self) -> str:
        """The test part, in words."""
        return _WORDS[self]


_WORDS = {
    Split.RANDOM: "test part drawn at random",
    Split.FOLDS: "cross-validation",
    Split.REGIONS: "regions that no training touch overlaps",
    Split.RANDOM_FEWER: "test part drawn at random, as few touches to train on as for unseen regions",
    Split.BLOCKS: "neighbours in time or place kept together",
    Split.OBJECTS: "unseen objects",
    Split.TEST_OBJECTS: "the publisher's unseen objects",
    Split.VIEWS: "unseen views",
}
# Test over training share. At random a quarter is tested (T4.2.4). Of regions the touches that overlap them are not
# trained on; `random_fewer` trains on as few. Five folds test a fifth. Objects and views are independent items.
_SHARED = {
    Split.RANDOM: 0.25 / 0.75, Split.BLOCKS: 0.25 / 0.75, Split.REGIONS: 0.43, Split.RANDOM_FEWER: 0.43,
    Split.FOLDS: 0.2 / 0.8,
}  # fmt: skip


def shared_by(split: str, of_class: int | None = None) -> float:
    """Test over training share of repeated splits of the same data, for an interval of their mean.

    of_class: objects of each class, where the repetitions are folds that leave one object of each class out. Without
    it, unseen objects or views count as independent: 0. Raises ValueError for a name that is no Split.
    """
    if of_class is not None and split == Split.OBJECTS:
        return 1 / (of_class - 1)
    return _SHARED.get(Split(split), 0.0)


HOLDOUT = 0.25  # of each object's touches; T4.2.4
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
        count = round(HOLDOUT * len(members))
        if split == Split.RANDOM:
            held_out, kept = np.split(random.permutation(members), [count])
        else:
            distances = np.linalg.norm(places[members][:, None] - places[members][None], axis=2)
            region, rest = np.split(np.argsort(distances[random.integers(len(members))], kind="stable"), [count])
            held_out, kept = members[region], members[rest[(distances[rest][:, region] > min_distance).all(axis=1)]]
        if len(held_out) == 0 or len(kept) == 0:
            raise ValueError(f"object {label} has too few touches ({len(members)}) to hold some out: {split}")
        test.append(np.sort(held_out))
        train.append(np.sort(kept))
    return np.concatenate(train), np.concatenate(test)

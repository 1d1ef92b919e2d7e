"""The recorded touches that networks are judged on, and how each is split into training and test."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks._recorded import blocked, holdout
from stages.classification.recorded import read_grasps, read_pressure_images
from stages.transfer.recorded import Recorded, grasp_images, pressure_images, read_bigs, read_vitac, read_vt60

QUARTER = 0.25  # of the objects or recordings, held out; as many as of the touches (T5.3)


@dataclass(frozen=True)
class Source:
    """A data set: what reports call it, the argument with its path, how it is read and split, and whether training may
    reflect, move and scale its images. read(path) also gives the names of the objects that are kept for testing."""

    dataset: str
    argument: str
    read: Callable[[str], tuple[Recorded, list[str]]]
    splits: tuple[str, ...]
    augmented: bool


def _pressure(path):
    return pressure_images(read_pressure_images(path)), []


def _grasped(path):
    return grasp_images(read_grasps(path), "objects"), []


def _slips(path):
    grasps = read_grasps(path)
    return grasp_images(grasps, "slipped"), np.unique(grasps.objects[grasps.test]).tolist()


SOURCES = {
    "pressure": Source("pressure_images", "images", _pressure, ("random", "runs"), True),
    # A reflected fingertip is another finger's and a moved one none, so grasps are not augmented.
    "grasps_object": Source("bts3", "grasps", _grasped, ("random", "runs"), False),
    "grasps_slip": Source("bts3", "grasps", _slips, ("test_objects",), False),
    "vitac": Source("vitac", "vitac", lambda path: (read_vitac(path), []), ("random", "groups"), True),
    "vt60": Source("vt60", "vt60", lambda path: (read_vt60(path), []), ("random", "groups"), True),
    "bigs": Source("bigs", "bigs", lambda path: (read_bigs(path), []), ("random", "groups"), False),
}


def parts(recorded, split, number, kept_for_test):
    """(train, validation, test): ids of a split; validation is cut from the training part in the same way.

    random: a random quarter of each class; runs: of each class a run of neighbours, a quarter of it; groups: a quarter
    of the objects or recordings; test_objects: those of `kept_for_test` (names), validation a quarter of the others.
    Raises ValueError where a class has one group alone.
    """
    if split == "test_objects":
        out = np.isin(recorded.groups, kept_for_test)
        train, test, inner = np.flatnonzero(~out), np.flatnonzero(out), "groups"
    else:
        inner = split
        train, test = _cut(recorded, np.arange(len(recorded.labels)), split, number)
    learnt, validation = _cut(recorded, train, inner, number)
    return learnt, validation, test


def _cut(recorded, ids, split, number):
    labels = recorded.labels[ids]
    if split == "groups":
        first, second = by_groups(labels, recorded.groups[ids], number)
    else:
        first, second = {"random": holdout, "runs": blocked}[split](labels, number)
    return ids[first], ids[second]


def by_groups(labels, groups, number):
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

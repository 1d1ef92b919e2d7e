"""Several touches as one sample: the trials of T table 4.6, and what else may have made its figures (T4.2.3.5)."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stages.kit import Stopwatch

from .protocol import holdout, regions
from .touches import TouchMap, combine, join
from .trials import TOO_NEAR, Trial

WAYS = ("_unplaced", "_ordered", "_disjoint", "_many")  # of joining the touches of one side of a split, see trials.py

MANY = 5  # times as many combinations
SQUARE = ("svm",)  # whose time grows with the square of the samples: not run on many


@dataclass(frozen=True)
class Several:
    """Trials of several touches. counts: of touches; draws: combinations an imprint; every: also the other ways."""

    counts: tuple
    draws: int
    every: bool

    def trials(self, touched, number) -> Iterator[Trial]:
        """Of one repetition: hold-out and regions, then the other ways to join on the hold-out."""
        ways = WAYS if self.every else ()
        split = holdout(touched.truth, number)
        yield from self._joined(touched, split, number, "accuracy_holdout", ("", *ways))
        split = regions(touched.truth, touched.places, touched.width, number, side=True)
        if split is None:
            yield Trial("touches_1", "accuracy_side", note=TOO_NEAR)
        else:
            yield from self._joined(touched, split, number, "accuracy_side", ("",))
        if self.every:
            yield from self._mixed("touches_{}_mixed", touched, number)
            yield from self._mixed("first_15_touches_{}_mixed", touched.first(), number)

    def _joined(self, touched, split, number, metric, ways):
        """Combinations within each side of a split; the map is learned on the training side."""
        numbers, seconds = _reduced(touched, split[0], number)
        for way in ways:
            for count in self.counts:
                random = np.random.default_rng([number, count])
                fewest = min(np.bincount(touched.truth[side]).min() for side in split)
                if fewest < count:
                    note = f"an object has {fewest} touches on one side of the split: no combination of {count}"
                    yield Trial(f"touches_{count}{way}", metric, note=note)
                    continue
                sides = [self._combine(touched, side, count, way, random) for side in split]
                columns = numbers[:, :2] if way == "_unplaced" else numbers
                skipped = SQUARE if way == "_many" else ()
                yield _trial(f"touches_{count}{way}", metric, columns, touched.truth, sides, seconds, skipped)

    def _combine(self, touched, side, count, way, random):
        """(m, count) indices of the imprints of one side."""
        if way == "_disjoint":
            return side[_disjoint(touched.truth[side], count, random)]
        draws = self.draws * (MANY if way == "_many" else 1)
        drawn = [side[combine(touched.truth[side], count, random)] for _ in range(draws)]
        joined = np.concatenate(drawn)
        if way == "_ordered":
            joined = np.take_along_axis(joined, touched.places[joined, 2].argsort(axis=1), axis=1)
        return joined

    def _mixed(self, name, touched, number):
        """Combinations of all imprints, then split: what a test combination holds was seen in training."""
        everything = np.arange(len(touched.truth))
        numbers, seconds = _reduced(touched, everything, number)
        for count in self.counts:
            joined = self._combine(touched, everything, count, "", np.random.default_rng([number, count]))
            sides = [joined[side] for side in holdout(touched.truth[joined[:, 0]], number)]
            yield _trial(name.format(count), "accuracy_holdout", numbers, touched.truth, sides, seconds)


def _reduced(touched, train, number):
    """((k, 5) two numbers of the map and the position of each imprint, seconds)."""
    with Stopwatch() as watch:
        flat = TouchMap(number).fit(touched.samples[train]).transform(touched.samples)
    return np.hstack([flat, touched.places]), watch.seconds


def _disjoint(truth, count, random):
    """(m, count) indices of combinations that share no imprint."""
    joined = []
    for one in np.unique(truth):
        own = random.permutation(np.flatnonzero(truth == one))
        joined.append(own[: len(own) // count * count].reshape(-1, count))
    return np.concatenate(joined)


def _trial(variant, metric, numbers, truth, sides, seconds, skipped=()):
    train, test = sides
    joined = np.concatenate(sides)
    split = (np.arange(len(train)), len(train) + np.arange(len(test)))
    return Trial(variant, metric, join(numbers, joined), truth[joined[:, 0]], split, "reduced", seconds, skipped)

"""The trials of recognition by single touches of T4.2.4, and their variants.

| variant | samples | thesis |
|---|---|---|
| plain | further readings of the scaling, see haptic_glance.know.classifiers | tables 4.1 and 4.2 |
| first_15 | the first 15 imprints of each object, as in the thesis | shares of T4.2.4 |
| locations | with the positions of the touches | table 4.5 |
| selected | imprints that correlate with another object's removed, before the split | table 4.3 |
| selected_train | removed from the training part alone, by its own correlations | none |
| selected_control | as many of each object removed, at random | none |
| touches_N | N touches and their positions, concatenated | table 4.6 |
| touches_N_unplaced | without the positions | none |
| touches_N_ordered | the touches of a combination in the order of their height | none |
| touches_N_disjoint | each imprint in one combination only: fewer samples with more touches | none |
| touches_N_many | five times as many combinations, without the SVM | none |
| touches_N_mixed | combinations drawn before the split, so that both sides share imprints | see below |

T4.2.4 removes 33.33, 40, 6.67, 26.67, 13.33 and 20 % of the six objects' imprints: fifteenths. A quarter of fifteen
cannot give five different touches, so the thesis's combinations seem to be drawn before the split.

Sets of objects can be drawn at random, so that a conclusion is about sets and not about one of them.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.know.classifiers import BEFOREHAND, MIN_MAX, SCALINGS, TRAINING
from haptic_glance.know.features import as_many, confusable, similarity
from haptic_glance.know.protocol import VALIDITY, random_holdout, region_holdout
from haptic_glance.know.split import Split

THESIS_COUNT = 15  # imprints per object in the thesis, see above
NO_DISTANT_TOUCH = "an object has no touch farther than the array's width from its held-out region"
OTHERS = (BEFOREHAND, MIN_MAX)  # scalings beside that of the training part; `components` for a closer look alone
NARROW = ("knn", "svm")  # whose answers depend on the scale most
OF_NAMED_SETS = ("first_15_locations",)  # variants of no drawn set
MIN_TO_SPLIT = 4  # imprints per object of which a quarter can be held out


@dataclass(frozen=True)
class TouchSet:
    """The imprints of all objects of a set.

    samples: (k, d) features; truth: (k,) object numbers; places: (k, 3) positions; width: of the array; images: (k,
    rows, cols) the imprints; similarities: (k, k).
    """

    samples: np.ndarray
    truth: np.ndarray
    places: np.ndarray
    width: float
    images: np.ndarray
    similarities: np.ndarray

    @classmethod
    def from_images(
        cls, samples: np.ndarray, images: np.ndarray, truth: np.ndarray, places: np.ndarray, width: float
    ) -> "TouchSet":
        """The TouchSet with the similarities of the images."""
        return cls(samples, truth, places, width, images, similarity(images))

    def subset(self, chosen: np.ndarray) -> "TouchSet":
        """The TouchSet of the imprints `chosen` (mask or indices)."""
        similarities = self.similarities[chosen][:, chosen]
        parts = (self.samples[chosen], self.truth[chosen], self.places[chosen])
        return TouchSet(*parts, self.width, self.images[chosen], similarities)

    def first_of_each(self, count: int = THESIS_COUNT) -> "TouchSet":
        """The TouchSet of the first `count` imprints of each object."""
        ranks = np.concatenate([np.arange(size) for size in np.bincount(self.truth)])
        return self.subset(ranks < count)

    @property
    def confusable(self) -> np.ndarray:
        """(k,) boolean: the imprints confusable with another object's."""
        return confusable(self.similarities, self.truth)


@dataclass(frozen=True)
class Trial:
    """Samples, and the parts to train and test on as a split draws them; without parts `note` has the reason.

    parts: (train, test) indices; seconds: the time to compute the samples; skipped: classifiers that are not run;
    scalings: names in SCALINGS, by each of which it is run; narrow: by those other than TRAINING, the SVM and kNN alone
    are run; validity: metrics of dead classifiers that further rows have.
    """

    variant: str
    split: Split
    samples: np.ndarray | None = None
    truth: np.ndarray | None = None
    parts: tuple[np.ndarray, np.ndarray] | None = None
    kind: str = "features"
    seconds: float = 0.0
    skipped: tuple[str, ...] = ()
    note: str | None = None
    scalings: tuple[str, ...] = (TRAINING,)
    narrow: bool = False
    validity: tuple[str, ...] = ()

    def classifiers(self, names: Iterable[str], scaling: str) -> list[str]:
        """The names that are run by a scaling."""
        narrow = self.narrow and scaling != TRAINING
        return [name for name in names if name not in self.skipped and (not narrow or name in NARROW)]


def single_touch_trials(touched: TouchSet, random_state: int, closer: bool = False) -> Iterator[Trial]:
    """Trials of one touch: other scalings, fewer imprints, locations.

    closer: with each reading of the scaling. Otherwise some have those but `components`, fewer with all classifiers.
    """
    scalings = (TRAINING, *OTHERS)
    plain = Trial("plain", Split.RANDOM, touched.samples, touched.truth, random_holdout(touched.truth, random_state))
    yield replace(plain, scalings=SCALINGS[1:] if closer else OTHERS, validity=VALIDITY if closer else ())
    regions = _region_trial("plain", touched, touched.samples, random_state, "features", side=False)
    yield replace(regions, scalings=OTHERS, narrow=True)
    located = np.hstack([touched.samples, touched.places])
    first_few = touched.first_of_each()
    yield from _both_splits(
        "first_15", first_few, first_few.samples, random_state, scalings=scalings, narrow=not closer
    )
    yield from _both_splits("locations", touched, located, random_state, "located", scalings if closer else (TRAINING,))
    parts = random_holdout(first_few.truth, random_state)
    few_located = np.hstack([first_few.samples, first_few.places])
    yield Trial("first_15_locations", Split.RANDOM, few_located, first_few.truth, parts, "located")


def selection_trials(touched: TouchSet, random_state: int) -> Iterator[Trial]:
    """Trials without confusable imprints: removed from all data, or from the training part alone."""
    for prefix, part in (("", touched), ("first_15_", touched.first_of_each())):
        mask = ~part.confusable
        train, test = random_holdout(part.truth, random_state)
        distinct = ~confusable(part.similarities, part.truth, train)[train]
        random = np.random.default_rng([random_state, len(part.truth)])
        yield from _selected(f"{prefix}selected", part, mask, random_state)
        yield _selected_train(f"{prefix}selected_train", part, (train[distinct], test))
        yield next(_selected(f"{prefix}selected_control", part, as_many(part.truth, mask, random), random_state))


def _selected(variant, part, chosen, random_state):
    """The trials of the imprints of a mask, drawn before the split."""
    selection = part.subset(chosen)
    if min(np.bincount(selection.truth, minlength=part.truth.max() + 1)) < MIN_TO_SPLIT:
        note = f"selection leaves an object fewer than {MIN_TO_SPLIT} of its {len(part.truth)} imprints"
        yield Trial(variant, Split.RANDOM, note=note)
    else:
        scalings = (TRAINING,) if variant.startswith("first") else (TRAINING, *OTHERS)
        yield from _both_splits(variant, selection, selection.samples, random_state, scalings=scalings)


def _selected_train(variant, part, parts):
    """The trial of a training part that selection leaves."""
    complete = len(np.unique(part.truth[parts[0]])) == part.truth.max() + 1
    note = None if complete else "selection leaves an object no imprint to train on"
    return Trial(variant, Split.RANDOM, part.samples, part.truth, parts if complete else None, note=note)


def _both_splits(variant, touched, samples, random_state, kind="features", scalings=(TRAINING,), narrow=False):
    """The random hold-out, by all scalings, and the held-out regions of one kind of samples, by the first."""
    parts = random_holdout(touched.truth, random_state)
    yield Trial(variant, Split.RANDOM, samples, touched.truth, parts, kind, scalings=scalings, narrow=narrow)
    yield _region_trial(variant, touched, samples, random_state, kind, side=kind == "located")


def _region_trial(variant, touched, samples, random_state, kind, side):
    """One region of each object held out; or, if positions are features, one side of all."""
    parts = region_holdout(touched.truth, touched.places, touched.width, random_state, side)
    note = None if parts else NO_DISTANT_TOUCH
    return Trial(variant, Split.REGIONS, samples, touched.truth, parts, kind, note=note)


def drawn_sets(
    groups: Mapping[str, Sequence[str]],
    objects: Sequence[str],
    count: int,
    seed: int,
    alike: Callable[[Sequence[str]], np.ndarray],
) -> dict[str, list[str]]:
    """{"GROUP.NUMBER": objects}: `count` random sets, each with groups of as many objects as the named ones have.

    The objects are dealt like cards and shuffled anew when too few are left, so that two sets share as few as they can.
    The groups of one number are nested. A smaller group has the objects that are least alike (T4.2.4), one whose name
    ends in "_drawn" the first ones. alike: the likeness (n, n) of n objects, see `least_alike`.
    Raises ValueError where there are fewer objects than the largest group takes.
    """
    size = max(map(len, groups.values()))
    if size > len(objects):
        raise ValueError(f"classification.drawn: a set takes {size} objects, there are {len(objects)}")
    hands: list[list[str]] = []
    while len(hands) < count:
        deck = rng(seed, f"deck {len(hands)}").permutation(sorted(objects)).tolist()
        hands += [deck[start : start + size] for start in range(0, len(deck) - size + 1, size)]
    sets = {}
    for number, hand in enumerate(hands[:count], 1):
        likeness = alike(hand)
        for group, names in groups.items():
            is_drawn = group.endswith("_drawn")
            sets[f"{group}.{number:02}"] = hand[: len(names)] if is_drawn else least_alike(hand, likeness, len(names))
    return sets


def least_alike(objects: Sequence[str], likeness: np.ndarray, count: int) -> list[str]:
    """The `count` objects without two of the highest similarity (T4.2.4).

    Of the two objects that are most alike the one that is more like all others is left out, again and again.
    likeness: (n, n), symmetric.
    """
    ids = np.arange(len(objects))
    while len(ids) > count:
        part = likeness[np.ix_(ids, ids)]
        similarities = np.where(np.eye(len(ids), dtype=bool), -np.inf, part)
        pair = np.unravel_index(similarities.argmax(), similarities.shape)
        ids = np.delete(ids, max(pair, key=lambda place: part[place].sum()))
    return [objects[int(place)] for place in ids]


def set_of(name: str) -> dict[str, str | int | None]:
    """The columns `group` and `set` of a name of `drawn_sets`, or of a named set."""
    group, _, number = name.partition(".")
    return {"group": group, "set": int(number) if number else None}

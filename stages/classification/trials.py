"""The further experiments of T4.2.4: fewer imprints, locations, selection, several touches; as trials of one split.

| variant | samples | thesis |
|---|---|---|
| pixels | the imprints themselves instead of their features | none |
| wavelet_features, image_features | the one or the other part of the features alone | none |
| first_15 | the first 15 imprints of each object, as the thesis had | shares of T4.2.4 |
| locations | with the positions of the touches | table 4.5 |
| locations_turned | the same, tested on objects turned about the vertical | none |
| selected | imprints that correlate with another object's removed, before the split | table 4.3 |
| selected_train | removed from the training part alone, by what is seen there | none |
| touches_N | N touches and their positions, joined | table 4.6 |
| touches_N_unplaced | without the positions | none |
| touches_N_ordered | the touches of a combination in the order of their height | none |
| touches_N_disjoint | each imprint in one combination: fewer samples the more touches | none |
| touches_N_many | five times as many combinations, without the SVM | none |
| touches_N_mixed | combinations drawn before the split, so that both sides share imprints | see below |

T4.2.4 removes 33.33, 40, 6.67, 26.67, 13.33 and 20 % of the six objects' imprints: fifteenths. A quarter of fifteen
cannot make five different touches, so the thesis's combinations seem to be drawn before the split.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .features import IMAGE
from .protocol import holdout, regions
from .similarity import shared, similarity

FIRST = 15  # imprints an object in the thesis, see above
TOO_NEAR = "an object has no touch farther than the array's width from its held-out region"
LEAST = 4  # imprints an object of which a quarter can be held out


@dataclass(frozen=True)
class Touched:
    """The imprints of all objects of a set: features (k, d), truth (k,) 0.., places (k, 3), width.

    images: (k, rows, cols) the imprints; alike: (k, k) their similarity.
    """

    samples: np.ndarray
    truth: np.ndarray
    places: np.ndarray
    width: float
    images: np.ndarray
    alike: np.ndarray

    @classmethod
    def of(cls, samples, images, truth, places, width):
        """Computes the similarity of all imprints."""
        return cls(samples, truth, places, width, images, similarity(images))

    def take(self, chosen):
        """Those of the imprints that `chosen` (mask or indices) names."""
        alike = self.alike[chosen][:, chosen]
        own = (self.samples[chosen], self.truth[chosen], self.places[chosen])
        return Touched(*own, self.width, self.images[chosen], alike)

    def first(self, count=FIRST):
        """The first `count` imprints of each object."""
        ranks = np.concatenate([np.arange(size) for size in np.bincount(self.truth)])
        return self.take(ranks < count)

    @property
    def shared(self):
        """(k,) boolean: imprints that another object has too."""
        return shared(self.alike, self.truth)


@dataclass(frozen=True)
class Trial:
    """One split to train and test on; without a split it says why in `note`.

    seconds: spent on the samples before; skipped: classifiers that it is not run with.
    """

    variant: str
    metric: str
    samples: np.ndarray = None
    truth: np.ndarray = None
    split: tuple = None
    kind: str = "features"
    seconds: float = 0.0
    skipped: tuple = ()
    note: str | None = None


def single(touched, number) -> Iterator[Trial]:
    """Trials of one touch: other features, fewer imprints, locations."""
    yield from _features(touched, holdout(touched.truth, number))
    located = np.hstack([touched.samples, touched.places])
    few = touched.first()
    yield from _both("first_15", few, few.samples, number)
    yield from _both("locations", touched, located, number, "located")
    yield _apart("plain", touched, touched.samples, number, "features", side=True)
    split = holdout(touched.truth, number)
    turned = _turned(touched, split, number)
    yield Trial("locations_turned", "accuracy_holdout", turned, touched.truth, split, "located")
    split = holdout(few.truth, number)
    few_located = np.hstack([few.samples, few.places])
    yield Trial("first_15_locations", "accuracy_holdout", few_located, few.truth, split, "located")


def _features(touched, split):
    """Pixels, and the two parts of the features."""
    for variant, samples, kind in (
        ("pixels", touched.images.reshape(len(touched.images), -1), "features"),
        ("wavelet_features", touched.samples[:, :-IMAGE], "features"),
        ("image_features", touched.samples[:, -IMAGE:], "reduced"),
    ):
        yield Trial(variant, "accuracy_holdout", samples, touched.truth, split, kind)


def selection(touched, number) -> Iterator[Trial]:
    """Trials with the imprints that other objects have too removed: of all data, or of the training part alone."""
    for prefix, part in (("", touched), ("first_15_", touched.first())):
        kept = part.take(~part.shared)
        if min(np.bincount(kept.truth, minlength=part.truth.max() + 1)) < LEAST:
            note = f"selection leaves an object fewer than {LEAST} of its {len(part.truth)} imprints"
            yield Trial(f"{prefix}selected", "accuracy_holdout", note=note)
        else:
            yield from _both(f"{prefix}selected", kept, kept.samples, number)
        train, test = holdout(part.truth, number)
        own = train[~shared(part.alike, part.truth, train)[train]]
        split = (own, test) if len(np.unique(part.truth[own])) == part.truth.max() + 1 else None
        note = None if split else "selection leaves an object no imprint to train on"
        yield Trial(f"{prefix}selected_train", "accuracy_holdout", part.samples, part.truth, split, note=note)


def _both(variant, touched, samples, number, kind="features"):
    """The random hold-out and the held-out regions of one kind of samples."""
    yield Trial(variant, "accuracy_holdout", samples, touched.truth, holdout(touched.truth, number), kind)
    yield _apart(variant, touched, samples, number, kind, side=kind == "located")


def _apart(variant, touched, samples, number, kind, side):
    """One region of each object held out; or, where positions are features, one side of all."""
    split = regions(touched.truth, touched.places, touched.width, number, side)
    metric, note = "accuracy_side" if side else "accuracy_apart", None if split else TOO_NEAR
    return Trial(variant, metric, samples, touched.truth, split, kind, note=note)


def _turned(touched, split, number):
    """Located samples whose test part stands turned about the vertical, each object by an angle of its own.

    The array keeps upright (stages.imprints.sensor_axes), so such a turn changes positions and not imprints, but for
    touches within 18 degrees of the poles.
    """
    angles = np.random.default_rng(number).uniform(0, 2 * np.pi, size=touched.truth.max() + 1)[touched.truth]
    angles[split[0]] = 0
    x, y, z = touched.places.T
    turned = [np.cos(angles) * x - np.sin(angles) * y, np.sin(angles) * x + np.cos(angles) * y, z]
    return np.column_stack([touched.samples, *turned])

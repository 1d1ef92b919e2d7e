"""The thesis's protocol of recognition by touch (T4.2.4): a quarter held out at random, five folds of the rest.

A split is standardised and reduced once for all classifiers.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.touch.skin import as_shares

from .classifiers import CLASSIFIERS, COMPONENTS, TRAINING, check_name, scaled
from .features import features
from .split import HOLDOUT, Split

VALIDITY = ("train_accuracy", "commonest_share")  # metrics that find a dead classifier


class Answers(NamedTuple):
    """Predictions for the test part, seconds, and the accuracy on the training part where it was asked for."""

    predicted: np.ndarray
    seconds: float
    train_accuracy: float | None

    @property
    def validity(self) -> list[dict]:
        """Rows that find a dead classifier: the accuracy on the training part, the share of the commonest answer."""
        share = np.unique(self.predicted, return_counts=True)[1].max() / len(self.predicted)
        values = zip(VALIDITY, (self.train_accuracy, float(share)), strict=True)
        return [{"metric": metric, "value": value} for metric, value in values]


@dataclass(frozen=True)
class Prepared:
    """The samples (k, d) and object numbers (k,) to train and to test on; seconds: the time to prepare them."""

    train: np.ndarray
    train_truth: np.ndarray
    test: np.ndarray
    test_truth: np.ndarray
    seconds: float

    @classmethod
    def from_split(
        cls,
        samples: np.ndarray,
        truth: np.ndarray,
        parts: tuple[np.ndarray, np.ndarray],
        kind: str = "features",
        scaling: str = TRAINING,
    ) -> "Prepared":
        """Scales and reduces the parts (train, test) of samples (n, d), of a kind and by a scaling of `reduction`."""
        train, test = (samples[part] for part in parts)
        with Stopwatch() as watch:
            train, test = scaled(train, test, kind, scaling)
        return cls(train, truth[parts[0]], test, truth[parts[1]], watch.seconds)

    def predict(self, name: str, random_state: int, with_training: bool = False) -> Answers:
        """The Answers of one classifier; their seconds include the preparation, as if it ran alone.

        with_training: whether it is asked about the training part, too; this takes no part in the seconds.
        """
        with Stopwatch() as watch:
            model = CLASSIFIERS[name](random_state).fit(self.train, self.train_truth)
            predicted = model.predict(self.test)
        right = float((model.predict(self.train) == self.train_truth).mean()) if with_training else None
        return Answers(predicted, self.seconds + watch.seconds, right)


FOLDS = 5  # T4.2.4
MIN_IMPRINTS = 10  # per object: with two objects a fold then still trains on the 12 samples that PCA needs


def evaluate(
    images_by_object: dict[str, np.ndarray], classifier: str, repetitions: int = 20, seed: int = 0
) -> list[dict]:
    """Accuracy of one classifier that recognises objects by a single imprint (T4.2.4).

    Parameters
    ----------
    images_by_object : dict of str to (k, rows, cols) array
        Imprints, bytes or numbers in 0..1, of two objects or more, at least 10 of each. Of every object as many are
        used, from the first, as the object with the fewest has.
    classifier : str
        A name of CLASSIFIERS.
    repetitions : int
        Number of repetitions, which differ in their random split and in the classifier's random numbers.
    seed : int
        Seed of both.

    Returns
    -------
    list of dict
        A row for each repetition and split: classifier, repetition, split (`random`: the quarter held out; `folds`:
        mean over five folds of the rest), metric (accuracy), value, and seconds (z-transform, components, training and
        prediction, without the features).

    Raises
    ------
    ValueError
        For too few objects, imprints or repetitions, invalid images or several sizes of them, or an unknown classifier.

    Examples
    --------
    >>> import numpy as np
    >>> from haptic_glance.know import evaluate
    >>> imprints = np.random.default_rng(0).random((2, 12, 16, 16))
    >>> rows = evaluate({"rough": imprints[0], "smooth": imprints[1] ** 8}, "knn", repetitions=1)
    >>> {row["split"]: row["value"] for row in rows}["random"]
    1.0
    """
    names = sorted(images_by_object)
    counts = {name: len(images_by_object[name]) for name in names}
    check_counts(counts)
    if repetitions < 1:
        raise ValueError(f"repetitions must be 1 or more, got {repetitions}")
    count = min(counts.values())
    samples = np.concatenate([_features(images_by_object[name][:count]) for name in names])
    if len(shapes := {np.shape(images)[1:] for images in images_by_object.values()}) > 1:
        raise ValueError(f"imprints of several arrays, {sorted(shapes)}, tell objects apart by their size alone")
    prepared = prepare(samples, np.repeat(np.arange(len(names)), count), repetitions, seed)
    rows, _ = evaluate_prepared(prepared, len(names), classifier, seed)
    return [row for row in rows if row["metric"] == "accuracy"]


def _features(images):
    images = np.asarray(images)
    samples = features(images / 255 if images.dtype == np.uint8 else images)
    as_shares(images)  # refuses other values, which would tell objects apart by their scale
    return samples


def prepare(
    samples: np.ndarray,
    truth: np.ndarray,
    repetitions: int,
    seed: int,
    places: np.ndarray | None = None,
    min_distance: float = 0.0,
) -> list[dict[Split, list[Prepared]]]:
    """The splits of each repetition, ready for `evaluate_prepared` with any classifier.

    samples (k, d): features; truth (k,): object numbers. places: (k, 3) positions of the imprints. With them two more
    splits show how optimistic the random hold-out is, see `draw_splits`.
    """
    prepared = []
    for repetition in range(repetitions):
        splits = draw_splits(truth, repetition_seed(seed, repetition), places, min_distance).items()
        prepared.append(
            {split: [Prepared.from_split(samples, truth, pair) for pair in parts] for split, parts in splits}
        )
    return prepared


def evaluate_prepared(
    prepared: list[dict[Split, list[Prepared]]], classes: int, name: str, seed: int
) -> tuple[list[dict], np.ndarray]:
    """(rows as `evaluate` gives them, confusion (n, n) i8) of the splits that `prepare` made with this seed.

    Further rows say whether a classifier is dead on the random hold-out: metrics train_accuracy and commonest_share.
    Values of a split are None if an object has no touch far enough. The confusion matrix sums the random hold-outs of
    all repetitions, true classes in rows.
    """
    check_name(name)
    rows, confusion = [], np.zeros((classes, classes), dtype=np.int64)
    for repetition, splits in enumerate(prepared):
        random_state = repetition_seed(seed, repetition)
        for split, parts in splits.items():
            row = {"classifier": name, "repetition": repetition, "split": split, "metric": "accuracy"}
            rows.append({**row, "value": None, "seconds": None})
            if not parts:
                continue
            held_out = split == Split.RANDOM
            outcomes = [part.predict(name, random_state, held_out) for part in parts]
            right = [(entry.predicted == part.test_truth).mean() for entry, part in zip(outcomes, parts, strict=True)]
            rows[-1] |= {"value": float(np.mean(right)), "seconds": sum(entry.seconds for entry in outcomes)}
            if held_out:
                rows += [{**row, **entry} for entry in outcomes[0].validity]
                np.add.at(confusion, (parts[0].test_truth, outcomes[0].predicted), 1)
    return rows, confusion


def repetition_seed(seed: int, repetition: int) -> int:
    """The seed of one repetition: equal for all classifiers and samplings, for paired comparisons."""
    return int(rng(seed, f"repetition {repetition}").integers(2**31))


def check_counts(counts: dict[str, int]) -> None:
    """Raises ValueError unless {object: number of imprints} has two objects or more with enough imprints each."""
    if len(counts) < 2:
        raise ValueError(f"at least two objects are needed, got {list(counts)}")
    fewest = min(counts, key=lambda name: counts[name])
    if counts[fewest] < MIN_IMPRINTS:
        raise ValueError(
            f"{fewest} has {counts[fewest]} imprints, each object needs {MIN_IMPRINTS}: touch it more often"
        )


def draw_splits(
    truth: np.ndarray, random_state: int, places: np.ndarray | None = None, min_distance: float = 0.0
) -> dict[Split, list[tuple[np.ndarray, np.ndarray]]]:
    """{split: its (train, test) indices}: a random hold-out, and five folds of what it trains on.

    With places (k, 3), `regions` holds out one region of each object too, see `region_holdout`. It trains on fewer
    samples, so `random_fewer` holds out a random quarter and trains on as many of the rest as `regions`. The difference
    of these two is the effect of overlap alone, since arrays that overlap measure nearly the same. Both have no indices
    if an object has no touch farther than min_distance from its region.
    """
    from sklearn.model_selection import StratifiedKFold

    train, test = random_holdout(truth, random_state)
    folds = StratifiedKFold(FOLDS, shuffle=True, random_state=random_state).split(train, truth[train])
    splits = {Split.RANDOM: [(train, test)], Split.FOLDS: [(train[fit], train[check]) for fit, check in folds]}
    if places is not None:
        apart = region_holdout(truth, places, min_distance, random_state)
        splits[Split.REGIONS] = [apart] if apart else []
        splits[Split.RANDOM_FEWER] = [_equal_size_holdout(truth, apart, random_state)] if apart else []
    return splits


def random_holdout(truth: np.ndarray, random_state: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test) indices, a random quarter of each class held out."""
    from sklearn.model_selection import train_test_split

    train, test = train_test_split(np.arange(len(truth)), test_size=HOLDOUT, stratify=truth, random_state=random_state)
    return np.asarray(train), np.asarray(test)


def region_holdout(
    truth: np.ndarray, places: np.ndarray, min_distance: float, random_state: int, side: bool = False
) -> tuple[np.ndarray, np.ndarray] | None:
    """(train, test) indices that share no touched surface, or None if too little is left to train on.

    One region of each object is held out: the quarter of its touches nearest to a random one of them; or with `side`
    the quarter farthest to one random side, the same for all objects. If the position is a feature, only the latter is
    fair: otherwise other objects were touched where this one was not, and its region resembles theirs. Training keeps
    only touches farther than `min_distance`, the array's width, from all of the region. (Four clusters without such a
    gap are nearly as optimistic as a random split, since arrays overlap across their borders.)
    Raises ValueError that names a class with too few touches to hold one of them out.
    """
    places, train, test = np.asarray(places), [], []
    random = np.random.default_rng(random_state)
    direction = random.normal(size=3) if side else None
    for label in np.unique(truth):
        members = np.flatnonzero(truth == label)
        if not (held_out := round(HOLDOUT * len(members))):
            raise ValueError(f"class {label} has {len(members)} touches: a region is held out of 3 or more")
        distances = np.linalg.norm(places[members][:, None] - places[members][None], axis=2)
        order = np.argsort(
            -places[members] @ direction if side else distances[random.integers(len(members))], kind="stable"
        )
        region, remaining = np.split(order, [held_out])
        test.append(members[region])
        train.append(members[remaining[(distances[remaining][:, region] > min_distance).all(axis=1)]])
    counts = [len(part) for part in train]
    if min(counts, default=0) == 0 or sum(counts) < COMPONENTS:
        return None
    return np.concatenate(train), np.concatenate(test)


def _equal_size_holdout(truth, split, random_state):
    """(train, test) with a random quarter held out, and as many of each class to train on as `split` has."""
    counts = np.bincount(truth[split[0]])
    train, test = random_holdout(truth, random_state)
    random = np.random.default_rng(random_state)
    train_ids = [random.permutation(train[truth[train] == label])[:count] for label, count in enumerate(counts)]
    return np.concatenate(train_ids), test

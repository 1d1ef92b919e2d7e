"""The thesis's protocol: a random hold-out of a quarter, five-fold cross-validation on the rest (T4.2.4)."""

import numpy as np

from stages.kit import Stopwatch
from stages.kit.rng import rng
from stages.kit.split import Split

from .classifiers import COMPONENTS, classifier
from .features import features

HOLDOUT = 0.25  # T4.2.4
FOLDS = 5  # T4.2.4
MIN_IMPRINTS = 10  # per object: with two objects a fold then still trains on the 12 samples that PCA needs


def evaluate(
    images_by_object: dict[str, np.ndarray], classifier: str, repetitions: int = 20, seed: int = 0
) -> list[dict]:
    """Accuracy of one classifier that recognises objects by a single imprint: a list of row dicts.

    images_by_object: {object: (k, rows, cols) in 0..1}, at least two objects, at least 10 imprints each; of every
    object as many are used, from the first, as the object with the fewest has. classifier: a name in CLASSIFIERS.
    A row holds classifier, repetition, split (random: the quarter held out; folds: mean over five folds of the rest),
    metric (accuracy), value and seconds (training and prediction, without the features). Repetitions differ in their
    random split and in the classifier's random numbers.
    Raises ValueError for too few objects or imprints, invalid images, or an unknown classifier.
    """
    names = sorted(images_by_object)
    counts = {name: len(images_by_object[name]) for name in names}
    check_counts(counts)
    count = min(counts.values())
    samples = np.concatenate([features(images_by_object[name][:count]) for name in names])
    return evaluate_features(samples, np.repeat(names, count), classifier, repetitions, seed)[0]


def evaluate_features(
    samples: np.ndarray,
    labels: np.ndarray,
    name: str,
    repetitions: int = 20,
    seed: int = 0,
    places: np.ndarray | None = None,
    min_distance: float = 0.0,
) -> tuple[list[dict], np.ndarray]:
    """The protocol on features (k, d) with labels (k,): (rows as `evaluate` gives them, confusion (n, n) i8).

    The confusion matrix sums the hold-outs of all repetitions, true classes in rows, both in alphabetical order.
    places: (k, 3) positions of the imprints. With them two more splits show how optimistic the random hold-out is,
    since arrays that overlap measure nearly the same. `regions` holds out one region of each object, see
    `region_holdout`. It trains on fewer samples, so `random_fewer` holds out a random quarter and trains on as many of
    the rest as `regions`. The difference of these two is the effect of overlap alone. Both are None if an object has no
    touch far enough.
    """
    classes, truth = np.unique(labels, return_inverse=True)
    confusion = np.zeros((len(classes), len(classes)), dtype=np.int64)
    rows = []
    for repetition in range(repetitions):
        random_state = repetition_seed(seed, repetition)
        train, test = random_holdout(truth, random_state)
        predicted, seconds = _fit_and_predict(name, random_state, samples, truth, train, test)
        np.add.at(confusion, (truth[test], predicted), 1)
        measured_by_split = {
            Split.RANDOM: ((predicted == truth[test]).mean(), seconds),
            Split.FOLDS: _cross_validate(name, random_state, samples, truth, train),
        }
        if places is not None:
            parts = region_holdout(truth, places, min_distance, random_state)
            measured_by_split[Split.REGIONS] = _accuracy(name, random_state, samples, truth, parts)
            measured_by_split[Split.RANDOM_FEWER] = _accuracy(
                name, random_state, samples, truth, parts and _equal_size_holdout(truth, parts, random_state)
            )
        common = {"classifier": name, "repetition": repetition}
        rows += [_row(common, split, *measured) for split, measured in measured_by_split.items()]
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


def _row(common, split, value, seconds):
    value = None if value is None else float(value)
    return {**common, "split": split, "metric": "accuracy", "value": value, "seconds": seconds}


def random_holdout(truth: np.ndarray, random_state: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test) indices, a random quarter of each class held out."""
    from sklearn.model_selection import train_test_split

    train, test = train_test_split(np.arange(len(truth)), test_size=HOLDOUT, stratify=truth, random_state=random_state)
    return np.asarray(train), np.asarray(test)


def _cross_validate(name, random_state, samples, truth, train):
    """(mean accuracy over the folds, seconds) of cross-validation within the training part."""
    from sklearn.model_selection import StratifiedKFold

    accuracies, total = [], 0.0
    for fit, check in StratifiedKFold(FOLDS, shuffle=True, random_state=random_state).split(train, truth[train]):
        predicted, seconds = _fit_and_predict(name, random_state, samples, truth, train[fit], train[check])
        accuracies.append((predicted == truth[train[check]]).mean())
        total += seconds
    return np.mean(accuracies), total


def _fit_and_predict(name, random_state, samples, truth, train, test):
    """(predictions for the test part of a classifier trained on the training part, seconds)."""
    with Stopwatch() as watch:
        predicted = classifier(name, random_state).fit(samples[train], truth[train]).predict(samples[test])
    return predicted, watch.seconds


def region_holdout(
    truth: np.ndarray, places: np.ndarray, min_distance: float, random_state: int, side: bool = False
) -> tuple[np.ndarray, np.ndarray] | None:
    """(train, test) indices that share no touched surface, or None if too little is left to train on.

    One region of each object is held out: the quarter of its touches nearest to a random one of them; or with `side`
    the quarter farthest to one random side, the same for all objects. If the position is a feature, only the latter is
    fair: otherwise other objects were touched where this one was not, and its region resembles theirs. Training keeps
    only touches farther than `min_distance`, the array's width, from all of the region. (Four clusters without such a
    gap are nearly as optimistic as a random split, since arrays overlap across their borders.)
    """
    places, train, test = np.asarray(places), [], []
    random = np.random.default_rng(random_state)
    direction = random.normal(size=3) if side else None
    for label in np.unique(truth):
        members = np.flatnonzero(truth == label)
        distances = np.linalg.norm(places[members][:, None] - places[members][None], axis=2)
        order = np.argsort(
            -places[members] @ direction if side else distances[random.integers(len(members))], kind="stable"
        )
        region, rest = np.split(order, [round(HOLDOUT * len(members))])
        test.append(members[region])
        train.append(members[rest[(distances[rest][:, region] > min_distance).all(axis=1)]])
    counts = [len(part) for part in train]
    if min(counts) == 0 or sum(counts) < COMPONENTS:
        return None
    return np.concatenate(train), np.concatenate(test)


def _equal_size_holdout(truth, other, random_state):
    """(train, test) with a random quarter held out, and as many of each class to train on as `other` has."""
    counts = np.bincount(truth[other[0]])
    train, test = random_holdout(truth, random_state)
    random = np.random.default_rng(random_state)
    kept = [random.permutation(train[truth[train] == label])[:count] for label, count in enumerate(counts)]
    return np.concatenate(kept), test


def _accuracy(name, random_state, samples, truth, parts):
    """(accuracy on the test part, seconds); (None, None) without parts."""
    if parts is None:
        return None, None
    predicted, seconds = _fit_and_predict(name, random_state, samples, truth, *parts)
    return (predicted == truth[parts[1]]).mean(), seconds

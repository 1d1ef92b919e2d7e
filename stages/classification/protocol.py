"""The thesis's protocol: a random hold-out of a quarter, five-fold cross-validation on the rest (T4.2.4)."""

import numpy as np

from stages.kit import Stopwatch
from stages.kit.rng import rng

from .classifiers import COMPONENTS, classifier
from .features import features

HOLDOUT = 0.25  # T4.2.4
FOLDS = 5  # T4.2.4
FEWEST = 10  # imprints an object: with two objects a fold then still trains on the 12 samples that PCA needs


def evaluate(images_by_object, classifier, repetitions=20, seed=0):
    """How well one classifier tells objects apart by a single imprint: a list of row dicts.

    images_by_object: {object: (k, rows, cols) in 0..1}, at least two objects, at least 10 imprints each; every object
    gives as many as the poorest has, its first ones. classifier: a name in CLASSIFIERS.
    A row holds classifier, repetition, metric (accuracy_holdout: rate of right answers on the quarter held out;
    accuracy_fivefold: mean over five folds of the rest), value and seconds (training and answering, without the
    features). Repetitions differ in their random split and in the classifier's own random numbers.
    Raises ValueError for too few objects or imprints, images that make no features, or an unknown classifier.
    """
    names = sorted(images_by_object)
    counts = {name: len(images_by_object[name]) for name in names}
    check_counts(counts)
    count = min(counts.values())
    samples = np.concatenate([features(images_by_object[name][:count]) for name in names])
    return evaluate_features(samples, np.repeat(names, count), classifier, repetitions, seed)[0]


def evaluate_features(samples, labels, name, repetitions=20, seed=0, places=None, apart=0.0):
    """The protocol on features (k, d) with labels (k,): (rows as `evaluate` gives them, confusion (n, n) i8).

    The confusion matrix sums the hold-outs of all repetitions, true classes in rows, both in alphabetical order.
    places: (k, 3) where each imprint was taken. With it two more metrics tell what the random hold-out flatters, since
    two arrays that overlap feel nearly the same. accuracy_apart holds out one region of each object, see `regions`.
    It trains on fewer samples, so accuracy_fewer holds out a random quarter and trains on as many of the rest as
    accuracy_apart did: the difference of these two is the overlap alone. None where an object has no touch far enough.
    """
    classes, truth = np.unique(labels, return_inverse=True)
    confusion = np.zeros((len(classes), len(classes)), dtype=np.int64)
    rows = []
    for repetition in range(repetitions):
        number = draw_number(seed, repetition)
        train, test = holdout(truth, number)
        answers, seconds = _answer(name, number, samples, truth, train, test)
        np.add.at(confusion, (truth[test], answers), 1)
        found = {
            "accuracy_holdout": ((answers == truth[test]).mean(), seconds),
            "accuracy_fivefold": _fivefold(name, number, samples, truth, train),
        }
        if places is not None:
            split = regions(truth, places, apart, number)
            found["accuracy_apart"] = _rate(name, number, samples, truth, split)
            found["accuracy_fewer"] = _rate(name, number, samples, truth, split and _as_few(truth, split, number))
        common = {"classifier": name, "repetition": repetition}
        rows += [_row(common, metric, *measured) for metric, measured in found.items()]
    return rows, confusion


def draw_number(seed, repetition):
    """The seed of one repetition: equal for all classifiers and samplings, so that they can be compared in pairs."""
    return int(rng(seed, f"repetition {repetition}").integers(2**31))


def check_counts(counts):
    """Raises ValueError unless {object: imprints} has two objects or more with enough imprints each."""
    if len(counts) < 2:
        raise ValueError(f"at least two objects are needed to tell apart, got {list(counts)}")
    poorest = min(counts, key=counts.get)
    if counts[poorest] < FEWEST:
        raise ValueError(f"{poorest} has {counts[poorest]} imprints, each object needs {FEWEST}: touch it more often")


def _row(common, metric, value, seconds):
    return {**common, "metric": metric, "value": None if value is None else float(value), "seconds": seconds}


def holdout(truth, number):
    """(train, test) indices, a random quarter of each class held out."""
    from sklearn.model_selection import train_test_split

    return train_test_split(np.arange(len(truth)), test_size=HOLDOUT, stratify=truth, random_state=number)


def _fivefold(name, number, samples, truth, train):
    """(mean accuracy over the folds, seconds) of cross-validation within the training part."""
    from sklearn.model_selection import StratifiedKFold

    rates, total = [], 0.0
    for fit, check in StratifiedKFold(FOLDS, shuffle=True, random_state=number).split(train, truth[train]):
        answers, seconds = _answer(name, number, samples, truth, train[fit], train[check])
        rates.append((answers == truth[train[check]]).mean())
        total += seconds
    return np.mean(rates), total


def _answer(name, number, samples, truth, train, test):
    """(answers on the test part of a classifier trained on the training part, seconds)."""
    with Stopwatch() as watch:
        answers = classifier(name, number).fit(samples[train], truth[train]).predict(samples[test])
    return answers, watch.seconds


def regions(truth, places, apart, number, side=False):
    """(train, test) indices that share no touched surface, or None where too little is left to train on.

    Held out is one region of each object: the quarter of its touches nearest to one of them, drawn by `number`; or with
    `side` the quarter that lies farthest to one side, the same for all objects. Where the position itself is a feature
    only the latter is fair: else other objects were touched where this one was not, and its region looks like theirs.
    Training keeps those touches alone that are farther than `apart`, the array's width, from all of the region. (Four
    clusters without such a gap flatter nearly as much as a random split: arrays overlap across their borders.)
    """
    places, train, test = np.asarray(places), [], []
    random = np.random.default_rng(number)
    direction = random.normal(size=3) if side else None
    for one in np.unique(truth):
        own = np.flatnonzero(truth == one)
        gaps = np.linalg.norm(places[own][:, None] - places[own][None], axis=2)
        order = np.argsort(-places[own] @ direction if side else gaps[random.integers(len(own))], kind="stable")
        region, rest = np.split(order, [round(HOLDOUT * len(own))])
        test.append(own[region])
        train.append(own[rest[(gaps[rest][:, region] > apart).all(axis=1)]])
    left = [len(part) for part in train]
    if min(left) == 0 or sum(left) < COMPONENTS:
        return None
    return np.concatenate(train), np.concatenate(test)


def _as_few(truth, split, number):
    """(train, test) with a random quarter held out, and as many of each class to train on as in another split."""
    counts = np.bincount(truth[split[0]])
    train, test = holdout(truth, number)
    random = np.random.default_rng(number)
    kept = [random.permutation(train[truth[train] == one])[:count] for one, count in enumerate(counts)]
    return np.concatenate(kept), test


def _rate(name, number, samples, truth, split):
    """(rate of right answers on the test part, seconds); (None, None) without a split."""
    if split is None:
        return None, None
    answers, seconds = _answer(name, number, samples, truth, *split)
    return (answers == truth[split[1]]).mean(), seconds

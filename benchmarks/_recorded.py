"""Recognition of real touches by the thesis's protocol, and what its random hold-out and its selection flatter."""

import numpy as np
from sklearn.model_selection import StratifiedKFold, cross_val_score, train_test_split

from stages.classification import CLASSIFIERS, classifier, features
from stages.classification.protocol import FEWEST, FOLDS, HOLDOUT
from stages.classification.similarity import shared, similarity
from stages.kit import Stopwatch
from stages.kit.rng import rng

COUNTS = {"six": 6, "four": 4}  # the first by the alphabet; as many at random; and those most alike
REPETITIONS = DRAWN = 20


def recognition(images, seed=0):
    """Rows of the five classifiers on {class: (k, rows, cols)}: all classes, the first six and four, and others.

    method: all touches; selected: without those that resemble a touch of another class of the set, taken out before
    the split as in the thesis; selected_training: taken out of the training part alone, judged on all others.
    metric: accuracy_holdout (a random quarter), accuracy_fivefold (within the rest), accuracy_blocked (a run of
    neighbouring numbers a class, a quarter of them); share_similar (touches that resemble one of another class).
    Sets: `six_drawn` and `four_drawn` are drawn anew in each repetition; `six_alike` and `four_alike` are the classes
    with the largest share of touches that resemble one of any other class.
    """
    names = sorted(images)
    labels = np.repeat(names, [len(images[name]) for name in names])
    samples = np.concatenate([features(images[name]) for name in names])
    alike = similarity(np.concatenate([images[name] for name in names]))
    resembling = shared(alike, labels)
    shares = {name: resembling[labels == name].mean() for name in names}
    ranked = sorted(names, key=lambda name: -shares[name])

    def judged(name, chosen, repetitions=range(REPETITIONS), folds=True):
        own = np.flatnonzero(np.isin(labels, chosen))
        return _one_set(name, samples[own], labels[own], alike[np.ix_(own, own)], repetitions, seed, folds)

    yield from judged("all", names)
    for name, count in COUNTS.items():
        yield from judged(name, names[:count])
        yield from judged(f"{name}_alike", ranked[:count])
        for k in range(DRAWN):
            drawn = rng(seed, f"{name} {k}").choice(names, count, replace=False)
            yield from judged(f"{name}_drawn", drawn, [k], folds=False)


def neighbours(images):
    """Rows: per class the mean correlation of touches with neighbouring numbers, and of any two of its touches."""
    for name, touches in images.items():
        found = np.corrcoef(touches.reshape(len(touches), -1))
        pairs = {"neighbour_correlation": np.diag(found, 1), "pair_correlation": found[np.triu_indices(len(found), 1)]}
        yield from ({"object": name, "metric": metric, "value": float(np.mean(v))} for metric, v in pairs.items())


def holdout(labels, number):
    """(train, test): a random quarter of each class, as stages.classification draws it."""
    return train_test_split(np.arange(len(labels)), test_size=HOLDOUT, stratify=labels, random_state=number)


def blocked(labels, number):
    """(train, test): of each class a run of neighbours, a quarter of its touches; the labels in the order of number."""
    random, train, test = np.random.default_rng(number), [], []
    for one in np.unique(labels):
        own = np.flatnonzero(labels == one)
        length = round(HOLDOUT * len(own))
        start = random.integers(len(own) - length + 1)
        test.append(own[start : start + length])
        train.append(np.delete(own, np.arange(start, start + length)))
    return np.concatenate(train), np.concatenate(test)


SPLITS = {"accuracy_holdout": holdout, "accuracy_blocked": blocked}


def _one_set(name, samples, labels, alike, repetitions, seed, folds):
    """Rows of one set: without selection, selected before the split, and in the training part alone."""
    common, chosen = {"object": name, "classes": len(np.unique(labels))}, " ".join(np.unique(labels))
    everything, kept = np.arange(len(labels)), np.flatnonzero(~shared(alike, labels))
    share = {"metric": "share_similar", "value": 1 - len(kept) / len(labels), "repetition": repetitions[0]}
    yield {**common, "chosen": chosen, "method": "all", **share}
    for method, own in (("all", everything), ("selected", kept), ("selected_training", everything)):
        counts = {one: int((labels[own] == one).sum()) for one in np.unique(labels)}
        poorest = min(counts, key=counts.get)
        if counts[poorest] < FEWEST:
            note = f"{poorest} keeps {counts[poorest]} touches, {FEWEST} are needed"
            yield {**common, "method": method, "metric": "accuracy_holdout", "repetition": repetitions[0], "note": note}
            continue
        mask = alike if method == "selected_training" else None
        for repetition in repetitions:
            number = int(rng(seed, f"repetition {repetition}").integers(2**31))
            rows = _judged(samples[own], labels[own], mask, number, folds)
            yield from ({**common, "method": method, "repetition": repetition, **row} for row in rows)


def _judged(samples, labels, alike, number, folds):
    for metric, split in SPLITS.items():
        train, test = split(labels, number)
        if alike is not None:
            train = train[~shared(alike[np.ix_(train, train)], labels[train])]
        for name in CLASSIFIERS:
            with Stopwatch() as watch:
                answers = classifier(name, number).fit(samples[train], labels[train]).predict(samples[test])
            row = {"metric": metric, "value": (answers == labels[test]).mean(), "seconds": watch.seconds}
            yield {"classifier": name, **row, "train": len(train), "test": len(test)}
    if folds and alike is None:
        for name in CLASSIFIERS:
            yield {"classifier": name, "metric": "accuracy_fivefold", "value": _fivefold(name, samples, labels, number)}


def _fivefold(name, samples, labels, number):
    train, _ = holdout(labels, number)
    folds = StratifiedKFold(FOLDS, shuffle=True, random_state=number)
    return cross_val_score(classifier(name, number), samples[train], labels[train], cv=folds).mean()

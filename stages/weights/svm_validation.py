"""How often an SVM on pixels is right: on folds drawn at random (T3.2.3), and on whole views or objects left out.

Pixels beside each other are alike, so that folds of pixels drawn at random test a model on the neighbours of what it
learned. The distance between the two figures is that leak.
"""

import numpy as np

from stages.kit.rng import rng

from .svm import MOST, balanced_rows, checked_rows, fit_rows

FOLDS = 10  # T3.2.3


def cross_validated(features, labels, seed, most=MOST):
    """(mean, deviation) of the accuracy over ten folds of rows drawn at random, the thesis's way (T3.2.3).

    Rows are balanced and cut to `most` first; the information gain is learned in each training part. Raises
    ValueError as fit_svm, and with fewer than two rows a class.
    """
    features, labels = checked_rows(features, labels, most)
    generator = rng(seed, "svm folds")
    chosen = balanced_rows(labels, generator, most)
    fold = np.zeros(len(labels), dtype=np.int64)
    for value in (True, False):
        ids = generator.permutation(chosen[labels[chosen] == value])
        fold[ids] = np.arange(len(ids)) % FOLDS
    return _validated(features[chosen], labels[chosen], fold[chosen])


def grouped_validated(features, labels, groups, seed, most=MOST):
    """(mean, deviation) of the accuracy on groups that the model has not seen: views or objects left out whole.

    groups (k,): what each row belongs to. Each group is balanced by itself, with an equal part of `most` at most, so
    that guessing gets 0.5 in each; one that holds a single class is left out. Up to ten groups are left out one by
    one, more in ten parts. Raises ValueError as fit_svm, and when fewer than two groups are left.
    """
    features, labels = checked_rows(features, labels, most)
    groups = np.asarray(groups)
    if groups.shape != labels.shape:
        raise ValueError(f"groups must name one group a row: shape {labels.shape}, got {groups.shape}")
    generator = rng(seed, "svm groups")
    members = [np.flatnonzero(groups == name) for name in np.unique(groups)]
    members = [ids for ids in members if 0 < labels[ids].sum() < len(ids)]
    if len(members) < 2:
        raise ValueError(f"only {len(members)} groups hold both salient and other rows: at least 2 are needed")
    share = max(most // len(members), 2)
    chosen = [ids[balanced_rows(labels[ids], generator, share)] for ids in members]
    part = generator.permutation(len(members)) % FOLDS
    rows = np.concatenate(chosen)
    return _validated(features[rows], labels[rows], np.repeat(part, [len(ids) for ids in chosen]))


def _validated(features, labels, fold):
    accuracies = []
    for number in np.unique(fold):
        held = fold == number
        if len(np.unique(labels[~held])) < 2:
            raise ValueError(f"{len(labels)} rows are too few to learn from after a fold is left out: mark more points")
        said = fit_rows(features[~held], labels[~held]).predict(features[held]) > 0.5
        accuracies.append((said == labels[held]).mean())
    return float(np.mean(accuracies)), float(np.std(accuracies))

"""The accuracy of the SVM on pixels, by random folds (T3.2.3), and on views or objects that are left out.

Neighbouring pixels are similar, so with random folds of pixels a model is tested on neighbours of its training pixels.
The difference between the two accuracies measures this leakage.
"""

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.look.weights.svm import MAX_ROWS, balanced_rows, checked_rows, fit_rows

FOLDS = 10  # T3.2.3


def cross_validated(
    features: np.ndarray, labels: np.ndarray, seed: int, max_rows: int = MAX_ROWS
) -> tuple[float, float]:
    """(mean, deviation) of the accuracy over ten random folds of rows, as in the thesis (T3.2.3).

    Rows are balanced and cut to `max_rows` first; the information gain is learned in each training part. Raises
    ValueError as fit_svm, and with fewer than two rows per class.
    """
    features, labels = checked_rows(features, labels, max_rows)
    generator = rng(seed, "svm folds")
    chosen = balanced_rows(labels, generator, max_rows)
    fold = np.zeros(len(labels), dtype=np.int64)
    for value in (True, False):
        ids = generator.permutation(chosen[labels[chosen] == value])
        fold[ids] = np.arange(len(ids)) % FOLDS
    return _validated(features[chosen], labels[chosen], fold[chosen])


def grouped_validated(
    features: np.ndarray, labels: np.ndarray, groups: np.ndarray, seed: int, max_rows: int = MAX_ROWS
) -> tuple[float, float]:
    """(mean, deviation) of the accuracy on groups that are left out of the training: views or objects.

    groups (k,): the group of each row. Each group is balanced by itself, to at most an equal part of `max_rows`, so
    that guessing has an accuracy of 0.5 in each. Groups with a single class are left out. Up to ten groups are tested
    one by one, more in ten parts. Raises ValueError as fit_svm, and when fewer than two groups remain.
    """
    features, labels = checked_rows(features, labels, max_rows)
    groups = np.asarray(groups)
    if groups.shape != labels.shape:
        raise ValueError(f"groups must have one group per row: shape {labels.shape}, got {groups.shape}")
    generator = rng(seed, "svm groups")
    members = [np.flatnonzero(groups == name) for name in np.unique(groups)]
    members = [ids for ids in members if 0 < labels[ids].sum() < len(ids)]
    if len(members) < 2:
        raise ValueError(f"only {len(members)} groups hold both salient and other rows: at least 2 are needed")
    share = max(max_rows // len(members), 2)
    chosen = [ids[balanced_rows(labels[ids], generator, share)] for ids in members]
    part = generator.permutation(len(members)) % FOLDS
    rows = np.concatenate(chosen)
    return _validated(features[rows], labels[rows], np.repeat(part, [len(ids) for ids in chosen]))


def _validated(features, labels, fold):
    accuracies = []
    for number in np.unique(fold):
        test = fold == number
        if len(np.unique(labels[~test])) < 2:
            raise ValueError(f"{len(labels)} rows are too few for training after a fold is left out: mark more points")
        predicted = fit_rows(features[~test], labels[~test]).predict(features[test]) > 0.5
        accuracies.append((predicted == labels[test]).mean())
    return float(np.mean(accuracies)), float(np.std(accuracies))

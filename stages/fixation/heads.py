"""Linear heads on the pooled maps of a frozen network, one a task, and how well they name the class."""

import warnings

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LogisticRegression
from threadpoolctl import threadpool_limits

from stages.kit import Stopwatch
from stages.kit.files import read_arrays, write_arrays
from stages.kit.rng import rng

from .backbone import read_pooled
from .split import hold_out, random_views

ITERATIONS = 200  # of the solver; the maps asked for do not need its last digits


def head(features, labels, penalty):
    """(weights (k, C), bias (k,)) of the softmax head that learned features (n, C) with labels (n,) in 0..k-1.

    Least cross-entropy with an L2 penalty on features of mean 0 and deviation 1; their scaling is folded into the
    weights, so that the head is one linear layer on the pooled maps. Of two classes the scores are opposite.
    """
    mean, spread = features.mean(axis=0), features.std(axis=0)
    spread = np.where(spread > 1e-6 * max(spread.max(), 1e-30), spread, np.inf)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)
        fit = LogisticRegression(C=penalty, max_iter=ITERATIONS).fit((features - mean) / spread, labels)
    weights, bias = fit.coef_, fit.intercept_
    if len(weights) == 1:
        weights, bias = np.concatenate([-weights, weights]) / 2, np.concatenate([-bias, bias]) / 2
    weights = weights / spread
    return weights, bias - weights @ mean


def scores(features, weights, bias):
    """(n, k) the scores before the softmax."""
    return features @ weights.T + bias


def teach(item, folder, settings, tasks, seed):
    """Teaches one head (`METHOD@TASK`); writes heads/METHOD/TASK.npz, returns the rows of its accuracy.

    The strength of the penalty is that of the best validation accuracy, the strongest of equals. The head that makes
    the maps is the one of the random split of views, the thesis's way.
    """
    method, task = item.split("@")
    classes, ids, features = gathered(folder, method, tasks[task])
    with threadpool_limits(1), Stopwatch() as watch:
        train, validation, test = random_views(len(ids), rng(seed, "fixation views"))
        tried = [right(features, ids, classes, train, validation, penalty) for penalty in settings.penalties]
        penalty = settings.penalties[int(np.argmax(tried))]
        names, numbers = np.unique(classes[ids][train], return_inverse=True)
        weights, bias = head(features[train], numbers, penalty)
    write_arrays(
        folder / "heads" / method / f"{task}.npz",
        weights=weights.astype(np.float32), bias=bias.astype(np.float32), classes=names,
    )  # fmt: skip
    found = names[scores(features[test], weights, bias).argmax(axis=1)]
    row = {"object": None, "method": method, "task": task, "view": None}
    rows = [
        row | {"split": "views", "metric": "accuracy", "value": float((found == classes[ids][test]).mean())},
        row | {"split": "views", "metric": "chance", "value": commonest(classes[ids], train, test)},
    ]
    rows[0]["seconds"] = watch.seconds
    with threadpool_limits(1):
        apart = unseen(features, ids, classes, settings.penalties, settings.folds, rng(seed, task))
    return rows + [row | one for one in apart]


def gathered(folder, method, known):
    """(classes (k,) str of the objects, ids (n,) object of each picture, features (n, C))."""
    parts = [read_pooled(folder, method, name) for name in known]
    return (
        np.array(list(known.values())),
        np.repeat(np.arange(len(parts)), [len(p) for p in parts]),
        np.concatenate(parts),
    )


def right(features, ids, classes, train, test, penalty):
    """The share of the test pictures whose class a head that learned from the others names."""
    names, numbers = np.unique(classes[ids[train]], return_inverse=True)
    found = names[scores(features[test], *head(features[train], numbers, penalty)).argmax(axis=1)]
    return float((found == classes[ids[test]]).mean())


def unseen(features, ids, classes, penalties, folds, generator):
    """Rows of the accuracy on objects never seen, over all objects whose class has another one.

    The penalty is chosen on the next part of the objects, by heads that saw neither.
    """
    fold = hold_out(classes, folds, generator)
    found = []
    numbers = np.unique(fold[fold >= 0])
    for number, following in zip(numbers, np.roll(numbers, -1), strict=True):
        train, test = np.flatnonzero(fold[ids] != number), np.flatnonzero(fold[ids] == number)
        if len(np.unique(classes[ids[train]])) > 1:
            kept, check = train[fold[ids[train]] != following], train[fold[ids[train]] == following]
            penalty = penalties[0]
            if len(check) and len(np.unique(classes[ids[kept]])) > 1:
                tried = [right(features, ids, classes, kept, check, one) for one in penalties]
                penalty = penalties[int(np.argmax(tried))]
            values = right(features, ids, classes, train, test, penalty), commonest(classes[ids], train, test)
            found.append((*values, len(test)))
    if not found:
        return [{"split": "objects", "metric": "accuracy", "value": None, "note": "each object is a class of its own"}]
    accuracy, chance, weights = np.array(found).T
    return [
        {"split": "objects", "metric": "accuracy", "value": float(np.average(accuracy, weights=weights))},
        {"split": "objects", "metric": "chance", "value": float(np.average(chance, weights=weights))},
    ]


def commonest(labels, train, test):
    """The accuracy of always naming the class that is commonest in training."""
    names, counts = np.unique(labels[train], return_counts=True)
    return float((labels[test] == names[counts.argmax()]).mean())


def read_head(folder, method, task):
    """(weights (k, C) f4, bias (k,) f4, classes (k,) names)."""
    stored = read_arrays(folder / "heads" / method / f"{task}.npz")
    return stored["weights"], stored["bias"], stored["classes"]

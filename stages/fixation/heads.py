"""Linear heads on the pooled maps of a frozen network, one per task, and their accuracy."""

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LogisticRegression
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch

from .backbone import read_pooled
from .options import Method
from .schema import Params
from .split import object_folds, random_views

ITERATIONS = 200  # of the solver; the maps do not need full convergence


def fit_head(features: np.ndarray, labels: np.ndarray, penalty: float) -> tuple[np.ndarray, np.ndarray]:
    """(weights (k, C), bias (k,)) of a softmax head fitted to features (n, C) with labels (n,) in 0..k-1.

    Minimises the cross-entropy with an L2 penalty on standardised features. The standardisation is folded into the
    weights, so that the head is one linear layer on the pooled maps. The scores of two classes are opposite. penalty:
    inverse strength of the regularisation.
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


def scores(features: np.ndarray, weights: np.ndarray, bias: np.ndarray) -> np.ndarray:
    """(n, k): the scores before the softmax."""
    return features @ weights.T + bias


def train_head(
    task: str,
    folder: Path,
    made: Path,
    method: Method,
    settings: Params,
    tasks: Mapping[str, Mapping[str, str]],
    seed: int,
) -> list[dict]:
    """Trains the head of one task and writes heads/METHOD/TASK.npz; returns rows of its accuracy.

    made: the folder of the pooled maps. The penalty is the one with the best validation accuracy, the strongest of
    equals. The maps come from the head of the random split of views, as in the thesis.
    """
    classes, ids, features = read_features(made, method.name, tasks[task])
    with threadpool_limits(1), Stopwatch() as watch:
        train, validation, test = random_views(len(ids), rng(seed, "fixation views"))
        tried = [head_accuracy(features, ids, classes, train, validation, penalty) for penalty in settings.penalties]
        penalty = settings.penalties[int(np.argmax(tried))]
        names, numbers = np.unique(classes[ids][train], return_inverse=True)
        weights, bias = fit_head(features[train], numbers, penalty)
    write_arrays(
        folder / "heads" / method.name / f"{task}.npz",
        weights=weights.astype(np.float32), bias=bias.astype(np.float32), classes=names,
    )  # fmt: skip
    found = names[scores(features[test], weights, bias).argmax(axis=1)]
    row = {"method": method.name, "task": task}
    rows = [
        row | {"split": "views", "metric": "accuracy", "value": float((found == classes[ids][test]).mean())},
        row | {"split": "views", "metric": "chance", "value": majority_accuracy(classes[ids], train, test)},
    ]
    rows[0]["seconds"] = watch.seconds
    with threadpool_limits(1):
        unseen = unseen_object_rows(features, ids, classes, settings.penalties, settings.folds, rng(seed, task))
    return rows + [row | one for one in unseen]


def read_features(folder: Path, method: str, known: Mapping[str, str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(class names (k,) of the objects, ids (n,) of the object of each picture, features (n, C) of the pictures)."""
    parts = [read_pooled(folder, method, name) for name in known]
    return (
        np.array(list(known.values())),
        np.repeat(np.arange(len(parts)), [len(p) for p in parts]),
        np.concatenate(parts),
    )


def head_accuracy(
    features: np.ndarray, ids: np.ndarray, classes: np.ndarray, train: np.ndarray, test: np.ndarray, penalty: float
) -> float:
    """The accuracy on the test pictures of a head fitted to the training pictures."""
    names, numbers = np.unique(classes[ids[train]], return_inverse=True)
    found = names[scores(features[test], *fit_head(features[train], numbers, penalty)).argmax(axis=1)]
    return float((found == classes[ids[test]]).mean())


def unseen_object_rows(
    features: np.ndarray,
    ids: np.ndarray,
    classes: np.ndarray,
    penalties: Sequence[float],
    folds: int,
    generator: np.random.Generator,
) -> list[dict]:
    """Rows of the accuracy on held-out objects, over all objects whose class has another one.

    The penalty is chosen on the next fold, by heads that are trained on neither.
    """
    fold = object_folds(classes, folds, generator)
    found = []
    numbers = np.unique(fold[fold >= 0])
    for number, following in zip(numbers, np.roll(numbers, -1), strict=True):
        train, test = np.flatnonzero(fold[ids] != number), np.flatnonzero(fold[ids] == number)
        if len(np.unique(classes[ids[train]])) > 1:
            kept, check = train[fold[ids[train]] != following], train[fold[ids[train]] == following]
            penalty = penalties[0]
            if len(check) and len(np.unique(classes[ids[kept]])) > 1:
                tried = [head_accuracy(features, ids, classes, kept, check, one) for one in penalties]
                penalty = penalties[int(np.argmax(tried))]
            values = (
                head_accuracy(features, ids, classes, train, test, penalty),
                majority_accuracy(classes[ids], train, test),
            )
            found.append((*values, len(test)))
    if not found:
        return [{"split": "objects", "metric": "accuracy", "value": None, "note": "each object is a class of its own"}]
    accuracy, chance, weights = np.array(found).T
    return [
        {"split": "objects", "metric": "accuracy", "value": float(np.average(accuracy, weights=weights))},
        {"split": "objects", "metric": "chance", "value": float(np.average(chance, weights=weights))},
    ]


def majority_accuracy(labels: np.ndarray, train: np.ndarray, test: np.ndarray) -> float:
    """The test accuracy of always predicting the most common class of the training pictures."""
    names, counts = np.unique(labels[train], return_counts=True)
    return float((labels[test] == names[counts.argmax()]).mean())


def read_head(folder: Path, method: str, task: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(weights (k, C) f4, bias (k,) f4, class names (k,)) of a trained head."""
    stored = read_arrays(folder / "heads" / method / f"{task}.npz")
    return stored["weights"], stored["bias"], stored["classes"]

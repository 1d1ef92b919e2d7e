"""Splits of recorded touches, at random or in blocks of time, and the classifiers of touches over time.

Features are the logarithm of the counts of each cell in bins of time: a neuron with a long time constant holds such
counts. Linear discriminant analysis with a shrunk covariance (Ledoit and Wolf 2004; Friedman 1989) is the one linear
classifier here that knows which differences two touches of the same object have.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from sklearn.decomposition import PCA
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis
from sklearn.model_selection import RepeatedStratifiedKFold, train_test_split
from sklearn.pipeline import make_pipeline
from sklearn.svm import SVC

from haptic_glance.base.rng import rng
from haptic_glance.know import CLASSIFIERS, classifier
from haptic_glance.know.classifiers import COMPONENTS
from haptic_glance.know.protocol import HOLDOUT
from haptic_glance.know.split import Split

BINS = (1, 5, 10, 20, 40)  # tried: the whole touch to parts of 6 to 8 steps
FOLDS = 5


def discriminant(shrinkage: float, count: int) -> Any:
    """Linear discriminant analysis, after a rotation to as many axes as there are touches, which loses nothing."""
    return make_pipeline(PCA(svd_solver="full"), LinearDiscriminantAnalysis("lsqr", shrinkage=shrinkage))


def linear_svm(softness: float, count: int) -> Any:
    """A linear support vector machine, one class against another."""
    return SVC(kernel="linear", C=softness)


def of_thesis(name: str, _: None, count: int) -> Any:
    """One of T4's five, on its twelve components, or on the features where these are fewer."""
    return classifier(name, kind="features" if count > COMPONENTS else "reduced")


# method -> (factory of its parameter and the number of features, the parameters that are tried)
METHODS: dict[str, tuple[Callable[[Any, int], Any], Sequence[Any]]] = {
    "discriminant": (discriminant, (0.03, 0.1, 0.3, 0.6)),
    "linear_svm": (linear_svm, (0.01, 0.1, 1.0)),
    **{name: (partial(of_thesis, name), (None,)) for name in CLASSIFIERS},
}

LINEAR = ("discriminant", "linear_svm")  # methods to which a rotation of the features makes no difference


class Choice(NamedTuple):
    """A method, the bins and the parameter that cross-validation chose, and its accuracy there."""

    method: str
    bins: int
    parameter: Any
    accuracy: float

    def fitted(self, values: np.ndarray, labels: np.ndarray) -> Any:
        """The classifier, trained on features."""
        return METHODS[self.method][0](self.parameter, values.shape[1]).fit(values, labels)


def binned(values: np.ndarray, bins: int, heard: float = 1.0) -> np.ndarray:
    """(n, cells * channels * bins heard) f8: log(1 + sum) of touches (n, cells, channels, t) in parts of equal length.

    heard: the share of the steps, from the first, that is there; the last of the bins may be cut short.
    """
    steps = values.shape[-1]
    length = round(steps * heard)
    starts = np.linspace(0, steps, bins + 1).round().astype(int)[:-1]
    sums = np.add.reduceat(values[..., :length], starts[starts < length], axis=-1, dtype=np.float64)
    return np.log1p(sums).reshape(len(values), -1)


def foldings(labels: np.ndarray, repetitions: int, seed: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """(train, test) ids of five folds with as much of each class, several times over."""
    folds = RepeatedStratifiedKFold(n_splits=FOLDS, n_repeats=repetitions, random_state=seed)
    return list(folds.split(labels, labels))


def choose(method: str, values: np.ndarray, labels: np.ndarray, repetitions: int, seed: int) -> Choice:
    """The bins and parameter with the highest cross-validated accuracy on touches (n, cells, channels, t).

    Of equals, the fewest bins. Nothing but these touches is looked at.
    """
    folds = foldings(labels, repetitions, seed)
    candidates = []
    for bins in BINS:
        features = binned(values, bins)
        candidates += _tried(method, bins, rotated(features) if method in LINEAR else features, labels, folds)
    return max(candidates, key=lambda choice: choice.accuracy)


def rotated(features: np.ndarray) -> np.ndarray:
    """(n, n at most): the same points about their mean, on no more axes than there are points; all distances stay."""
    axes, lengths, _ = np.linalg.svd(features - features.mean(axis=0), full_matrices=False)
    return axes * lengths


def _tried(
    method: str, bins: int, features: np.ndarray, labels: np.ndarray, folds: list[tuple[np.ndarray, np.ndarray]]
) -> Iterator[Choice]:
    for parameter in METHODS[method][1]:
        choice = Choice(method, bins, parameter, np.nan)
        right = [
            (choice.fitted(features[train], labels[train]).predict(features[test]) == labels[test]).mean()
            for train, test in folds
        ]
        yield choice._replace(accuracy=float(np.mean(right)))


def split_number(seed: int, repetition: int) -> int:
    """The seed of one repetition's split: all stages on recorded touches split the same way."""
    return int(rng(seed, f"repetition {repetition}").integers(2**31))


def random_split(labels: np.ndarray, number: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test): a random quarter of each class, as stages.classification draws it."""
    parts = train_test_split(np.arange(len(labels)), test_size=HOLDOUT, stratify=labels, random_state=number)
    return np.asarray(parts[0]), np.asarray(parts[1])


def block_split(labels: np.ndarray, number: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test): of each class a run of neighbours, a quarter of its touches; the labels in order of recording."""
    random, train, test = np.random.default_rng(number), [], []
    for label in np.unique(labels):
        ids = np.flatnonzero(labels == label)
        length = round(HOLDOUT * len(ids))
        start = random.integers(len(ids) - length + 1)
        test.append(ids[start : start + length])
        train.append(np.delete(ids, np.arange(start, start + length)))
    return np.concatenate(train), np.concatenate(test)


SPLITS = {Split.RANDOM: random_split, Split.BLOCKS: block_split}

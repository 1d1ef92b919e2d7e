"""The conventional classifiers of T table 4.9, with and without a self-organising map, and selection of features.

Features are selected by information gain before the map (T4.4.9, T4.4.10).
"""

from typing import NamedTuple

import numpy as np
from scipy.special import rel_entr
from sklearn.base import BaseEstimator, ClassifierMixin, TransformerMixin
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.self_organising_map import NEURONS, SelfOrganisingMap

NEIGHBOURS = 10  # T4.4.10
MAP_DIMENSIONS = (2, 3, 4, 5, 6)  # tried as dimensions of the map, T4.4.9


class TenNearestNeighbours(ClassifierMixin, BaseEstimator):
    """The most frequent label of the ten training samples at the least Euclidean distance, or of all if fewer."""

    def fit(self, samples: np.ndarray, labels: np.ndarray) -> "TenNearestNeighbours":
        """Stores the training samples (k, d) and labels (k,)."""
        self.nearest_ = KNeighborsClassifier(min(NEIGHBOURS, len(samples))).fit(samples, labels)
        self.classes_ = self.nearest_.classes_
        return self

    def predict(self, samples: np.ndarray) -> np.ndarray:
        """(k,) labels."""
        return self.nearest_.predict(samples)


def knn(reduced: bool) -> TenNearestNeighbours:
    """Ten nearest neighbours (T4.4.10)."""
    return TenNearestNeighbours()


def svm(reduced: bool) -> SVC:
    """Radial basis functions, gamma 1, C 1, tolerance 0.5 (the thesis's epsilon, as in T4.2.4).

    Gamma 1 suits the few numbers of the map. Without the map (reduced=False) there are twenty standardised features,
    and with gamma 1 every test sample would be far from all others. Gamma is then one over the number of features.
    """
    gamma = 1.0 if reduced else "auto"
    return SVC(kernel="rbf", gamma=gamma, C=1.0, tol=0.5)  # type: ignore[arg-type]  # inferred as str


ESTIMATORS = {"knn": knn, "svm": svm}
CONVENTIONAL = ("knn", "svm", "knn_no_som", "svm_no_som")


class Mapped(NamedTuple):
    """Samples (k, d) to train and to test on, after the map of some number of dimensions; seconds: the time taken."""

    train: np.ndarray
    test: np.ndarray
    seconds: float


class Reduced:
    """Features to train and to test on: information gain, z-score, map, z-score, made once for all classifiers.

    samples (k, d), labels (k,); train, test: indices. Every step is fitted to the training samples.
    """

    def __init__(self, samples: np.ndarray, labels: np.ndarray, train: np.ndarray, test: np.ndarray) -> None:
        self.train_labels, self.test_labels = labels[train], labels[test]
        steps = make_pipeline(MostInformative(), StandardScaler())
        with Stopwatch() as watch:
            selected = steps.fit_transform(samples[train], self.train_labels), steps.transform(samples[test])
        self._selected, self._mapped = Mapped(*selected, watch.seconds), {}

    def mapped(self, dimensions: int | None) -> Mapped:
        """The samples on a map of that many dimensions, the seconds as if made alone; None: without a map."""
        if dimensions is None:
            return self._selected
        if dimensions not in self._mapped:
            train, test, seconds = self._selected
            steps = make_pipeline(SelfOrganisingMap(dimensions, NEURONS), StandardScaler())
            with Stopwatch() as watch:
                placed = steps.fit_transform(train), steps.transform(test)
            self._mapped[dimensions] = Mapped(*placed, seconds + watch.seconds)
        return self._mapped[dimensions]

    def predict(self, name: str, dimensions: int | None) -> tuple[np.ndarray, float]:
        """(predictions for the test samples, seconds with those of the steps before) of one of CONVENTIONAL."""
        train, test, seconds = self.mapped(dimensions)
        with Stopwatch() as watch:
            estimator = ESTIMATORS[name.removesuffix("_no_som")](dimensions is not None)
            predicted = estimator.fit(train, self.train_labels).predict(test)
        return predicted, seconds + watch.seconds


def choose_dimensions(name: str, validation: Reduced) -> tuple[int, float]:
    """(the number in MAP_DIMENSIONS with the highest accuracy on the test samples of `validation`, seconds).

    Of equal accuracies the smallest counts. The samples are to be a split of the training samples: the thesis does not
    say on which data it chose, and choosing on the test samples would be optimistic.
    """
    answers, seconds = zip(*(validation.predict(name, dimensions) for dimensions in MAP_DIMENSIONS), strict=True)
    accuracies = [(answer == validation.test_labels).mean() for answer in answers]
    return MAP_DIMENSIONS[accuracies.index(max(accuracies))], sum(seconds)


KEPT = 20  # features with the most information; the thesis gives no number
DECIMALS = 12  # of a gain
BINS = 10  # equally filled bins of a feature, for its information gain


class MostInformative(TransformerMixin, BaseEstimator):
    """Keeps the features (columns) with the highest information gain about the class, in falling order.

    The gain is the mutual information, in nats, of the class and the feature in ten equally filled bins, whose edges
    are quantiles of the training samples.
    """

    def __init__(self, count: int = KEPT) -> None:
        self.count = count

    def fit(self, samples: np.ndarray, labels: np.ndarray) -> "MostInformative":
        """Fits to samples (k, d), finite, and labels (k,)."""
        samples = np.asarray(samples, dtype=np.float64)
        cuts = np.quantile(samples, np.arange(1, BINS) / BINS, axis=0).T
        parts = [np.searchsorted(cut, column, side="right") for cut, column in zip(cuts, samples.T, strict=True)]
        self.gains_ = mutual_information(np.stack(parts, axis=1), labels)
        # Rounding errors do not rank equal gains.
        self.chosen_ = np.argsort(-self.gains_.round(DECIMALS), kind="stable")[: self.count]
        return self

    def transform(self, samples: np.ndarray) -> np.ndarray:
        """(k, count): the selected columns."""
        return np.asarray(samples, dtype=np.float64)[:, self.chosen_]


def mutual_information(parts: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """(d,) mutual information, in nats, of each column of parts (k, d) i8 in 0..BINS - 1 with the labels (k,)."""
    classes, numbers = np.unique(labels, return_inverse=True)
    columns = np.arange(parts.shape[1])
    cells = (columns * BINS + parts) * len(classes) + numbers[:, None]
    counts = np.bincount(cells.ravel(), minlength=columns.size * BINS * len(classes))
    joint = counts.reshape(-1, BINS, len(classes)) / len(parts)
    independent = joint.sum(axis=2, keepdims=True) * joint.sum(axis=1, keepdims=True)
    return rel_entr(joint, independent).sum(axis=(1, 2))

"""The two conventional classifiers of T table 4.9, with and without a self-organising map."""

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from stages.kit.self_organising_map import NEURONS, SelfOrganisingMap

from .reduction import MostInformative

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


def selection() -> Pipeline:
    """Keeps the features with the most information about the class, and standardises them."""
    return make_pipeline(MostInformative(), StandardScaler())


def classifier(name: str, dimensions: int | None) -> Pipeline:
    """The pipeline of one of CONVENTIONAL: information gain, z-score, map of `dimensions`, z-score, classifier.

    dimensions None: no map. Every step is fitted to the samples that `fit` is given.
    """
    return make_pipeline(selection(), _after_selection(name, dimensions))


def choose_dimensions(
    name: str, samples: np.ndarray, labels: np.ndarray, fit: np.ndarray, validation: np.ndarray
) -> int:
    """The number in MAP_DIMENSIONS with the highest accuracy on `validation` when trained on `fit`.

    Of equal accuracies the smallest counts. samples (k, d), labels (k,); fit and validation are disjoint indices of
    training samples. The thesis does not say on which data it chose. Choosing on the test samples would be optimistic.
    """
    selected = selection().fit(samples[fit], labels[fit])
    fit_samples, validation_samples = selected.transform(samples[fit]), selected.transform(samples[validation])
    accuracies = [
        _after_selection(name, dimensions).fit(fit_samples, labels[fit]).score(validation_samples, labels[validation])
        for dimensions in MAP_DIMENSIONS
    ]
    return MAP_DIMENSIONS[accuracies.index(max(accuracies))]


def _after_selection(name, dimensions):
    estimator = ESTIMATORS[name.removesuffix("_no_som")](dimensions is not None)
    if dimensions is None:
        return estimator
    return make_pipeline(SelfOrganisingMap(dimensions, NEURONS), StandardScaler(), estimator)

"""The two conventional classifiers of T table 4.9, with and without the self-organising map."""

from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from .reduction import MostInformative
from .som import SelfOrganisingMap

NEIGHBOURS = 10  # T4.4.10
SIZES = (2, 3, 4, 5, 6)  # dimensions of the map that are tried, T4.4.9


class Neighbours(ClassifierMixin, BaseEstimator):
    """The commonest label among the ten nearest training samples, Euclidean; among all where there are fewer."""

    def fit(self, samples, labels):
        """Remembers samples (k, d) and labels (k,)."""
        self.nearest_ = KNeighborsClassifier(min(NEIGHBOURS, len(samples))).fit(samples, labels)
        self.classes_ = self.nearest_.classes_
        return self

    def predict(self, samples):
        """(k,) labels."""
        return self.nearest_.predict(samples)


def knn(reduced):
    """Ten nearest neighbours (T4.4.10)."""
    return Neighbours()


def svm(reduced):
    """Radial basis functions, gamma 1, C 1, tolerance 0.5 (the thesis's epsilon, as in T4.2.4).

    Gamma 1 fits the few numbers of the map. Without it (reduced=False) twenty standardised features lie so far apart
    that every test sample is far from all others: gamma is then one over their number.
    """
    return SVC(kernel="rbf", gamma=1.0 if reduced else "auto", C=1.0, tol=0.5)


ESTIMATORS = {"knn": knn, "svm": svm}
CONVENTIONAL = ("knn", "svm", "knn_no_som", "svm_no_som")


def selection():
    """The features with the most information, standardised."""
    return make_pipeline(MostInformative(), StandardScaler())


def classifier(name, dimensions):
    """The whole pipeline of one of CONVENTIONAL: information gain, z-score, map of `dimensions`, z-score, classifier.

    dimensions None: no map. Everything is learned from the samples that `fit` is given.
    """
    return make_pipeline(selection(), _behind_selection(name, dimensions))


def choose_size(name, samples, labels, fit, check):
    """The size of the map, of SIZES, that is right most often on `check` when trained on `fit`; the first of equals.

    samples (k, d), labels (k,), fit and check: disjoint ids of training samples. The thesis names no data to choose on;
    the test samples would flatter.
    """
    selected = selection().fit(samples[fit], labels[fit])
    known, asked = selected.transform(samples[fit]), selected.transform(samples[check])
    rates = [_behind_selection(name, size).fit(known, labels[fit]).score(asked, labels[check]) for size in SIZES]
    return SIZES[rates.index(max(rates))]


def _behind_selection(name, dimensions):
    estimator = ESTIMATORS[name.removesuffix("_no_som")](dimensions is not None)
    if dimensions is None:
        return estimator
    return make_pipeline(SelfOrganisingMap(dimensions), StandardScaler(), estimator)

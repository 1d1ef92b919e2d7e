"""The four classifiers of T figure 4.11 (T4.3.1)."""

from sklearn.ensemble import BaggingClassifier
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from haptic_glance.know.network import FeedForward

TREES = 50  # T4.3.1 bags its trees and gives no number
ITERATIONS = 100_000  # of the SVM; a thousand touches usually need a few thousand
EPOCHS = 30  # T4.3.1 gives none; the loss is constant by then


def knn(seed: int = 0) -> KNeighborsClassifier:
    """The nearest sample by Euclidean distance; T4.3.1 gives no number of neighbours, T4.2.4 gives one."""
    return KNeighborsClassifier(n_neighbors=1)


def svm(seed: int = 0) -> SVC:
    """Support vector machine with a quadratic kernel, by sequential minimal optimisation.

    Some imprints make libsvm's steps run in a circle: it then stops at ITERATIONS, with scikit-learn's warning.
    """
    return SVC(kernel="poly", degree=2, coef0=1.0, gamma="scale", max_iter=ITERATIONS)


def decision_tree(seed: int = 0) -> BaggingClassifier:
    """Bootstrap-aggregated decision trees (Breiman 1996)."""
    return BaggingClassifier(n_estimators=TREES, random_state=seed)


def deep_learning(seed: int = 0) -> Pipeline:
    """The rectified network of T4.2.4 on standardised components; T4.3.1 gives no other sizes."""
    return make_pipeline(StandardScaler(), FeedForward(hidden=(50, 50), epochs=EPOCHS, seed=seed))


CLASSIFIERS = {"knn": knn, "svm": svm, "decision_tree": decision_tree, "deep_learning": deep_learning}


def classifier(name: str, seed: int = 0) -> KNeighborsClassifier | SVC | BaggingClassifier | Pipeline:
    """The estimator of one classifier. Raises ValueError for a name that is not in CLASSIFIERS."""
    if name not in CLASSIFIERS:
        raise ValueError(f"unknown classifier {name}: choose one of {', '.join(CLASSIFIERS)}")
    return CLASSIFIERS[name](seed)

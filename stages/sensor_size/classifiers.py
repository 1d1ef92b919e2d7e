"""The four classifiers of T figure 4.11 (T4.3.1)."""

from stages.classification.network import FeedForward

TREES = 50  # T4.3.1 bags its trees and gives no number
EPOCHS = 30  # T4.3.1 gives none; the loss has settled by then


def knn(seed=0):
    """The nearest sample by Euclidean distance; T4.3.1 gives no number of neighbours, T4.2.4 gives one."""
    from sklearn.neighbors import KNeighborsClassifier

    return KNeighborsClassifier(n_neighbors=1)


def svm(seed=0):
    """Support vectors with a quadratic kernel, by sequential minimal optimisation."""
    from sklearn.svm import SVC

    return SVC(kernel="poly", degree=2, coef0=1.0, gamma="scale")


def decision_tree(seed=0):
    """Bootstrap-aggregated decision trees (Breiman 1996)."""
    from sklearn.ensemble import BaggingClassifier

    return BaggingClassifier(n_estimators=TREES, random_state=seed)


def deep_learning(seed=0):
    """The rectified network of T4.2.4, on standardised components: T4.3.1 gives no sizes of its own."""
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    return make_pipeline(StandardScaler(), FeedForward(hidden=(50, 50), epochs=EPOCHS, seed=seed))


CLASSIFIERS = {"knn": knn, "svm": svm, "decision_tree": decision_tree, "deep_learning": deep_learning}


def classifier(name, seed=0):
    """The estimator of one classifier. Raises ValueError for a name that is not in CLASSIFIERS."""
    if name not in CLASSIFIERS:
        raise ValueError(f"no classifier of the sensor's size is called {name}: there are {', '.join(CLASSIFIERS)}")
    return CLASSIFIERS[name](seed)

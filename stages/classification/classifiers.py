"""The five classifiers of T tables 4.1 and 4.2 with the thesis's settings (T4.2.4)."""

import difflib

COMPONENTS = 12  # T4.2.3.4
KINDS = ("features", "located", "reduced")  # what a sample may be


def knn(seed=0):
    """The nearest sample by Euclidean distance."""
    from sklearn.neighbors import KNeighborsClassifier

    return KNeighborsClassifier(n_neighbors=1)


def svm(seed=0):
    """Support vectors, radial basis functions; the thesis's epsilon is the tolerance of the optimiser.

    Gamma 1 is narrow for twelve components whose variances add up to about 40: most samples are far from all others.
    """
    from sklearn.svm import SVC

    return SVC(kernel="rbf", gamma=1.0, C=1.5, tol=0.001)


def decision_tree(seed=0):
    """A tree of depth 10 that splits by Gini impurity.

    The thesis splits by RapidMiner's `accuracy`, for which scikit-learn has no criterion; Gini impurity is its default.
    """
    from sklearn.tree import DecisionTreeClassifier

    return DecisionTreeClassifier(criterion="gini", max_depth=10, random_state=seed)


def naive_bayes(seed=0):
    """One normal density a feature and class."""
    from sklearn.naive_bayes import GaussianNB

    return GaussianNB()


def deep_learning(seed=0):
    """Two rectified layers of 50, Adadelta, 10 epochs."""
    from .network import FeedForward

    return FeedForward(hidden=(50, 50), epochs=10, seed=seed)


CLASSIFIERS = {
    "knn": knn,
    "svm": svm,
    "decision_tree": decision_tree,
    "naive_bayes": naive_bayes,
    "deep_learning": deep_learning,
}


def classifier(name, seed=0, kind="features"):
    """The whole scikit-learn pipeline of one classifier: z-transform, 12 principal components, the classifier.

    kind: what the samples are. "features": those of `features`, at least 12 samples. "located": the same with the
    position of the touch in three more columns, the last ones; they are standardised too, and join the components
    behind the PCA, which else would spread them over all components. "reduced": numbers that need no further
    reduction, such as the two of a TouchMap; only standardised.
    The thesis standardises the entire data beforehand (T4.2.4); here the z-transform and the components are learned
    from the samples that `fit` is given, so that nothing of the hold-out leaks into training.
    Raises ValueError for a name that is not in CLASSIFIERS, or another kind.
    """
    from sklearn.compose import make_column_transformer
    from sklearn.decomposition import PCA
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    check_name(name)
    if kind not in KINDS:
        raise ValueError(f"kind is one of {', '.join(KINDS)}, got {kind!r}")
    components = [StandardScaler(), PCA(COMPONENTS, svd_solver="full")]
    if kind == "reduced":
        components = components[:1]
    if kind == "located":
        touch, place = (make_pipeline(*components), slice(0, -3)), (StandardScaler(), slice(-3, None))
        components = [make_column_transformer(touch, place)]
    return make_pipeline(*components, CLASSIFIERS[name](seed))


def check_name(name):
    """Raises ValueError, with the nearest right name, for one that is not in CLASSIFIERS."""
    if name not in CLASSIFIERS:
        near = difflib.get_close_matches(name, CLASSIFIERS, n=1)
        hint = f"did you mean {near[0]}?" if near else f"there are: {', '.join(CLASSIFIERS)}"
        raise ValueError(f"no classifier is called {name}: {hint}")

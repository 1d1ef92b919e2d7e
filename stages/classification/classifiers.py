"""The five classifiers of T tables 4.1 and 4.2 with the thesis's settings (T4.2.4)."""

import difflib
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sklearn.base import ClassifierMixin
    from sklearn.pipeline import Pipeline

COMPONENTS = 12  # T4.2.3.4
KINDS = ("features", "located", "reduced")  # of samples


def knn(seed: int = 0) -> "ClassifierMixin":
    """The nearest sample by Euclidean distance."""
    from sklearn.neighbors import KNeighborsClassifier

    return KNeighborsClassifier(n_neighbors=1)


def svm(seed: int = 0) -> "ClassifierMixin":
    """Support vector machine with radial basis functions; the thesis's epsilon is the optimiser's tolerance.

    Gamma 1 is narrow for twelve components whose variances add up to about 40: most samples are far from all others.
    The kernel is computed for all pairs at once, in a third of the time that libsvm takes pair by pair.
    """
    from sklearn.metrics.pairwise import rbf_kernel
    from sklearn.svm import SVC

    kernel = partial(rbf_kernel, gamma=1.0)
    return SVC(kernel=kernel, C=1.5, tol=0.001)  # type: ignore[arg-type]  # its stub knows words alone


def decision_tree(seed: int = 0) -> "ClassifierMixin":
    """A decision tree of depth 10 with Gini impurity.

    The thesis uses RapidMiner's criterion `accuracy`, which scikit-learn does not have; Gini impurity is its default.
    """
    from sklearn.tree import DecisionTreeClassifier

    return DecisionTreeClassifier(criterion="gini", max_depth=10, random_state=seed)


def naive_bayes(seed: int = 0) -> "ClassifierMixin":
    """One normal density per feature and class."""
    from sklearn.naive_bayes import GaussianNB

    return GaussianNB()


def deep_learning(seed: int = 0) -> "ClassifierMixin":
    """Two rectified layers of 50 units, Adadelta, 10 epochs."""
    from .network import FeedForward

    return FeedForward(hidden=(50, 50), epochs=10, seed=seed)


CLASSIFIERS: dict[str, Callable[[int], Any]] = {
    "knn": knn,
    "svm": svm,
    "decision_tree": decision_tree,
    "naive_bayes": naive_bayes,
    "deep_learning": deep_learning,
}


def classifier(name: str, seed: int = 0, kind: str = "features") -> "Pipeline":
    """The scikit-learn pipeline of one classifier: the steps of `reduction`, then the classifier.

    Raises ValueError for a name that is not in CLASSIFIERS, or another kind.
    """
    from sklearn.pipeline import make_pipeline

    check_name(name)
    return make_pipeline(*reduction(kind), CLASSIFIERS[name](seed))


def reduction(kind: str = "features") -> list[Any]:
    """The scikit-learn transformers before all classifiers: z-transform, 12 principal components.

    kind: of the samples. "features": those of `features`, at least 12 samples. "located": the same with the
    position of the touch in three more columns, the last ones. They are standardised too and appended to the principal
    components, since the PCA would spread them over all components. "reduced": numbers that need no further
    reduction, such as the two of `touch_map`; they are only standardised.
    The thesis standardises the entire data beforehand (T4.2.4). Here the z-transform and the components are fitted to
    the samples that `fit` is given, so that nothing of the hold-out leaks into training. Raises ValueError for another
    kind.
    """
    from sklearn.compose import make_column_transformer
    from sklearn.decomposition import PCA
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}, got {kind!r}")
    components = [StandardScaler(), PCA(COMPONENTS, svd_solver="full")]
    if kind == "located":
        touch, place = (make_pipeline(*components), slice(0, -3)), (StandardScaler(), slice(-3, None))
        return [make_column_transformer(touch, place)]
    return components[:1] if kind == "reduced" else components


def check_name(name: str) -> None:
    """Raises ValueError that suggests the nearest name for one that is not in CLASSIFIERS."""
    if name not in CLASSIFIERS:
        near = difflib.get_close_matches(name, CLASSIFIERS, n=1)
        hint = f"did you mean {near[0]}?" if near else f"choose one of {', '.join(CLASSIFIERS)}"
        raise ValueError(f"unknown classifier {name}: {hint}")

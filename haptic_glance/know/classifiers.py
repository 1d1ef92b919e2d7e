"""The five classifiers of T tables 4.1 and 4.2 with the thesis's settings, and the scalings before them (T4.2.4).

| setting | T4.2.4 | here |
|---|---|---|
| tool | RapidMiner Studio | scikit-learn; the network is our own |
| kNN | k = 1, Euclidean distance | the same |
| SVM | RBF kernel, gamma = 1, epsilon = 0.001, C = 1.5 | the same; epsilon is the optimiser's tolerance |
| decision tree | splits by accuracy, depth at most 10 | splits by Gini impurity, depth at most 10, no pruning |
| naive Bayes | no settings | one normal density per feature and class |
| deep learning | feed-forward, rectified, gradient descent, Adadelta, 10 epochs | the same, two layers of 50 units |
| scale | "The entire data is standardized beforehand using z-transform" | the readings of `scaling` |
| validation | a quarter held out, five folds of the rest | the same, many times |

The sentence on the scale has several readings. Gamma 1 of the SVM is fixed, so the scale decides how many neighbours
its kernel sees.

| scaling | features | map and positions of joined touches |
|---|---|---|
| training | z-transform fitted to the training part, 12 components | z-transform fitted to the training part |
| beforehand | z-transform of all data, 12 components of all data | z-transform of the positions of all data |
| components | as beforehand, the z-transform once more on the components | as training, of all data |
| min_max | all data to 0..1, 12 components of all data | all data to 0..1 |

`beforehand` is printed. `training` is ours: nothing of the hold-out leaks into training. `components` is the input of
RapidMiner's own SVM, which standardises the columns that it is given. (Its LibSVM takes the columns as they are: that
is `beforehand`.) `min_max` is no reading of the word z-transform. It shows the same SVM on distances about 1, which is
its width.
"""

import difflib
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from sklearn.base import ClassifierMixin
    from sklearn.pipeline import Pipeline

KINDS = ("features", "located", "reduced", "joined")  # of samples
TRAINING, BEFOREHAND, TWICE, MIN_MAX = SCALINGS = ("training", "beforehand", "components", "min_max")
COMPONENTS = 12  # T4.2.3.4
TOUCH = 5  # columns of one of several joined touches: two of the map, three of the position


def reduction(kind: str = "features", scaling: str = TRAINING) -> list[Any]:
    """The scikit-learn transformers before all classifiers.

    kind: of the samples. "features": those of `features`, at least 12 samples; they become 12 principal components.
    "located": the same with the position of the touch in three more columns, the last ones. They are scaled too and
    appended to the principal components, since the PCA would spread them over all components. "reduced": numbers that
    need no further reduction; they are only scaled. "joined": touches of TOUCH columns each, one after another.
    scaling: a name in SCALINGS. Raises ValueError for another name or kind.
    """
    from sklearn.compose import make_column_transformer
    from sklearn.decomposition import PCA
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import MinMaxScaler, StandardScaler

    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}, got {kind!r}")
    if scaling not in SCALINGS:
        raise ValueError(f"scaling must be one of {', '.join(SCALINGS)}, got {scaling!r}")
    scaler = MinMaxScaler if scaling == MIN_MAX else StandardScaler
    if kind == "joined" and scaling == BEFOREHAND:
        return [make_column_transformer((scaler(), _positions), remainder="passthrough")]
    if kind in ("reduced", "joined"):
        return [scaler()]
    components = [scaler(), PCA(COMPONENTS, svd_solver="full"), *([scaler()] if scaling == TWICE else [])]
    if kind == "located":
        touch, place = (make_pipeline(*components), slice(0, -3)), (scaler(), slice(-3, None))
        return [make_column_transformer(touch, place)]
    return components


def scaled(
    train: np.ndarray, test: np.ndarray, kind: str = "features", scaling: str = TRAINING
) -> tuple[np.ndarray, np.ndarray]:
    """(train, test) after `reduction`, fitted to the training part, or by the other readings to both parts."""
    for step in reduction(kind, scaling):
        if scaling == TRAINING:
            train, test = step.fit_transform(train), step.transform(test)
        else:
            step.fit(np.concatenate([train, test]))
            train, test = step.transform(train), step.transform(test)
    return train, test


def _positions(joined):
    """The columns of joined touches that hold positions."""
    return [column for column in range(joined.shape[1]) if column % TOUCH > 1]


def knn(seed: int = 0) -> "ClassifierMixin":
    """The nearest sample by Euclidean distance."""
    from sklearn.neighbors import KNeighborsClassifier

    return KNeighborsClassifier(n_neighbors=1)


def svm(seed: int = 0) -> "ClassifierMixin":
    """Support vector machine with radial basis functions; the thesis's epsilon is the optimiser's tolerance.

    Gamma 1 is narrow for twelve components whose variances add up to 35: of a test sample, the nearest training sample
    has a kernel value of 0.06 at the median, and more than half of the test samples fall to one class. See `scaling`.
    The kernel is computed for all pairs at once, in a third of the time that libsvm takes pair by pair.
    """
    from sklearn.metrics.pairwise import rbf_kernel
    from sklearn.svm import SVC

    kernel = partial(rbf_kernel, gamma=1.0)
    return SVC(kernel=kernel, C=1.5, tol=0.001)  # type: ignore[arg-type]  # its stub knows words alone


def decision_tree(seed: int = 0) -> "ClassifierMixin":
    """A decision tree of depth 10 with Gini impurity.

    The thesis uses RapidMiner's criterion `accuracy`, which scikit-learn does not have; Gini impurity is its default.
    On twelve random sets of household shapes a tree that splits by accuracy is 0.0 [-2.9, 2.8] points better.
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


def classifier(name: str, seed: int = 0, kind: str = "features", scaling: str = TRAINING) -> "Pipeline":
    """The scikit-learn pipeline of one classifier of imprints: the steps of `reduction`, then the classifier (T4.2.4).

    Parameters
    ----------
    name : str
        A name of CLASSIFIERS.
    seed : int
        Seed of the classifier.
    kind : str
        Kind of samples, such as `features` or `located` (with the position of the touch).
    scaling : str
        A name of SCALINGS. All steps are fitted to the samples that `fit` receives, whatever the scaling.

    Returns
    -------
    sklearn.pipeline.Pipeline
        To be fitted.

    Raises
    ------
    ValueError
        For a name that is not in CLASSIFIERS, or another kind.

    Examples
    --------
    >>> from haptic_glance.know import classifier
    >>> classifier("knn").steps[-1][0]
    'kneighborsclassifier'
    """
    from sklearn.pipeline import make_pipeline

    check_name(name)
    return make_pipeline(*reduction(kind, scaling), CLASSIFIERS[name](seed))


def check_name(name: str) -> None:
    """Raises ValueError that suggests the nearest name for one that is not in CLASSIFIERS."""
    if name not in CLASSIFIERS:
        close_names = difflib.get_close_matches(name, CLASSIFIERS, n=1)
        hint = f"did you mean {close_names[0]}?" if close_names else f"choose one of {', '.join(CLASSIFIERS)}"
        raise ValueError(f"unknown classifier {name}: {hint}")

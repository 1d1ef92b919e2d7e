"""The protocol of T figure 4.10: train on some objects of every class, test on an object that was not touched.

The touches of a sample lie at separate points, in the salient region around one, or in a disc (T6.3). The four
classifiers are those of T figure 4.11 (T4.3.1). The smallest sufficient sensor has a repeatability.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import connected_components
from sklearn.ensemble import BaggingClassifier
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.network import FeedForward
from haptic_glance.know.split import Split
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import touchable

COMPONENTS = 10  # T4.3.1
PRINTED_SET = (4, 3)  # classes, and objects of each (T figure 4.10)
HOLDOUT = 0.25  # T4.2.4
SEEDS = {Split.OBJECTS: "accuracy", Split.RANDOM: "accuracy_holdout"}  # words on which the random numbers depend


def evaluate(imprints: dict[str, list[np.ndarray]], names: list[str], seed: int = 0, votes: int = 1) -> list[dict]:
    """Accuracy of classifiers that name the class of an object by one touch: a list of row dicts.

    imprints: {class: [(k, rows, cols) or (k, values) of each object]}, at least two classes of two objects or more;
    names: of CLASSIFIERS. votes: how many touches, one after another, make one sample, whose class is the one that most
    of them are taken for, of equals the one named first; they are held out together. Inputs are ten principal
    components of the vectorised imprints (T4.3.1), fitted to the training touches. They are not standardised, since the
    later ones are small because they contain little information.
    A row holds classifier, split, fold, group (the class), item (the object's number in its class), metric (accuracy),
    value (over that object's test touches) and seconds (training and prediction of the whole fold, without the
    components). Split `objects` tests unseen objects: fold i tests the i-th object of every class and trains on all
    others. A class with fewer objects does not take part in the later folds. (T4.3.2 tests one object of three.) Split
    `random`, in fold 0, tests other touches of training objects: a random quarter of each object's touches.
    Raises ValueError for too few classes, objects or touches, or an unknown classifier.
    """
    check_imprints(imprints)
    rows = []
    for split, fold, train, test in _splits(imprints, seed, votes):
        samples, test_samples = _components([images for _, images in train], [images for *_, images in test])
        labels = np.repeat([label for label, _ in train], [len(images) for _, images in train])
        ends = np.cumsum([len(images) // votes for *_, images in test])[:-1]
        random_state = int(rng(seed, f"{SEEDS[split]} {fold}").integers(2**31))
        for name in names:
            model = classifier(name, random_state)
            with Stopwatch() as watch:
                answers = np.split(majority(model.fit(samples, labels).predict(test_samples), votes), ends)
            common = {"classifier": name, "split": split, "fold": fold, "metric": "accuracy", "seconds": watch.seconds}
            rows += [{**common, "group": label, "item": index, "value": float((answer == label).mean())}
                     for (label, index, _), answer in zip(test, answers, strict=True)]  # fmt: skip
    return rows


def drawn_sets(classes: Mapping[str, Sequence[str]], count: int, seed: int) -> list[dict[str, list[str]]]:
    """`count` random sets {class: objects} of the size of T figure 4.10: four classes of three objects.

    The objects of each class are shuffled and dealt in threes. A set takes threes of the four classes that have most of
    them left, of equals those that were shuffled to the front. All are shuffled anew when fewer than four classes have
    three objects left, so that two sets share as few objects as they can.
    Raises ValueError where fewer than four classes have three objects.
    """
    width, size = PRINTED_SET
    large = sorted(label for label, names in classes.items() if len(names) >= size)
    if count and len(large) < width:
        raise ValueError(f"sensor_size.drawn: a set takes {width} classes of {size} objects, there are {len(large)}")
    sets: list[dict[str, list[str]]] = []
    left: dict[str, list[str]] = {}
    while len(sets) < count:
        if sum(len(names) >= size for names in left.values()) < width:
            random = rng(seed, f"classes {len(sets)}")
            left = {label: random.permutation(sorted(classes[label])).tolist() for label in random.permutation(large)}
        most = sorted(left, key=lambda label: -(len(left[label]) // size))[:width]
        sets.append({label: [left[label].pop() for _ in range(size)] for label in sorted(most)})
    return sets


def majority(answers: np.ndarray, votes: int) -> np.ndarray:
    """(k // votes,) the most frequent of each `votes` answers (k,), of equals the first."""
    return np.array([max(group, key=group.count) for group in answers.reshape(-1, votes).tolist()])


def _splits(imprints, seed, votes):
    """Yields (split, fold, [(class, images) to train on], [(class, object's number, images) to test])."""
    objects = [(label, index, images) for label in sorted(imprints) for index, images in enumerate(imprints[label])]
    for fold in range(max(map(len, imprints.values()))):
        train = [(label, images) for label, index, images in objects if index != fold]
        yield Split.OBJECTS, fold, train, [entry for entry in objects if entry[1] == fold]
    train, test = [], []
    for label, index, images in objects:
        order = rng(seed, f"touches of {label} {index}").permutation(len(images) // votes)
        held_out, train_ids = np.split(order, [max(1, round(HOLDOUT * len(order)))])
        groups = np.arange(len(images)).reshape(-1, votes)
        train.append((label, images[groups[train_ids].ravel()]))
        test.append((label, index, images[groups[held_out].ravel()]))
    yield Split.RANDOM, 0, train, test


def _components(*sides):
    """The components of all images of each side, [images of each object], fitted to the first side."""
    from sklearn.decomposition import PCA

    samples = [np.concatenate([images.reshape(len(images), -1) for images in side]) for side in sides]
    fitted = PCA(COMPONENTS, svd_solver="arpack", random_state=0).fit(samples[0])
    return [fitted.transform(sample) for sample in samples]


def check_imprints(imprints: dict[str, list[np.ndarray]]) -> None:
    """Raises ValueError unless there are two classes of two objects with enough touches to fit the components."""
    if len(imprints) < 2:
        raise ValueError(f"at least two classes are needed, got {list(imprints)}")
    for label, objects in imprints.items():
        if len(objects) < 2:
            raise ValueError(
                f"class {label} has {len(objects)} object, two are needed: one to train on and one to test"
            )
        if min(map(len, objects)) == 0:
            raise ValueError(f"class {label} has an object without touches")
    fewest = sum(sum(map(len, objects)) - max(map(len, objects)) for objects in imprints.values())
    if fewest <= COMPONENTS:
        raise ValueError(
            f"{fewest} touches are left to train on, fewer than {COMPONENTS} components need: touch more often"
        )


EXTENTS = ("points", "region", "disc")
ARRAY = "16-0.01"  # CELLS-PITCH of the array that they are tried with
TOUCHES = 5  # of a sample
SHARE = 0.8  # of a point's saliency, above which what is connected with it is one region


def sample_vertices(
    mesh: Mesh, saliency: np.ndarray, points: np.ndarray, extent: str, random: np.random.Generator
) -> np.ndarray:
    """(k * TOUCHES,) vertices to touch, each TOUCHES of them one sample that begins with one of the first k points.

    saliency (n,) in 0..1; points: vertex ids, most salient first, of which k = len(points) // TOUCHES begin a sample.
    extent `points`: the others are the remaining points, dealt out in turn; `region`: random vertices, by area, of
    `salient_region` around the point; `disc`: of a disc around it with the region's area. So every extent touches as
    often, in as many samples.
    """
    centres = points[: len(points) // TOUCHES]
    if extent == "points":
        return points[: len(centres) * TOUCHES].reshape(TOUCHES, -1).T.ravel()
    samples = []
    for centre in centres:
        inside = salient_region(mesh, saliency, centre)
        inside = inside if extent == "region" else disc(mesh, centre, mesh.vertex_areas[inside].sum())
        candidates = inside[(inside != centre) & touchable(mesh, inside)]
        weights = mesh.vertex_areas[candidates]
        draws = random.choice(candidates, TOUCHES - 1, replace=len(candidates) < TOUCHES - 1, p=weights / weights.sum())
        samples.append([centre, *draws])
    return np.ravel(samples)


def salient_region(mesh: Mesh, saliency: np.ndarray, centre: int) -> np.ndarray:
    """Vertices that are connected with `centre` through vertices of at least SHARE of its saliency.

    Where fewer than TOUCHES of them can be touched, as many vertices nearest to the centre.
    """
    strong = np.flatnonzero(saliency >= SHARE * saliency[centre])
    _, labels = connected_components(mesh.adjacency[strong][:, strong], directed=False)
    region = strong[labels == labels[np.searchsorted(strong, centre)]]
    return region if touchable(mesh, region).sum() >= TOUCHES else disc(mesh, centre, 0.0)


def disc(mesh: Mesh, centre: int, area: float) -> np.ndarray:
    """The touchable vertices nearest to `centre`, as many as have the area together, and at least TOUCHES."""
    order = np.argsort(np.linalg.norm(mesh.vertices - mesh.vertices[centre], axis=1), kind="stable")
    order = order[touchable(mesh, order)]
    return order[: max(TOUCHES, np.searchsorted(np.cumsum(mesh.vertex_areas[order]), area) + 1)]


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


RESAMPLES = 1000  # of the objects: shares then have an error below three points


def smallest_sufficient(accuracy: dict[tuple[int, float], float], slack: float) -> tuple[int, float]:
    """Key (cells, pitch) of the smallest array whose accuracy is at most `slack` below the best one's.

    accuracy: {(cells per side, pitch): mean accuracy}. The smallest array has the fewest sensels, since each is wired
    and read. Of equal numbers it is the narrower array, which fits into more places. Raises ValueError for no array or
    a negative slack.
    """
    if not accuracy or not slack >= 0:
        raise ValueError(f"give at least one array and a slack of 0 or more, got {len(accuracy)} and {slack}")
    floor = max(accuracy.values()) - slack
    return min(key for key, value in accuracy.items() if value >= floor)


def choice_repeatability(scores: Mapping[tuple[int, float], ArrayLike], slack: float, seed: int = 0) -> float:
    """The share of bootstrap resamples of the objects in which `smallest_sufficient` chooses the same array.

    scores: {(cells per side, pitch): accuracies of the objects, in one order}. The arrays differ by less than the width
    of their intervals, so that a choice without its repeatability could be chance.
    """
    table = np.array(list(scores.values()), dtype=np.float64)
    best_array = smallest_sufficient(dict(zip(scores, table.mean(axis=1), strict=True)), slack)
    resampled = np.random.default_rng(seed).integers(table.shape[1], size=(RESAMPLES, table.shape[1]))
    resamples = (dict(zip(scores, means, strict=True)) for means in table[:, resampled].mean(axis=2).T)
    return sum(smallest_sufficient(means, slack) == best_array for means in resamples) / RESAMPLES

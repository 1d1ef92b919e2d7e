"""The protocol of T figure 4.10: train on some objects of every class, test on an object that was not touched."""

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.split import Split

from .classifiers import classifier

COMPONENTS = 10  # T4.3.1
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


def majority(answers: np.ndarray, votes: int) -> np.ndarray:
    """(k // votes,) the most frequent of each `votes` answers (k,), of equals the first."""
    return np.array([max(some, key=some.count) for some in answers.reshape(-1, votes).tolist()])


def _splits(imprints, seed, votes):
    """Yields (split, fold, [(class, images) to train on], [(class, object's number, images) to test])."""
    objects = [(label, index, images) for label in sorted(imprints) for index, images in enumerate(imprints[label])]
    for fold in range(max(map(len, imprints.values()))):
        train = [(label, images) for label, index, images in objects if index != fold]
        yield Split.OBJECTS, fold, train, [each for each in objects if each[1] == fold]
    train, test = [], []
    for label, index, images in objects:
        order = rng(seed, f"touches of {label} {index}").permutation(len(images) // votes)
        held_out, kept = np.split(order, [max(1, round(HOLDOUT * len(order)))])
        groups = np.arange(len(images)).reshape(-1, votes)
        train.append((label, images[groups[kept].ravel()]))
        test.append((label, index, images[groups[held_out].ravel()]))
    yield Split.RANDOM, 0, train, test


def _components(*sides):
    """The components of all images of each side, [images of each object], fitted to the first side."""
    from sklearn.decomposition import PCA

    samples = [np.concatenate([images.reshape(len(images), -1) for images in side]) for side in sides]
    fitted = PCA(COMPONENTS, svd_solver="arpack", random_state=0).fit(samples[0])
    return [fitted.transform(one) for one in samples]


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

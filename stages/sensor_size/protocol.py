"""Trained on some objects of a class, tested on one that was never touched (T figure 4.10)."""

import numpy as np

from stages.kit import Stopwatch
from stages.kit.rng import rng

from .classifiers import classifier

COMPONENTS = 10  # T4.3.1
HOLDOUT = 0.25  # T4.2.4


def evaluate(imprints, names, seed=0):
    """How well classifiers name the class of an object by one touch: a list of row dicts.

    imprints: {class: [(k, rows, cols) of each object]}, at least two classes of two objects or more; names: of
    CLASSIFIERS. Inputs are ten principal components of the vectorised imprints (T4.3.1), learned from the training
    touches; they keep their own spread, since the later ones are small because they say little.
    A row holds classifier, fold, class, tested (which object of its class), metric, value (rate of right answers over
    that object's test touches) and seconds (training and answering of the whole fold, without the components). Metric
    `accuracy` is of unseen objects: fold i tests the i-th object of every class and trains on all others; where a class
    has fewer objects it sits out the folds beyond. (T4.3.2 tests one object of three.) `accuracy_holdout`, in fold 0,
    is of other touches of known objects: a random quarter of each object's is tested.
    Raises ValueError for too few classes, objects or touches, or an unknown classifier.
    """
    check(imprints)
    rows = []
    for metric, fold, train, test in _splits(imprints, seed):
        samples, components = _components([images for _, images in train])
        labels = np.concatenate([[one] * len(images) for one, images in train])
        number = int(rng(seed, f"{metric} {fold}").integers(2**31))
        for name in names:
            model = classifier(name, number)
            with Stopwatch() as watch:
                model.fit(samples, labels)
                right = [float((model.predict(components(images)) == one).mean()) for one, _, images in test]
            common = {"classifier": name, "fold": fold, "metric": metric, "seconds": watch.seconds}
            rows += [{**common, "class": one, "tested": i, "value": value}
                     for (one, i, _), value in zip(test, right, strict=True)]  # fmt: skip
    return rows


def _splits(imprints, seed):
    """Yields (metric, fold, [(class, images) to train on], [(class, which object, images) to test])."""
    objects = [(one, i, images) for one in sorted(imprints) for i, images in enumerate(imprints[one])]
    for fold in range(max(map(len, imprints.values()))):
        train = [(one, images) for one, i, images in objects if i != fold]
        yield "accuracy", fold, train, [each for each in objects if each[1] == fold]
    train, test = [], []
    for one, i, images in objects:
        order = rng(seed, f"touches of {one} {i}").permutation(len(images))
        held, rest = np.split(order, [max(1, round(HOLDOUT * len(order)))])
        train.append((one, images[rest]))
        test.append((one, i, images[held]))
    yield "accuracy_holdout", 0, train, test


def _components(parts):
    """(components of all training images, function that gives those of others)."""
    from sklearn.decomposition import PCA

    samples = np.concatenate([images.reshape(len(images), -1) for images in parts])
    fitted = PCA(COMPONENTS, svd_solver="arpack", random_state=0).fit(samples)
    return fitted.transform(samples), lambda images: fitted.transform(images.reshape(len(images), -1))


def check(imprints):
    """Raises ValueError unless there are two classes of two objects with enough touches to learn components from."""
    if len(imprints) < 2:
        raise ValueError(f"at least two classes are needed to tell apart, got {list(imprints)}")
    for one, objects in imprints.items():
        if len(objects) < 2:
            raise ValueError(f"class {one} has {len(objects)} object: one to train on and one to test are needed")
        if min(map(len, objects)) == 0:
            raise ValueError(f"class {one} has an object without touches")
    fewest = sum(sum(map(len, objects)) - max(map(len, objects)) for objects in imprints.values())
    if fewest <= COMPONENTS:
        raise ValueError(
            f"{fewest} touches are left to train on, {COMPONENTS} components need as many: touch more often"
        )

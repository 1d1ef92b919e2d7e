"""Grasps by BioTac SP fingertips: does the object slip, when it was never grasped before; and which object is it."""

import functools

import numpy as np
from sklearn.decomposition import PCA
from sklearn.dummy import DummyClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from benchmarks._recorded import blocked, holdout
from stages.classification import CLASSIFIERS
from stages.classification.classifiers import COMPONENTS
from stages.classification.recorded import PALMS, Grasps
from stages.kit import Stopwatch
from stages.kit.rng import rng

GROUPS = 8  # of about five objects, left out in turn
REPETITIONS = 5
DRAWN = 200  # draws of training objects: how far a mean moves by the objects alone


def grasp_rows(grasps):
    """Rows task, split, palm, scaled, components, classifier, object, value: accuracy on the grasps of each object.

    scaled: by the mean and deviation of the training part, or each part by its own: the fingertips drift between
    recordings, and a hand may average its readings over its own last grasps without knowing how they ended.
    """
    own = Grasps(**vars(grasps) | {"electrodes": _scaled_apart(grasps)})
    for components in (COMPONENTS, None):
        for name in (*CLASSIFIERS, "majority"):
            ask = functools.partial(_answers, name, components)
            said = {
                "components": components or grasps.electrodes.shape[1],
                "classifier": name,
                "scaled": "training",
                "metric": "accuracy",
            }
            for rows in (_unseen(grasps, ask), _left_out(grasps, ask), _recognised(grasps, ask)):
                yield from ({**said, **row} for row in rows)
            yield from ({**said, "scaled": "own", **row} for row in _unseen(own, ask))


def drift_rows(grasps):
    """Rows: how far the mean reading of the test part is from that of training, in deviations of the objects' means.

    drift_drawn: the same of as many training objects, drawn at random, from the others: the largest of 200 draws.
    """
    for palm in PALMS:
        here, random = grasps.palms == palm, rng(0, f"drift {palm}")
        train, test = grasps.electrodes[here & ~grasps.test], grasps.electrodes[here & grasps.test]
        names, count = grasps.objects[here & ~grasps.test], len(np.unique(grasps.objects[here & grasps.test]))
        drawn = [np.isin(names, random.choice(np.unique(names), count, replace=False)) for _ in range(DRAWN)]
        said = {"task": "slip", "split": "unseen", "palm": palm, "count": len(test)}
        yield said | {"metric": "drift", "value": _moved(train, names, test)}
        largest = max(_moved(train[~out], names[~out], train[out]) for out in drawn)
        yield said | {"metric": "drift_drawn", "value": largest}


def _moved(train, names, test):
    means = np.stack([train[names == name].mean(axis=0) for name in np.unique(names)])
    return np.abs((test.mean(axis=0) - train.mean(axis=0)) / means.std(axis=0)).mean()


def _scaled_apart(grasps):
    scaled = np.empty_like(grasps.electrodes)
    for palm in PALMS:
        for test in (False, True):
            own = (grasps.palms == palm) & (grasps.test == test)
            scaled[own] = StandardScaler().fit_transform(grasps.electrodes[own])
    return scaled


def _unseen(grasps, ask):
    """Trained on the 41 objects, asked once about the ten that are kept for it; all palms, and each alone."""
    for palm in ("all", *PALMS):
        here = np.isin(grasps.palms, PALMS if palm == "all" else [palm])
        train, test = np.flatnonzero(here & ~grasps.test), np.flatnonzero(here & grasps.test)
        said = {"task": "slip", "split": "unseen", "palm": palm}
        yield from _each(grasps, said, *ask(grasps, train, test, 0), test)


def _left_out(grasps, ask):
    """Within the 41 objects, every one left out once, in groups."""
    own = np.unique(grasps.objects[~grasps.test])
    for k in range(GROUPS):
        out = np.isin(grasps.objects, own[k::GROUPS])
        train, test = np.flatnonzero(~grasps.test & ~out), np.flatnonzero(out)
        said = {"task": "slip", "split": "left_out", "palm": "all"}
        yield from _each(grasps, said, *ask(grasps, train, test, 0), test)


def _recognised(grasps, ask):
    """Which of all the objects: a quarter held out, at random, or as a run of neighbours in the file."""
    order = np.lexsort((np.arange(len(grasps.objects)), grasps.palms, grasps.objects))
    labels = grasps.objects[order]
    for split in (holdout, blocked):
        for repetition in range(REPETITIONS):
            number = int(rng(0, f"repetition {repetition}").integers(2**31))
            train, test = (order[part] for part in split(labels, number))
            answers, seconds = ask(grasps, train, test, number, "objects")
            value = (answers == grasps.objects[test]).mean()
            said = {"task": "recognition", "split": split.__name__, "palm": "all", "repetition": repetition}
            yield {**said, "value": value, "count": len(test), "seconds": seconds}


def _answers(name, components, grasps, train, test, number, target="slipped"):
    """(answers on the test part, seconds)."""
    wanted = getattr(grasps, target)
    steps = [StandardScaler()] + ([PCA(components, svd_solver="full")] if components else [])
    last = DummyClassifier() if name == "majority" else CLASSIFIERS[name](number)
    with Stopwatch() as watch:
        model = make_pipeline(*steps, last).fit(grasps.electrodes[train], wanted[train])
        answers = model.predict(grasps.electrodes[test])
    return answers, watch.seconds


def _each(grasps, said, answers, seconds, test):
    for name in np.unique(grasps.objects[test]):
        own = grasps.objects[test] == name
        value = (answers[own] == grasps.slipped[test][own]).mean()
        yield {**said, "object": name, "value": value, "count": int(own.sum()), "seconds": seconds}

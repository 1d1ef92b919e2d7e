"""One hold-out: learn from clean touches, recognise disturbed ones of other places, and the other way round."""

import itertools
from dataclasses import dataclass

import numpy as np

from stages.classification import classifier
from stages.exploration import hold_out
from stages.kit import Stopwatch
from stages.kit.rng import rng

from .perturbations import PERTURBATIONS

FEATURES = ("imprint", "imprint_place")  # what is felt; and where (T table 4.5)
NONE = "none"  # the perturbation of the rows that say how well clean touches are recognised


def recognise(clean, disturbed, places, truth, split, width, severities, classifiers, repetition, seed=0):
    """A list of row dicts: split, features, classifier, perturbation, severity, metric accuracy, value, seconds.

    clean: {features, a name of FEATURES: (k, d)} of the touches at places (k, 3) of objects truth (k,); disturbed:
    function (perturbation, severity, features) -> (k, d), those of the same touches when disturbed, or None where they
    cannot be had; split, width: how places are held out (stages.exploration.hold_out). Seconds are those of answering.
    Raises ValueError where the touches are too few to hold some out.
    """
    rows, random = [], rng(seed, f"repetition {repetition} {split}")
    train, test = hold_out(truth, places, split, width, random)
    order = random.permutation(train)
    for name, features in itertools.product(classifiers, FEATURES):
        learner = Learner(name, repetition, truth, test)
        known = learner.learn(clean[features], train)
        common = {"split": split, "features": features, "classifier": name, "metric": "accuracy"}
        rows.append(common | learner.ask(known, clean[features]) | {"perturbation": NONE, "severity": 0.0})
        for perturbation, severity in pairs(severities):
            kind = PERTURBATIONS[perturbation]
            asked, learned = clean[features], known
            if features == "imprint_place" and not kind.moves:
                continue
            if kind.disturb is None:
                learned = learner.learn(clean[features], few(order, truth, int(severity)))
            elif (samples := disturbed(perturbation, severity, features)) is None:
                continue
            elif kind.learned:
                learned = learner.learn(samples, train)
            else:
                asked = samples
            where = {"perturbation": perturbation, "severity": severity}
            rows.append(common | learner.ask(learned, asked) | where)
    return rows


@dataclass(frozen=True)
class Learner:
    """One classifier of one repetition, and what it is asked: the touches `test` of truth (k,)."""

    name: str
    number: int
    truth: np.ndarray
    test: np.ndarray

    def learn(self, samples, train):
        """The classifier trained on some of the samples (k, d)."""
        return classifier(self.name, self.number).fit(samples[train], self.truth[train])

    def ask(self, known, samples):
        """The value and seconds of a row: how well it recognises the tested of the samples (k, d)."""
        with Stopwatch() as watch:
            right = known.predict(samples[self.test]) == self.truth[self.test]
        return {"value": float(right.mean()), "seconds": watch.seconds}


def pairs(severities):
    """[(perturbation, severity)] of {perturbation: severities}."""
    return [(name, severity) for name, levels in severities.items() for severity in levels]


def few(indices, truth, count):
    """The first `count` indices of each object, sorted: fewer only where an object has fewer."""
    return np.sort(np.concatenate([indices[truth[indices] == one][:count] for one in np.unique(truth)]))

"""One hold-out: train on clean touches, test on disturbed ones at other places, and vice versa."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from sklearn.pipeline import Pipeline

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import classifier

from .perturbations import PERTURBATIONS

FEATURES = ("imprint", "imprint_place")  # imprints alone, and with their positions (T table 4.5)
CLEAN = "none"  # the perturbation in rows of undisturbed touches


def recognition_rows(
    clean: dict[str, np.ndarray],
    perturbed_features: Callable[[str, float, str], np.ndarray | None],
    truth: np.ndarray,
    order: np.ndarray,
    test: np.ndarray,
    severities: dict[str, list[float]],
    classifiers: list[str],
    repetition: int,
) -> list[dict]:
    """A list of row dicts: features, classifier, perturbation, severity, metric accuracy, value, seconds.

    clean: {features: (k, d)} of the touches of objects truth (k,), by names such as FEATURES; perturbed_features:
    function (perturbation, severity, features) -> (k, d) of the same touches when disturbed, or None if they are not
    available; order, test: indices of the training touches, in random order, and of the test touches. Seconds are those
    of prediction.
    """
    rows, train = [], np.sort(order)
    for name, features in itertools.product(classifiers, clean):
        test_case = RecognitionTest(name, repetition, truth, test)
        clean_model = test_case.fit(clean[features], train)
        common = {"features": features, "classifier": name, "metric": "accuracy"}
        rows.append(common | test_case.score(clean_model, clean[features]) | {"perturbation": CLEAN, "severity": 0.0})
        for perturbation, severity in perturbation_severities(severities):
            registered = PERTURBATIONS[perturbation]
            tested, model = clean[features], clean_model
            if features == "imprint_place" and not registered.moves_positions:
                continue
            if registered.apply is None:
                model = test_case.fit(clean[features], first_of_each(order, truth, int(severity)))
            elif (samples := perturbed_features(perturbation, severity, features)) is None:
                continue
            elif registered.in_training:
                model = test_case.fit(samples, train)
            else:
                tested = samples
            where = {"perturbation": perturbation, "severity": severity}
            rows.append(common | test_case.score(model, tested) | where)
    return rows


@dataclass(frozen=True)
class RecognitionTest:
    """One classifier in one repetition, tested on the touches `test` of truth (k,)."""

    name: str
    random_state: int
    truth: np.ndarray
    test: np.ndarray

    def fit(self, samples: np.ndarray, train: np.ndarray) -> Pipeline:
        """The classifier trained on some of the samples (k, d)."""
        return classifier(self.name, self.random_state).fit(samples[train], self.truth[train])

    def score(self, model: Pipeline, samples: np.ndarray) -> dict[str, float]:
        """The value and seconds of a row: the model's accuracy on the test part of the samples (k, d)."""
        with Stopwatch() as watch:
            correct = model.predict(samples[self.test]) == self.truth[self.test]
        return {"value": float(correct.mean()), "seconds": watch.seconds}


def perturbation_severities(severities: dict[str, list[float]]) -> list[tuple[str, float]]:
    """[(perturbation, severity)] of {perturbation: severities}."""
    return [(name, severity) for name, levels in severities.items() for severity in levels]


def first_of_each(indices: np.ndarray, truth: np.ndarray, count: int) -> np.ndarray:
    """The first `count` indices of each object, sorted: fewer only where an object has fewer."""
    return np.sort(np.concatenate([indices[truth[indices] == label][:count] for label in np.unique(truth)]))

"""Recognition from events of a fingertip on the publisher's test part; and, within training, the effect of conditions.

The choices (bins, parameter) and the variations (time listened, taxels, disturbances) are decided within the training
part. Each method is tested on the test part once.
"""

import functools
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.split import Split
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun

from .series import TouchSeries, spread_taxels
from .splits import METHODS, Choice, binned, choose, foldings

HEARD = (0.1, 0.25, 0.5, 1.0)  # share of the touch
TAXELS = (1, 2, 5, 10, 20, 39)
SEVERITIES = {  # of disturbances of the test touches, from mild to harsh
    "dead_taxels": (0.05, 0.1, 0.2, 0.4),  # share of the taxels
    "dropped_events": (0.1, 0.25, 0.5, 0.75),  # share of the events
    "jitter": (1.0, 5.0, 10.0, 25.0),  # deviation of an event's time, steps
}
FOLDED = {"part": "training", "split": Split.FOLDS}
TIMED = 40  # touches that are asked about one at a time, for the milliseconds


def measure(run: StageRun, recordings: dict[str, TouchSeries], repetitions: int) -> None:
    """Adds rows of the accuracy by object of each method on {group: TouchSeries}; repetitions: of the foldings.

    part test: trained on the training part, asked about the publisher's test part; training: in folds within the
    training part, also by share heard, number of taxels and disturbance. metric milliseconds: of one touch, from its
    events to the answer; cross_validated: the accuracy that bins and parameter were chosen by.
    """
    trials = {f"{group} {method}": (group, method) for group in recordings for method in METHODS}
    run.each(functools.partial(process, recordings=recordings, repetitions=repetitions, seed=run.seed), trials)


def process(
    trial: tuple[str, str], folder: Path, recordings: dict[str, TouchSeries], repetitions: int, seed: int
) -> Rows:
    """Rows of one method on one group."""
    group, method = trial
    training, test = (recordings[group].of(mask) for mask in (~recordings[group].test, recordings[group].test))
    # Equal sums on any number of cores. Where nothing is heard yet, the features have no variance to divide by.
    with threadpool_limits(1), np.errstate(divide="ignore", invalid="ignore"):
        choice = choose(method, training.values, training.labels, repetitions, seed)
        common = {"group": group, "method": method, "bins": choice.bins, "parameter": choice.parameter}
        rows = [*_published(choice, training, test), *_within(choice, training, seed)]
    return [common | {"metric": "accuracy", "heard": 1.0, "cells": training.values.shape[1]} | row for row in rows]


def summary(rows: Rows) -> dict[str, float]:
    """{group.method: the accuracy on the publisher's test part}."""
    scored = (row for row in rows if row["metric"] == "accuracy" and row["part"] == "test")
    return named_means((f"{row['group']}.{row['method']}", row["value"]) for row in scored)


def by_object(labels: np.ndarray, answers: np.ndarray) -> Iterator[dict]:
    """A row for each object: the share of its touches that are recognised."""
    for name in np.unique(labels):
        mask = labels == name
        yield {"item": str(name), "value": float((answers[mask] == name).mean()), "count": int(mask.sum())}


def disturbed(values: np.ndarray, disturbance: str, severity: float, random: np.random.Generator) -> np.ndarray:
    """Touches (n, taxels, 2, t) as u1 with a disturbance of SEVERITIES.

    Dead taxels are the same in all touches; jitter moves each event for itself, those that leave the touch to its ends.
    """
    if disturbance == "dead_taxels":
        count = values.shape[1]
        dead = random.choice(count, round(severity * count), replace=False)
        return np.where(np.isin(np.arange(count), dead)[:, None, None], 0, values)
    if disturbance == "dropped_events":
        return values * (random.random(values.shape) >= severity)
    shifted, (*place, step) = np.zeros_like(values), np.nonzero(values)
    new_steps = np.rint(step + random.normal(0, severity, len(step))).astype(int).clip(0, values.shape[-1] - 1)
    np.add.at(shifted, (*place, new_steps), 1)
    return shifted


def _published(choice: Choice, training: TouchSeries, test: TouchSeries) -> Iterator[dict]:
    with Stopwatch() as watch:
        model = choice.fitted(binned(training.values, choice.bins), training.labels)
    answers = model.predict(binned(test.values, choice.bins))
    common = {"part": "test", "train": len(training.labels), "test": len(test.labels)}
    yield from (common | row for row in by_object(test.labels, answers))
    yield common | {"metric": "training_seconds", "value": watch.seconds, "seconds": watch.seconds}
    single = [training.values[k : k + 1] for k in range(min(TIMED, len(training.labels)))]
    timings = [_seconds(lambda touch=touch: model.predict(binned(touch, choice.bins))) for touch in single]
    yield common | {"metric": "milliseconds", "value": 1000 * float(np.median(timings))}
    yield FOLDED | {"metric": "cross_validated", "value": choice.accuracy}


def _within(choice: Choice, training: TouchSeries, seed: int) -> Iterator[dict]:
    """Within the training part, each touch held out one time: by share heard, by taxels, and with disturbances."""
    labels, folds = training.labels, foldings(training.labels, 1, seed)
    for heard_share in HEARD:
        features = binned(training.values, choice.bins, heard_share)
        yield from (FOLDED | {"heard": heard_share} | row for row in _folded(choice, features, labels, folds))
    for count in TAXELS[:-1]:  # all of them are what was heard in full
        features = binned(training.values[:, spread_taxels(count)], choice.bins)
        yield from (FOLDED | {"cells": count} | row for row in _folded(choice, features, labels, folds))
    features = binned(training.values, choice.bins)
    models = [choice.fitted(features[train], labels[train]) for train, _ in folds]
    for kind, severities in SEVERITIES.items():
        for severity in severities:
            change = functools.partial(_again, training.values, choice.bins, kind, severity, seed)
            answers = _answers(models, folds, change, labels)
            common = FOLDED | {"disturbance": kind, "severity": severity}
            yield from (common | row for row in by_object(labels, answers))


def _folded(choice: Choice, features: np.ndarray, labels: np.ndarray, folds: list) -> Iterator[dict]:
    models = [choice.fitted(features[train], labels[train]) for train, _ in folds]
    yield from by_object(labels, _answers(models, folds, lambda test, _: features[test], labels))


def _answers(
    models: list, folds: list, features: Callable[[np.ndarray, int], np.ndarray], labels: np.ndarray
) -> np.ndarray:
    answers = np.empty_like(labels)
    for k, (model, (_, test)) in enumerate(zip(models, folds, strict=True)):
        answers[test] = model.predict(features(test, k))
    return answers


def _again(
    values: np.ndarray, bins: int, kind: str, severity: float, seed: int, test: np.ndarray, fold: int
) -> np.ndarray:
    """Features of the disturbed touches of a fold, which are the same for each method."""
    return binned(disturbed(values[test], kind, severity, rng(seed, f"{kind} {severity} {fold}")), bins)


def _seconds(act: Callable[[], object]) -> float:
    with Stopwatch() as watch:
        act()
    return watch.seconds

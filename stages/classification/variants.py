"""Runs trials through the classifiers: one row a trial and classifier."""

import numpy as np

from stages.kit import Stopwatch

from .classifiers import COMPONENTS, classifier
from .protocol import draw_number
from .trials import selection, single


def evaluate_variants(touched, classifiers, repetitions, seed=0, several=None, closer=False):
    """Rows (variant, classifier, repetition, metric, value, seconds, imprints, note) of every trial in trials.py.

    touched: a Touched; classifiers: names in CLASSIFIERS; several: a Several, for trials of several touches; closer:
    also those of selection. Splits are those of `evaluate_features` in the same repetition. A trial that cannot be
    run gives one row with the reason, once.
    """
    rows, said = [], set()
    for repetition in range(repetitions):
        number = draw_number(seed, repetition)
        for trial in _trials(touched, number, several, closer):
            note = _impossible(trial)
            if note:
                if (trial.variant, trial.metric, note) not in said:
                    said.add((trial.variant, trial.metric, note))
                    row = {"variant": trial.variant, "classifier": None, "metric": trial.metric}
                    rows.append({**row, "value": None, "note": note})
                continue
            for name in [name for name in classifiers if name not in trial.skipped]:
                rows += [{**row, "repetition": repetition} for row in _run(trial, name, number)]
    return rows


def _trials(touched, number, several, closer):
    yield from single(touched, number)
    if closer:
        yield from selection(touched, number)
    if several:
        yield from several.trials(touched, number)


def _impossible(trial):
    """Why a trial cannot be run, or None."""
    if trial.split is not None and trial.kind != "reduced" and len(trial.split[0]) < COMPONENTS:
        return f"{len(trial.split[0])} imprints to train on are too few for {COMPONENTS} components"
    return trial.note


def _run(trial, name, number):
    """Rows of one classifier on one trial.

    Selection leaves objects with unequal numbers of imprints, and whoever guesses the commonest does well there: so the
    mean over the objects of the rate of right answers is a metric of its own, recall_holdout.
    """
    train, test = trial.split
    with Stopwatch() as watch:
        model = classifier(name, number, trial.kind).fit(trial.samples[train], trial.truth[train])
        answers = model.predict(trial.samples[test])
    right = answers == trial.truth[test]
    common = {"variant": trial.variant, "classifier": name, "imprints": len(train) + len(test), "note": None}
    common["seconds"] = watch.seconds + trial.seconds
    rows = [{**common, "metric": trial.metric, "value": float(right.mean())}]
    if trial.variant.endswith("selected") and trial.metric == "accuracy_holdout":
        recall = np.mean([right[trial.truth[test] == one].mean() for one in np.unique(trial.truth[test])])
        rows.append({**common, "metric": "recall_holdout", "value": float(recall)})
    return rows

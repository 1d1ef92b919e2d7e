"""Runs the trials with the classifiers: one row per trial and classifier."""

import numpy as np

from haptic_glance.know.classifiers import COMPONENTS, TRAINING
from haptic_glance.know.protocol import VALIDITY, Prepared, repetition_seed
from haptic_glance.know.split import Split

from .multi_touch import MultiTouchTrials
from .trials import TouchSet, selection_trials, single_touch_trials


def evaluate_variants(
    touched: TouchSet,
    classifiers: list[str],
    repetitions: int,
    seed: int = 0,
    multi_touch: MultiTouchTrials | None = None,
    with_selection: bool = False,
) -> list[dict]:
    """Rows (variant, scaling, classifier, repetition, split, metric, value, seconds, imprints, note) of all trials.

    Those of trials.py. classifiers: names in CLASSIFIERS; multi_touch: for trials of several touches; with_selection:
    also trials of selection, and more readings of the scaling. Splits are those of `evaluate_features` in the same
    repetition. A trial that cannot be run gives one row with the reason.
    """
    rows, reported = [], set()
    for repetition in range(repetitions):
        random_state = repetition_seed(seed, repetition)
        for trial in _trials(touched, random_state, multi_touch, with_selection):
            note = _reason_to_skip(trial)
            if note:
                if (trial.variant, trial.split, note) not in reported:
                    reported.add((trial.variant, trial.split, note))
                    row = {"variant": trial.variant, "classifier": None, "split": trial.split, "metric": "accuracy"}
                    rows.append({**row, "value": None, "note": note})
                continue
            for scaling in trial.scalings:
                found = _trial_rows(trial, scaling, classifiers, random_state)
                rows += [{**row, "repetition": repetition} for row in found]
    return rows


def _trials(touched, random_state, multi_touch, with_selection):
    yield from single_touch_trials(touched, random_state, with_selection)
    if with_selection:
        yield from selection_trials(touched, random_state)
    if multi_touch:
        yield from multi_touch.trials(touched, random_state)


def _reason_to_skip(trial):
    """The reason why a trial cannot be run, or None."""
    if trial.parts is not None and trial.kind in ("features", "located") and len(trial.parts[0]) < COMPONENTS:
        return f"{len(trial.parts[0])} imprints to train on are too few for {COMPONENTS} components"
    return trial.note


def _trial_rows(trial, scaling, classifiers, random_state):
    """Rows of the classifiers on one trial, its samples scaled one way.

    Selection leaves objects with unequal numbers of imprints, so that guessing the most frequent object is accurate. So
    the mean over the objects of their recall is another metric, recall.
    """
    rows, prepared = [], Prepared.from_split(trial.samples, trial.truth, trial.parts, trial.kind, scaling)
    truth = prepared.test_truth
    for name in trial.classifiers(classifiers, scaling):
        answers = prepared.predict(name, random_state, VALIDITY[0] in trial.validity)
        correct = answers.predicted == truth
        common = {"variant": trial.variant, "scaling": scaling, "classifier": name, "split": trial.split, "note": None}
        seconds = answers.seconds + trial.seconds if scaling == TRAINING else None  # the scale costs nothing
        common |= {"imprints": len(prepared.train) + len(truth), "seconds": seconds}
        rows.append({**common, "metric": "accuracy", "value": float(correct.mean())})
        if trial.variant.endswith(("selected", "selected_control")) and trial.split == Split.RANDOM:
            recall = np.mean([correct[truth == one].mean() for one in np.unique(truth)])
            rows.append({**common, "metric": "recall", "value": float(recall)})
        rows += [{**common, "seconds": None, **one} for one in answers.validity if one["metric"] in trial.validity]
    return rows

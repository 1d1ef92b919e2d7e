"""Recognition by several touches as one sample (T table 4.6), and variants that may explain it (T4.2.3.5)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.classifiers import COMPONENTS, TOUCH, TRAINING
from haptic_glance.know.joined_touches import concatenate_touches, draw_combinations, touch_map
from haptic_glance.know.protocol import VALIDITY, Prepared, random_holdout, region_holdout, repetition_seed
from haptic_glance.know.split import Split

from .touch_trials import NO_DISTANT_TOUCH, OTHERS, TouchSet, Trial, selection_trials, single_touch_trials

# Of combining the touches of one side of a split, see trials.py.
VARIANTS = ("_unplaced", "_ordered", "_disjoint", "_many")

MANY_FACTOR = 5  # times as many combinations in the variant `_many`
CLOSER: dict[str, Any] = {"scalings": (TRAINING, *OTHERS), "validity": VALIDITY[1:]}  # of the trials of all_variants
QUADRATIC_TIME = ("svm",)  # in the number of samples: not run on many


@dataclass(frozen=True)
class MultiTouchTrials:
    """Trials of several touches. counts: of touches; draws_per_imprint: combinations that start with an imprint."""

    counts: tuple[int, ...]
    draws_per_imprint: int
    all_variants: bool

    def trials(self, touched: TouchSet, random_state: int) -> Iterator[Trial]:
        """The trials of one repetition: random hold-out, with the VARIANTS if all_variants, and one side held out."""
        variants = VARIANTS if self.all_variants else ()
        parts = random_holdout(touched.truth, random_state)
        yield from self._split_trials(touched, parts, random_state, Split.RANDOM, ("", *variants))
        parts = region_holdout(touched.truth, touched.places, touched.width, random_state, side=True)
        if parts is None:
            yield Trial("touches_1", Split.REGIONS, note=NO_DISTANT_TOUCH)
        else:
            yield from self._split_trials(touched, parts, random_state, Split.REGIONS, ("",))
        if self.all_variants:
            yield from self._mixed_trials("touches_{}_mixed", touched, random_state, validity=VALIDITY[1:])
            first_touches = touched.first_of_each()
            yield from self._mixed_trials("first_15_touches_{}_mixed", first_touches, random_state, **CLOSER)

    def _split_trials(self, touched, parts, random_state, split, variants):
        """Combinations within each side of a split; the map is fitted to the training side."""
        numbers, seconds = _map_and_positions(touched, parts[0])
        for variant in variants:
            for count in self.counts:
                random = np.random.default_rng([random_state, count])
                fewest = min(np.bincount(touched.truth[side]).min() for side in parts)
                if fewest < count:
                    note = f"an object has {fewest} touches on one side of the split: no combination of {count}"
                    yield Trial(f"touches_{count}{variant}", split, note=note)
                    continue
                sides = [self._combine(touched, side, count, variant, random) for side in parts]
                columns = numbers[:, :2] if variant == "_unplaced" else numbers
                further = {"skipped": QUADRATIC_TIME if variant == "_many" else ()}
                further |= CLOSER if self.all_variants and variant == "" and split == Split.RANDOM else {}
                yield _trial(f"touches_{count}{variant}", split, columns, touched.truth, sides, seconds, **further)

    def _combine(self, touched, side, count, variant, random):
        """(m, count) indices of the imprints of one side."""
        if variant == "_disjoint":
            return side[_disjoint(touched.truth[side], count, random)]
        draws_per_imprint = self.draws_per_imprint * (MANY_FACTOR if variant == "_many" else 1)
        draws = [side[draw_combinations(touched.truth[side], count, random)] for _ in range(draws_per_imprint)]
        combinations = np.concatenate(draws)
        if variant == "_ordered":
            combinations = np.take_along_axis(combinations, touched.places[combinations, 2].argsort(axis=1), axis=1)
        return combinations

    def _mixed_trials(self, name, touched, random_state, **further):
        """Combinations of all imprints, split afterwards: imprints of test combinations also occur in training."""
        everything = np.arange(len(touched.truth))
        numbers, seconds = _map_and_positions(touched, everything)
        for count in self.counts:
            combinations = self._combine(touched, everything, count, "", np.random.default_rng([random_state, count]))
            sides = [combinations[side] for side in random_holdout(touched.truth[combinations[:, 0]], random_state)]
            yield _trial(name.format(count), Split.RANDOM, numbers, touched.truth, sides, seconds, **further)


def _map_and_positions(touched, train):
    """((k, 5): two coordinates on the map and the position of each imprint, seconds)."""
    with Stopwatch() as watch:
        map_positions = touch_map().fit(touched.samples[train]).transform(touched.samples)
    return np.hstack([map_positions, touched.places]), watch.seconds


def _disjoint(truth, count, random):
    """(m, count) indices of combinations that share no imprint."""
    combinations = []
    for label in np.unique(truth):
        ids = random.permutation(np.flatnonzero(truth == label))
        combinations.append(ids[: len(ids) // count * count].reshape(-1, count))
    return np.concatenate(combinations)


def _trial(variant, split, numbers, truth, sides, seconds, **further):
    train, test = sides
    combinations = np.concatenate(sides)
    parts = (np.arange(len(train)), len(train) + np.arange(len(test)))
    samples, labels = concatenate_touches(numbers, combinations), truth[combinations[:, 0]]
    kind = "joined" if numbers.shape[1] == TOUCH else "reduced"
    return Trial(variant, split, samples, labels, parts, kind, seconds, **further)


def evaluate_variants(
    touched: TouchSet,
    classifiers: list[str],
    repetitions: int,
    seed: int = 0,
    multi_touch: MultiTouchTrials | None = None,
    with_selection: bool = False,
    left_out: Sequence[str] = (),
) -> list[dict]:
    """Rows (variant, scaling, classifier, repetition, split, metric, value, seconds, imprints, note) of all trials.

    Those of trials.py. classifiers: names in CLASSIFIERS; multi_touch: for trials of several touches; with_selection:
    also trials of selection, and more readings of the scaling; left_out: variants that are not run. Splits are those of
    `evaluate_prepared` in the same repetition. A trial that cannot be run gives one row with the reason.
    """
    rows, reported = [], set()
    for repetition in range(repetitions):
        random_state = repetition_seed(seed, repetition)
        for trial in _trials(touched, random_state, multi_touch, with_selection):
            if trial.variant in left_out:
                continue
            note = _reason_to_skip(trial)
            if note:
                if (trial.variant, trial.split, note) not in reported:
                    reported.add((trial.variant, trial.split, note))
                    row = {"variant": trial.variant, "classifier": None, "split": trial.split, "metric": "accuracy"}
                    rows.append({**row, "value": None, "note": note})
                continue
            for scaling in trial.scalings:
                scores = _trial_rows(trial, scaling, classifiers, random_state)
                rows += [{**row, "repetition": repetition} for row in scores]
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
            recall = np.mean([correct[truth == entry].mean() for entry in np.unique(truth)])
            rows.append({**common, "metric": "recall", "value": float(recall)})
        rows += [
            {**common, "seconds": None, **entry} for entry in answers.validity if entry["metric"] in trial.validity
        ]
    return rows

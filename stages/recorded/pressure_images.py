"""Recognition of real touches by the thesis's protocol, and what its random hold-out and its selection flatter."""

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn.model_selection import StratifiedKFold, cross_val_score
from threadpoolctl import threadpool_limits

from haptic_glance.base.rng import rng
from haptic_glance.know import CLASSIFIERS, classifier, features
from haptic_glance.know.classifiers import COMPONENTS, SCALINGS, TRAINING, TWICE
from haptic_glance.know.features import as_many, confusable, similarity
from haptic_glance.know.protocol import FOLDS, MIN_IMPRINTS, Prepared
from haptic_glance.know.split import Split
from stages.engine.run import Rows, StageRun

from .splits import SPLITS, random_split, split_number

WITHOUT_TWICE = tuple(scaling for scaling in SCALINGS if scaling != TWICE)
UNREDUCED = "unreduced"
COUNTS = {"six": 6, "four": 4}  # the first by the alphabet; as many at random; and those most alike


@dataclass(frozen=True)
class Touches:
    """Features (k, 41), class (k,) and similarity to each other (k, k) of k touches, in order of their numbers."""

    samples: np.ndarray
    labels: np.ndarray
    alike: np.ndarray

    def of(self, index: np.ndarray) -> "Touches":
        """The part that the ids or the mask `index` names."""
        return Touches(self.samples[index], self.labels[index], self.alike[index][:, index])


@dataclass(frozen=True)
class ClassSet:
    """A set of classes that is recognised in some repetitions; folds: also by cross-validation."""

    group: str
    classes: tuple[str, ...]
    repetitions: tuple[int, ...]
    folds: bool


def measure(run: StageRun, images: dict[str, np.ndarray], repetitions: int) -> None:
    """Adds rows of the five classifiers on {class: (k, rows, cols)}: all classes, the first six and four, and others.

    method: all touches; selected: without those that resemble a touch of another class of the set, taken out before
    the split as in the thesis; selected_control: without as many of each class, at random; selected_training: taken out
    of the training part alone, tested on all others; unreduced: all touches of all classes, their features not reduced
    to twelve components. metric: accuracy by split (folds: within the training part of the random split), share_similar
    (touches that resemble one of another class), and what finds a dead classifier (train_accuracy, commonest_share; of
    all touches). The random split is run by all scalings but on the first six and four, and so are the blocks of all
    classes. Groups: `six_drawn` and `four_drawn` are drawn anew in each repetition; `six_alike` and `four_alike` are
    the classes with the largest share of touches that resemble one of any other class.
    """
    with threadpool_limits(1):  # equal sums on any number of cores
        touches = describe(images)
        sets = class_sets(touches, repetitions, run.seed)
    work = functools.partial(process, touches=touches, seed=run.seed)
    run.each(work, sets, made_of={name: repr(class_set) for name, class_set in sets.items()})


def describe(images: dict[str, np.ndarray]) -> Touches:
    """The Touches of {class: (k, rows, cols)}, by class in alphabetical order."""
    names = sorted(images)
    labels = np.repeat(names, [len(images[name]) for name in names])
    samples = np.concatenate([features(images[name]) for name in names])
    return Touches(samples, labels, similarity(np.concatenate([images[name] for name in names])))


def class_sets(touches: Touches, repetitions: int, seed: int) -> dict[str, ClassSet]:
    """{name: ClassSet} of all sets; a drawn set has one repetition, the other sets have all."""
    names, numbers = [str(name) for name in np.unique(touches.labels)], tuple(range(repetitions))
    resembling = confusable(touches.alike, touches.labels)
    shares = {name: resembling[touches.labels == name].mean() for name in names}
    ranked = sorted(names, key=lambda name: -shares[name])
    sets = {"all": ClassSet("all", tuple(names), numbers, True)}
    for name, count in COUNTS.items():
        if count > len(names):
            continue
        sets[name] = ClassSet(name, tuple(names[:count]), numbers, True)
        sets[f"{name}_alike"] = ClassSet(f"{name}_alike", tuple(ranked[:count]), numbers, True)
        for k in numbers:
            sample = tuple(str(label) for label in rng(seed, f"{name} {k}").choice(names, count, replace=False))
            sets[f"{name}_drawn {k}"] = ClassSet(f"{name}_drawn", sample, (k,), False)
    return sets


def process(class_set: ClassSet, folder: Path, touches: Touches, seed: int) -> Rows:
    """Rows of one set: without selection, selected before the split, and in the training part alone."""
    with threadpool_limits(1):
        return list(_set_rows(class_set, touches.of(np.isin(touches.labels, class_set.classes)), seed))


def summary(rows: Rows) -> dict[str, float]:
    """{metric: number} of a run: the mean accuracy of kNN on all classes by split, and the share of similar touches."""
    whole = [row for row in rows if row["group"] == "all" and row["method"] == "all" and row.get("value") is not None]
    numbers = {"share_similar": whole[0]["value"]}
    for split in (*SPLITS, Split.FOLDS):
        criteria = {"split": split, "classifier": "knn", "scaling": TRAINING, "metric": "accuracy"}
        values = [row["value"] for row in whole if criteria.items() <= row.items()]
        numbers[f"accuracy_{split}"] = round(float(np.mean(values)), 6)
    return numbers


def _set_rows(class_set: ClassSet, touches: Touches, seed: int) -> Iterator[dict]:
    common, names = {"group": class_set.group, "classes": len(class_set.classes)}, " ".join(sorted(class_set.classes))
    is_distinct = ~confusable(touches.alike, touches.labels)
    share = {"metric": "share_similar", "value": 1 - is_distinct.sum() / len(is_distinct)}
    yield {**common, "chosen": names, "method": "all", **share, "repetition": class_set.repetitions[0]}
    parts = {"all": touches, "selected": touches.of(is_distinct), "selected_training": touches}
    parts["selected_control"] = touches.of(is_distinct)
    if class_set.group == "all":
        parts[UNREDUCED] = touches
    for method, part in parts.items():
        counts = {name: int((part.labels == name).sum()) for name in sorted(class_set.classes)}
        poorest = min(counts, key=lambda name: counts[name])
        if counts[poorest] < MIN_IMPRINTS:
            row = {**common, "method": method, "split": Split.RANDOM, "metric": "accuracy"}
            note = f"{poorest} keeps {counts[poorest]} touches, {MIN_IMPRINTS} are needed"
            yield {**row, "repetition": class_set.repetitions[0], "note": note}
            continue
        for repetition in class_set.repetitions:
            number = split_number(seed, repetition)
            if method == "selected_control":
                part = touches.of(as_many(touches.labels, is_distinct, np.random.default_rng(number)))
            scalings = (TRAINING,) if class_set.group in COUNTS else SCALINGS if method == "all" else WITHOUT_TWICE
            rows = _split_rows(part, method, number, class_set, scalings)
            yield from ({**common, "method": method, "repetition": repetition, **row} for row in rows)


def _split_rows(
    touches: Touches, method: str, number: int, class_set: ClassSet, scalings: tuple[str, ...]
) -> Iterator[dict]:
    samples, labels, selected = touches.samples, touches.labels, method == "selected_training"
    for split, draw in SPLITS.items():
        train, test = draw(labels, number)
        if selected:
            train = train[~confusable(touches.alike[np.ix_(train, train)], labels[train])]
            if len(train) < COMPONENTS or len(set(labels[train])) < 2:
                note = f"{len(train)} touches to train on, {COMPONENTS} of two classes are needed"
                yield {"split": split, "metric": "accuracy", "note": note}
                continue
        validity = split == Split.RANDOM and method == "all"
        is_wide = split == Split.RANDOM or (class_set.group == "all" and method in ("all", UNREDUCED))
        for scaling in scalings if is_wide else (TRAINING,):
            kind = "reduced" if method == UNREDUCED else "features"  # "reduced" samples are taken as they are
            prepared = Prepared.from_split(samples, labels, (train, test), kind, scaling)
            for name in CLASSIFIERS:
                answers = prepared.predict(name, number, with_training=validity)
                row = {"classifier": name, "scaling": scaling, "split": split, "train": len(train), "test": len(test)}
                value = float((answers.predicted == labels[test]).mean())
                seconds = answers.seconds if scaling == TRAINING else None  # the scale costs nothing
                yield {**row, "metric": "accuracy", "value": value, "seconds": seconds}
                if validity:
                    yield from ({**row, **cells} for cells in answers.validity)
    if class_set.folds and method not in ("selected_training", UNREDUCED):
        for name in CLASSIFIERS:
            value = _cross_validated(name, samples, labels, number)
            row = {"classifier": name, "scaling": TRAINING, "split": Split.FOLDS}
            yield {**row, "metric": "accuracy", "value": value}


def _cross_validated(name: str, samples: np.ndarray, labels: np.ndarray, number: int) -> float:
    train, _ = random_split(labels, number)
    folds = StratifiedKFold(FOLDS, shuffle=True, random_state=number)
    return float(cross_val_score(classifier(name, number), samples[train], labels[train], cv=folds).mean())

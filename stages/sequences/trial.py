"""One trial: strategy, split, repetition, kind of classifier, size. An interrupted run does not repeat those done."""

from typing import NamedTuple

from threadpoolctl import threadpool_limits

from stages.kit import Stopwatch
from stages.kit.files import write_arrays
from stages.kit.rng import rng
from stages.kit.run import DATA

from .classifiers import CONVENTIONAL, choose_size, classifier
from .dataset import read_data, smaller
from .series import sequence_features, series
from .split import by_objects, by_sequences
from .training import Images, Normals, learn, probabilities

SPLITS = ("sequences", "objects")
KINDS = ("networks", "conventional")


class Trial(NamedTuple):
    """What one trial is; its name is STRATEGY.SPLIT.REPETITION.KIND.FRAMESxCELLS."""

    strategy: str
    split: str
    repetition: int
    kind: str
    size: str

    @property
    def name(self):
        return ".".join(map(str, self))

    @classmethod
    def parse(cls, name):
        """The trial of a name."""
        strategy, split, repetition, kind, size = name.rsplit(".", 4)
        return cls(strategy, split, int(repetition), kind, size)

    @property
    def frames_and_cells(self):
        """(frames, cells a side)."""
        frames, _, cells = self.size.partition("x")
        return int(frames), int(cells)


def process(name, folder, members, settings, seed):
    """Trains and asks the classifiers of one trial; writes predictions/NAME.npz and returns the rows.

    The split and the random numbers of the training depend on split and repetition alone, not on the strategy.
    """
    trial = Trial.parse(name)
    data = smaller(read_data(DATA / "contours", members, trial.strategy), *trial.frames_and_cells)
    random = rng(seed, f"sequences {trial.split} {trial.repetition}")
    if trial.split == "objects":
        split = by_objects(data.labels, data.ranks, trial.repetition, data.folds, random)
    else:
        split = by_sequences(data.labels, random)
    with threadpool_limits(1):  # equal sums on any number of cores
        if trial.kind == "networks":
            answers = networks(data, split, settings, int(random.integers(2**31)))
        else:
            answers = conventional(data, split)
    found = {classifier: said for classifier, (said, _, _) in answers.items()}
    truth = data.labels[split.test]
    write_arrays(folder / "predictions" / f"{name}.npz", test=split.test, true=truth, **found)
    return _rows(trial, data, truth, answers)


def networks(data, split, settings, seed):
    """{classifier: (answers on the test part, seconds, facts)} of both networks and of their summed probabilities."""
    found = {}
    for name, kind, epochs in (
        ("cnn_images", Images, settings.image_epochs),
        ("cnn_normals", Normals, settings.normal_epochs),
    ):
        with Stopwatch() as watch:
            inputs = kind(getattr(data, name.removeprefix("cnn_")), split.train)
            network = learn(inputs, data.labels, split.train, len(data.classes), epochs, seed)
            found[name] = probabilities(network, inputs, split.test), watch
    summed = sum(chances for chances, _ in found.values())
    answers = {name: (chances.argmax(axis=1), watch.seconds, {}) for name, (chances, watch) in found.items()}
    answers["cnn"] = summed.argmax(axis=1), sum(seconds for _, seconds, _ in answers.values()), {}
    return answers


def conventional(data, split):
    """{classifier: (answers on the test part, seconds with those of the features, facts)} of CONVENTIONAL."""
    with Stopwatch() as looking:
        samples = sequence_features(series(data.images, data.normals))
    answers, labels = {}, data.labels
    for name in CONVENTIONAL:
        with Stopwatch() as watch:
            size = None if name.endswith("_no_som") else choose_size(name, samples, labels, split.fit, split.check)
            model = classifier(name, size).fit(samples[split.train], labels[split.train])
            said = model.predict(samples[split.test])
        answers[name] = said, looking.seconds + watch.seconds, {} if size is None else {"map_dimensions": size}
    return answers


def _rows(trial, data, truth, answers):
    frames, cells = trial.frames_and_cells
    common = {"method": trial.strategy, "split": trial.split, "repetition": trial.repetition}
    common |= {"frames": frames, "cells": cells, "classes": len(data.classes), "sequences": len(data.labels)}
    rows = []
    for name, (said, seconds, facts) in answers.items():
        one, right = common | {"classifier": name, "class": None, "seconds": None, "note": None}, said == truth
        rows.append(one | {"metric": "accuracy", "value": float(right.mean()), "seconds": seconds})
        rows += [one | {"metric": metric, "value": value} for metric, value in facts.items()]
        if trial.split == "objects":  # one object of each class was tested: this is what each of them gave
            each = {label: float(right[truth == k].mean()) for k, label in enumerate(data.classes)}
            rows += [
                one | {"class": label, "metric": "accuracy_object", "value": value} for label, value in each.items()
            ]
    return rows

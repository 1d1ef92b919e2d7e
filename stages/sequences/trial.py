"""One trial: the classifiers of one kind on one strategy, split, repetition and size of the sequences."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.split import Split
from stages.kit.holdout import Split as Parts
from stages.kit.run import Rows

from .classifiers import CONVENTIONAL, Reduced, choose_dimensions
from .dataset import SequenceData, downsample, read_sequence_data
from .schema import Params
from .series import sequence_features, series
from .split import split_by_objects, split_by_sequences
from .training import ImageInputs, NormalInputs, class_probabilities, train_network

# Each split by its word in reports/metrics and in the seeds of the random numbers, on which the results depend.
SPLITS = {Split.RANDOM: "sequences", Split.OBJECTS: "objects"}
KINDS = ("networks", "conventional")
Result = tuple[np.ndarray, float, dict[str, int]]  # predictions for the test part, seconds, further metrics


class Trial(NamedTuple):
    """The parts of a trial's name, STRATEGY.SPLIT.REPETITION.KIND.FRAMESxCELLS.

    repetition: of unseen objects the number of the fold, plus all folds for each training before.
    """

    strategy: str
    split: Split
    repetition: int
    kind: str
    size: str

    @property
    def name(self) -> str:
        return ".".join(map(str, self))

    @classmethod
    def parse(cls, name: str) -> "Trial":
        """The Trial with this name."""
        strategy, split, repetition, kind, size = name.rsplit(".", 4)
        return cls(strategy, Split(split), int(repetition), kind, size)

    @property
    def frames_and_cells(self) -> tuple[int, int]:
        """(frames, cells per side)."""
        frames, _, cells = self.size.partition("x")
        return int(frames), int(cells)


def process(name: str, folder: Path, data: Path, members: dict[str, list[str]], settings: Params, seed: int) -> Rows:
    """Trains and tests the classifiers of one trial; writes predictions/NAME.npz and returns the rows.

    The random numbers of split and training depend on the split and the repetition alone, not on the strategy.
    """
    trial = Trial.parse(name)
    read = downsample(read_sequence_data(data / "contours", members, trial.strategy), *trial.frames_and_cells)
    random = rng(seed, f"sequences {SPLITS[trial.split]} {trial.repetition}")
    if trial.split == Split.OBJECTS:
        parts = split_by_objects(read.labels, read.ranks, trial.repetition % read.folds, read.folds, random)
    else:
        parts = split_by_sequences(read.labels, random)
    with threadpool_limits(1):  # equal sums on any number of cores
        if trial.kind == "networks":
            results = network_results(read, parts, settings, int(random.integers(2**31)))
        else:
            results = conventional_results(read, parts)
    predictions = {classifier: predicted for classifier, (predicted, _, _) in results.items()}
    truth = read.labels[parts.test]
    write_arrays(folder / "predictions" / f"{name}.npz", test=parts.test, true=truth, **predictions)
    return _rows(trial, read, truth, results)


def network_results(data: SequenceData, parts: Parts, settings: Params, seed: int) -> dict[str, Result]:
    """{classifier: Result} of both networks and of the sum of their probabilities."""
    predictions = {}
    for name, kind, epochs in (
        ("cnn_images", ImageInputs, settings.image_epochs),
        ("cnn_normals", NormalInputs, settings.normal_epochs),
    ):
        with Stopwatch() as watch:
            inputs = kind(getattr(data, name.removeprefix("cnn_")), parts.train)
            network = train_network(inputs, data.labels, parts.train, len(data.classes), epochs, seed)
            predictions[name] = class_probabilities(network, inputs, parts.test), watch
    summed = np.sum([probabilities for probabilities, _ in predictions.values()], axis=0)
    results = {
        name: (probabilities.argmax(axis=1), watch.seconds, {}) for name, (probabilities, watch) in predictions.items()
    }
    results["cnn"] = summed.argmax(axis=1), sum(seconds for _, seconds, _ in results.values()), {}
    return results


def conventional_results(data: SequenceData, parts: Parts) -> dict[str, Result]:
    """{classifier: Result} of CONVENTIONAL; the seconds include the features."""
    with Stopwatch() as feature_watch:
        samples = sequence_features(series(data.images, data.normals))
    validation = Reduced(samples, data.labels, parts.fit, parts.validation)
    reduced, results = Reduced(samples, data.labels, parts.train, parts.test), {}
    for name in CONVENTIONAL:
        dimensions, seconds = (None, 0.0) if name.endswith("_no_som") else choose_dimensions(name, validation)
        predicted, own_seconds = reduced.predict(name, dimensions)
        metrics = {} if dimensions is None else {"map_dimensions": dimensions}
        results[name] = predicted, feature_watch.seconds + seconds + own_seconds, metrics
    return results


def _rows(trial, data, truth, results):
    frames, cells = trial.frames_and_cells
    rounds = data.folds if trial.split == Split.OBJECTS else trial.repetition + 1
    training, repetition = divmod(trial.repetition, rounds)
    common = {"method": trial.strategy, "split": trial.split, "repetition": repetition, "training": training}
    common |= {"frames": frames, "cells": cells, "classes": len(data.classes), "sequences": len(data.labels)}
    rows = []
    for name, (predicted, seconds, extra_metrics) in results.items():
        common_row, correct = common | {"classifier": name}, predicted == truth
        rows.append(common_row | {"metric": "accuracy", "value": float(correct.mean()), "seconds": seconds})
        rows += [common_row | {"metric": metric, "value": value} for metric, value in extra_metrics.items()]
        if trial.split == Split.OBJECTS:  # one object of each class was tested: its accuracy
            accuracy_by_class = {label: float(correct[truth == k].mean()) for k, label in enumerate(data.classes)}
            rows += [
                common_row | {"group": label, "metric": "accuracy_object", "value": value}
                for label, value in accuracy_by_class.items()
            ]
    return rows

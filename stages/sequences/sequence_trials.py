"""Trials of recognition by contours: their plan, splits, data and results.

A split draws sequences at random, as in the thesis, or holds out whole objects. Sequences have the full size, or fewer
frames and cells. A trial has the classifiers of one kind on one strategy, split, repetition and size. The plan names
the trials that are left out, with the reason.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pywt
from numpy.typing import ArrayLike
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know.split import Split
from stages.contours.contours import read_sequences
from stages.engine.run import Rows
from stages.engine.statistics import Split as Parts
from stages.engine.statistics import stratified_split
from stages.sequences.contourlet import DIRECTIONS, directional_std

from . import Params
from .classifiers import CONVENTIONAL, Reduced, choose_dimensions
from .networks import SHORTEST, SMALLEST, ImageInputs, NormalInputs, class_probabilities, train_network

WAVELET, LEVELS = "db2", 3  # T4.4.9
MODE = "symmetric"  # at the ends of a series; the thesis names none, and this is the default of Matlab, which it used
STATISTICS = ("rms", "std", "skewness")
BANDS = (*(f"detail{level}" for level in range(1, LEVELS + 1)), "sequence")
CHANNELS = (*(f"direction{k}" for k in range(DIRECTIONS)), "normal_x", "normal_y", "normal_z")
FEATURES = tuple(f"{channel}.{band}.{name}" for channel in CHANNELS for band in BANDS for name in STATISTICS)
CONSTANT = 1e-6  # of the largest value of its series: a smaller standard deviation is rounding error


def series(images: ArrayLike, normals: ArrayLike) -> np.ndarray:
    """(n, frames, 19) f8: sixteen directional features of each imprint, then the array's normal (T4.4.9).

    images (n, frames, rows, cols) u1 0..255 or floats 0..1, normals (n, frames, 3).
    """
    images, normals = np.asarray(images), np.asarray(normals, dtype=np.float64)
    if images.ndim != 4 or normals.shape != (*images.shape[:2], 3):
        raise ValueError(
            f"images must have shape (n, frames, rows, cols), normals (n, frames, 3): {images.shape}, {normals.shape}"
        )
    count, frames, *cells = images.shape
    directions = directional_std(images.reshape(count * frames, *cells)).reshape(count, frames, DIRECTIONS)
    return np.concatenate([directions, normals], axis=2)


def sequence_features(values: ArrayLike) -> np.ndarray:
    """(n, 12 s) f8: root mean square, standard deviation and skewness of s series and of their wavelets.

    values: (n, frames, s). The statistics are taken of the series itself and of its detail coefficients in three levels
    of db2, level 1 the finest. The 19 series of `series` give 228 numbers, named by FEATURES. A constant series has
    skewness 0. Short series have three levels too, although their coefficients mostly depend on the ends.
    Raises ValueError for another shape, fewer than 2 frames, or NaN.
    """
    values = np.asarray(values, dtype=np.float64)
    if values.ndim != 3 or values.shape[1] < 2:
        raise ValueError(f"values must have shape (n, frames, s) with 2 frames or more, got {values.shape}")
    if not np.isfinite(values).all():
        raise ValueError("values hold NaN or infinite numbers")
    bands, approximation = [], values
    for _ in range(LEVELS):
        approximation, detail = pywt.dwt(approximation, WAVELET, mode=MODE, axis=1)
        bands.append(detail)
    least = CONSTANT * np.abs(values).max(axis=1)
    statistics = np.stack([_statistics(band, least) for band in (*bands, values)], axis=2)
    return statistics.reshape(len(values), np.prod(statistics.shape[1:]))


def _statistics(band, least):
    """(n, s, 3): the STATISTICS over the coefficients (n, k, s); least (n, s): the spread of a constant."""
    mean = band.mean(axis=1)
    deviations = band - mean[:, None]
    std = np.sqrt((deviations**2).mean(axis=1))
    varies = std > least
    skewness = np.divide((deviations**3).mean(axis=1), std**3, out=np.zeros_like(std), where=varies)
    return np.stack([np.sqrt((band**2).mean(axis=1)), np.where(varies, std, 0), skewness], axis=2)


TEST_SHARE = 0.2  # T4.4.10: 80:20
VALIDATION_SHARE = 0.2  # of the training sequences, to choose settings on


def split_by_sequences(labels: np.ndarray, generator: np.random.Generator) -> Parts:
    """The Parts that tests a random fifth of every class. Both sides share objects and nearly equal planes."""
    test = _draw_share(labels, np.arange(len(labels)), TEST_SHARE, generator)
    train = np.setdiff1d(np.arange(len(labels)), test)
    return Parts(train, _draw_share(labels, train, VALIDATION_SHARE, generator), test)


def split_by_objects(
    labels: np.ndarray, ranks: np.ndarray, fold: int, folds: int, generator: np.random.Generator
) -> Parts:
    """The Parts that tests the object of rank `fold` of every class; the next object of every class is for validation.

    With two objects per class, a random fifth of the training sequences is for validation.
    """
    test, train = np.flatnonzero(ranks == fold), np.flatnonzero(ranks != fold)
    if folds < 3:
        return Parts(train, _draw_share(labels, train, VALIDATION_SHARE, generator), test)
    return Parts(train, np.flatnonzero(ranks == (fold + 1) % folds), test)


def _draw_share(labels, ids, share, generator):
    """Sorted indices: a share of every class."""
    return ids[stratified_split(labels[ids], share, generator)[0]]


@dataclass(frozen=True, eq=False)
class SequenceData:
    """n sequences: images (n, frames, rows, cols) u1, normals (n, frames, 3) f4, labels (n,) i8 into classes.

    ranks (n,) i8: the number, from 0, of the sequence's object among the objects of its class.
    """

    images: np.ndarray
    normals: np.ndarray
    labels: np.ndarray
    ranks: np.ndarray
    classes: list[str]

    @property
    def folds(self) -> int:
        """The number of folds that hold out one object of every class: that of objects in the smallest class."""
        return int(min(len(np.unique(self.ranks[self.labels == label])) for label in range(len(self.classes))))


def count_sequences(path: Path) -> dict[str, int]:
    """{strategy: number of sequences} of a file of data/SET/contours, without reading their images."""
    with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as archive:
        names = sorted({name.rpartition(".")[0] for name in archive.files})
        return {name: len(archive[f"{name}.planes"]) for name in names}


def read_sequence_data(folder: Path, members: dict[str, list[str]], strategy: str) -> SequenceData:
    """The SequenceData of one strategy. folder: data/SET/contours; members: {class: objects}, all with sequences."""
    images, normals, labels, ranks = [], [], [], []
    for label, objects in enumerate(members.values()):
        for rank, name in enumerate(objects):
            sequences = read_sequences(folder / f"{name}.npz", strategy)[strategy]
            images.append(sequences.images)
            normals.append(sequences.normals)
            labels += [label] * len(sequences.images)
            ranks += [rank] * len(sequences.images)
    return SequenceData(
        np.concatenate(images), np.concatenate(normals), np.array(labels), np.array(ranks), list(members)
    )


def downsample(data: SequenceData, frames: int, cells: int) -> SequenceData:
    """The SequenceData with `frames` evenly spaced frames and imprints of `cells` rows, each cell the mean of a block.

    Raises ValueError for more frames than there are, or a number of cells that does not divide the imprints.
    """
    count, available, rows, columns = data.images.shape
    if not 1 <= frames <= available:
        raise ValueError(f"{frames} frames requested, the sequences have {available}")
    if not is_divisible(cells, rows, columns):
        raise ValueError(f"imprints of {rows} x {columns} cells cannot be averaged to {cells} rows")
    if (frames, cells) == (available, rows):
        return data
    frame_ids, side = np.arange(frames) * available // frames, rows // cells
    blocks = data.images[:, frame_ids].reshape(count, frames, cells, side, columns // side, side)
    images = np.round(blocks.mean(axis=(3, 5), dtype=np.float32)).astype(np.uint8)
    return replace(data, images=images, normals=data.normals[:, frame_ids])


def is_divisible(cells: int, rows: int, columns: int) -> bool:
    """True if imprints of rows x columns divide into square blocks, `cells` of them in a column."""
    return 1 <= cells <= rows and rows % cells == 0 and columns % (rows // cells) == 0


# Each split by its word in reports/metrics and in the seeds of the random numbers, on which the results depend.
SPLITS = {Split.RANDOM: "sequences", Split.OBJECTS: "objects"}
KINDS = ("networks", "conventional")
Result = tuple[np.ndarray, float, dict[str, float]]  # predictions for the test part, seconds, further metrics


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
    inputs = downsample(read_sequence_data(data / "contours", members, trial.strategy), *trial.frames_and_cells)
    random = rng(seed, f"sequences {SPLITS[trial.split]} {trial.repetition}")
    if trial.split == Split.OBJECTS:
        parts = split_by_objects(inputs.labels, inputs.ranks, trial.repetition % inputs.folds, inputs.folds, random)
    else:
        parts = split_by_sequences(inputs.labels, random)
    with threadpool_limits(1):  # equal sums on any number of cores
        if trial.kind == "networks":
            results = network_results(inputs, parts, settings, int(random.integers(2**31)))
        else:
            results = conventional_results(inputs, parts)
    predictions = {classifier: predicted for classifier, (predicted, _, _) in results.items()}
    truth = inputs.labels[parts.test]
    write_arrays(folder / "predictions" / f"{name}.npz", test=parts.test, true=truth, **predictions)
    return _rows(trial, inputs, truth, results)


def network_results(data: SequenceData, parts: Parts, settings: Params, seed: int) -> dict[str, Result]:
    """{classifier: Result} of both networks and of the sum of their probabilities.

    Metrics: `train_accuracy`; of a network `passes` and `settled`, 1 where its training loss had stopped falling.
    """
    predicted, learned, results = {}, {}, {}
    for name, kind, epochs in (
        ("cnn_images", ImageInputs, settings.image_epochs),
        ("cnn_normals", NormalInputs, settings.normal_epochs),
    ):
        with Stopwatch() as watch:
            inputs = kind(getattr(data, name.removeprefix("cnn_")), parts.train)
            trained = train_network(inputs, data.labels, parts.train, len(data.classes), epochs, seed)
            predicted[name] = class_probabilities(trained.network, inputs, parts.test)
        learned[name] = class_probabilities(trained.network, inputs, parts.train)
        metrics = {"passes": trained.passes, "settled": int(trained.settled)}
        results[name] = predicted[name].argmax(axis=1), watch.seconds, metrics
    seconds = sum(seconds for _, seconds, _ in results.values())
    results["cnn"] = np.sum(list(predicted.values()), axis=0).argmax(axis=1), seconds, {}
    learned["cnn"] = np.sum(list(learned.values()), axis=0)
    for name, (_, _, metrics) in results.items():
        metrics["train_accuracy"] = float((learned[name].argmax(axis=1) == data.labels[parts.train]).mean())
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


MIN_SEQUENCES = 5  # per object and strategy: a split of 80:20 then still tests one


class Plan(NamedTuple):
    """The trials of a run, {class: objects} that take part, and one note for each thing that is left out."""

    trials: list[Trial]
    members: dict[str, list[str]]
    notes: list[str]


def plan(classes: dict[str, list[str]], folder: Path, settings: Params) -> Plan:
    """The Plan for classes {class: objects} with their sequences in `folder` (data/SET/contours).

    Every strategy is tested in both splits with all classifiers. Fewer frames and smaller imprints are tested on one
    strategy, with objects held out where every class has two or more. There are no trials with fewer than two classes.
    """
    members, notes = _members(classes, folder)
    if len(members) < 2:
        return Plan([], members, [*notes, f"two classes with sequences are needed, got {len(members)}"])
    strategies, left_out = _strategies(members, folder)
    notes += left_out
    if not strategies:
        return Plan([], members, [*notes, "no strategy has sequences of every object"])
    first = next(iter(members.values()))[0]
    shape = read_sequences(folder / f"{first}.npz")[strategies[0]].images.shape[1:]
    folds = min(len(objects) for objects in members.values())
    if folds < 2:
        notes.append("objects are not held out: every class needs two or more")
    object_rounds = [(Split.OBJECTS, number) for number in range(folds * settings.trainings)] if folds > 1 else []
    rounds = [(Split.RANDOM, number) for number in range(settings.repetitions)] + object_rounds
    full_size = _possible(f"{shape[0]}x{shape[1]}", shape, KINDS, notes)
    trials = [
        Trial(strategy, *turn, kind, size) for strategy in strategies for turn in rounds for kind, size in full_size
    ]
    if settings.smaller_strategy in strategies:
        for kind, sizes in (("networks", settings.smaller_networks), ("conventional", settings.smaller)):
            reduced = [pair for size in sizes for pair in _possible(size, shape, [kind], notes)]
            trials += [
                Trial(settings.smaller_strategy, *turn, *pair) for pair in reduced for turn in object_rounds or rounds
            ]
    return Plan(list(dict.fromkeys(trials)), members, notes)


def _members(classes, folder):
    """({class: its objects that have sequences}, notes)."""
    members, notes = {}, []
    for name, objects in classes.items():
        available = [item for item in objects if (folder / f"{item}.npz").exists()]
        missing = [item for item in objects if item not in available]
        if missing:
            notes.append(f"class {name}: no sequences of {', '.join(missing)}")
        if available:
            members[name] = available
    return members, notes


def _strategies(members, folder):
    """(strategies with enough sequences of every object, notes on the others)."""
    counts = {item: count_sequences(folder / f"{item}.npz") for objects in members.values() for item in objects}
    usable, notes = [], []
    for strategy in dict.fromkeys(name for by_strategy in counts.values() for name in by_strategy):
        too_few = [item for item, by_strategy in counts.items() if by_strategy.get(strategy, 0) < MIN_SEQUENCES]
        if too_few:
            notes.append(f"{strategy} left out: fewer than {MIN_SEQUENCES} sequences of {', '.join(too_few)}")
        else:
            usable.append(strategy)
    return usable, notes


def _possible(size, shape, kinds, notes):
    """[(kind, size)] of the kinds that accept sequences of this size; appends to the notes why others do not."""
    match = re.fullmatch(r"(\d+)x(\d+)", size)
    if match is None:
        raise ValueError(f"sequences.smaller: {size!r} is not of the form FRAMESxCELLS, such as 13x16")
    frames, cells = map(int, match.groups())
    available, rows, columns = shape
    if not 2 <= frames <= available or cells < 4 or not is_divisible(cells, rows, columns):
        notes.append(f"size {size} left out: the sequences have {available} frames of {rows} x {columns} cells")
        return []
    small = frames < SHORTEST or cells < SMALLEST
    if small and "networks" in kinds:
        notes.append(f"networks left out at {size}: they need {SHORTEST} frames of {SMALLEST} x {SMALLEST} cells")
    return [(kind, size) for kind in kinds if kind != "networks" or not small]

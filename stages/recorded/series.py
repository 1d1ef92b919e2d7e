"""Series of recorded touches: readers, and recognition of grasps by a hand with pressure arrays.

The readers are for events of a NeuTouch fingertip and for grasps of a hand. No grasp is in both training and test. Only
few grasps exist.
"""

import functools
import io
import re
import tokenize
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.know.split import Split
from stages.classification.recorded import open_root
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.transfer.recorded import fingers

from .splits import binned, choose

EVENTS = "the archive of TactileSGNet: Ev-Objects and Ev-Containers, each with train and test/sample_I_label_L.npy"
GRASPS = "the grasps of st-hmp: OBJECT/grasp-NUMBER.mat and _setup/test.list"
KINDS = {"objects": "Ev-Objects", "containers": "Ev-Containers"}
# (39, 2): where the taxels lie, in their publisher's units and order (Gu, Sng, Taunyazov and Soh, IROS 2020).
TAXELS = np.array([
    (-6, 0), (-5.3, -3), (-5.3, 3), (-4.6, -7.8), (-4.6, 7.8), (-3.5, 0), (-3.05, -5.2), (-3.05, 5.2), (-3.1, -1.75),
    (-3.1, 1.75), (-1.6, -8.9), (-1.75, -3), (-1.6, 8.9), (-1.75, 3), (-1.5, 0), (-0.7, -1.3), (-0.7, 1.3), (0, -6),
    (0, 6), (0, -3.5), (0, 0), (0, 3.5), (0.8, -1.3), (0.8, 1.3), (1.6, -8.9), (1.6, 8.9), (1.5, 0), (1.75, 3),
    (1.75, -3), (3.05, -5.2), (3.1, 1.75), (3.05, 5.2), (3.1, -1.75), (3.6, 0), (4.6, -7.8), (4.6, 7.8), (5.3, -3),
    (5.3, 3), (6, 0),
])  # fmt: skip


# What reading a damaged file raises: a header that asks for more memory than there is, or is no Python, too.
DAMAGE = (
    ValueError, OSError, EOFError, zipfile.BadZipFile, zlib.error, SyntaxError, MemoryError, tokenize.TokenError,
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class TouchSeries:
    """n touches over t steps: values (n, cells, channels, t), not negative; labels (n,) names of what is touched;
    names (n,) of the recordings; test (n,) boolean: those that the publisher keeps for testing.
    """

    values: np.ndarray
    labels: np.ndarray
    names: np.ndarray
    test: np.ndarray

    def of(self, index: np.ndarray) -> "TouchSeries":
        """The part that the ids or the mask `index` names."""
        return TouchSeries(self.values[index], self.labels[index], self.names[index], self.test[index])


def read_touch_events(path: str | Path) -> dict[str, TouchSeries]:
    """{objects, containers: TouchSeries} of events: 39 taxels of two polarities, 250 or 325 steps, 0 or 1 each.

    path: the zip file, or a folder with the same in it. 720 touches of 36 household objects and 300 of 20 containers,
    a file each; the events of Gu, Sng, Taunyazov and Soh, TactileSGNet, IROS 2020. Raises ValueError, with the file and
    the remedy, for anything else.
    """
    root = open_root(path, EVENTS)
    return {kind: _events(root, folder, path) for kind, folder in KINDS.items()}


def read_grasp_series(path: str | Path) -> dict[str, TouchSeries]:
    """{"grasps": TouchSeries}: 486 cells of three fingers, 294 steps, the rise of the pressure over the first reading.

    path: the zip file, or a folder with the same in it. 51 grasps of five objects (Drimus and others 2014; Madry and
    others 2014), of which the published list tests one of each. Raises ValueError, with the file and the remedy, for
    anything else.
    """
    root = open_root(path, GRASPS)
    homes = sorted(
        (entry for entry in root.iterdir() if entry.is_dir() and entry.name[0] != "_"), key=lambda entry: entry.name
    )
    files = [file for home in homes for file in sorted(home.iterdir(), key=str)]
    if not files or not (listed := root / "_setup/test.list").exists():
        raise ValueError(f"{path} has no {'_setup/test.list' if files else 'grasp'}; expected {GRASPS}")
    test_names = {Path(line).name for line in listed.read_text().splitlines()}
    names = np.array([file.name for file in files])
    if missing := test_names - {*names}:
        raise ValueError(f"{path} lacks {min(missing)}, which _setup/test.list names: download it again")
    values = np.stack([np.concatenate(fingers(file)) for file in files])
    values = values.clip(0).reshape(len(files), -1, 1, values.shape[-1])
    labels = np.array([home.name for home in homes for _ in home.iterdir()])
    return {"grasps": TouchSeries(values, labels, names, np.isin(names, [*test_names]))}


def spread_taxels(count: int) -> np.ndarray:
    """(count,) taxels spread over the fingertip: the one in the middle, then each the farthest from those before."""
    taxels = [int(np.linalg.norm(TAXELS, axis=1).argmin())]
    while len(taxels) < count:
        distances = np.linalg.norm(TAXELS[:, None] - TAXELS[taxels], axis=2).min(axis=1)
        taxels.append(int(distances.argmax()))
    return np.sort(taxels)


def _events(root: Path | zipfile.Path, folder: str, path: str | Path) -> TouchSeries:
    parts = [_part(root, f"{folder}/{part}", path) for part in ("train", "test")]
    shapes = sorted({touch.shape for files in parts for _, _, touch in files})
    if len(shapes) > 1:
        raise ValueError(f"{path}: touches of {folder} differ in shape, {shapes}: download the archive again")
    events = [(label, f"{name}", values) for files in parts for label, name, values in files]
    labels, names, values = (np.array(column) for column in zip(*events, strict=True))
    return TouchSeries(values, labels, names, np.repeat([False, True], [len(files) for files in parts]))


def _part(root: Path | zipfile.Path, inside: str, path: str | Path) -> Sequence[tuple[str, str, np.ndarray]]:
    """(label, name, events) of each touch in a folder, in the order of their numbers."""
    folder = root / inside
    files = list(folder.iterdir()) if folder.is_dir() else []
    matches = [(re.fullmatch(r"sample_(\d+)_label_(\d+)\.npy", file.name), file) for file in files]
    numbered = sorted((int(match[1]), f"{int(match[2]):02}", file) for match, file in matches if match)
    if not numbered or [number for number, *_ in numbered] != list(range(len(numbered))):
        gap = next((k for k, (number, *_) in enumerate(numbered) if number != k), len(numbered))
        raise ValueError(f"{path} has no {inside}/sample_{gap}_label_L.npy; expected {EVENTS}")
    return [(label, f"{folder.name} {number}", _touch(file)) for number, label, file in numbered]


def _touch(file: Path | zipfile.Path) -> np.ndarray:
    """(39, 2, t) u1 of one file."""
    try:
        values = np.load(io.BytesIO(file.read_bytes()), allow_pickle=False)
    except DAMAGE as error:
        raise ValueError(f"{file} is damaged ({error}): download the archive again") from None
    good = getattr(values, "ndim", 0) == 3 and values.shape[:2] == (len(TAXELS), 2) and np.isin(values, (0, 1)).all()
    if not good:
        raise ValueError(f"{file} is no touch of {len(TAXELS)} taxels, two polarities, 0 or 1 at each step: remove it")
    return values.astype(np.uint8)


METHODS = ("discriminant", "linear_svm", "knn")  # of stages.recorded.splits
FOLDS = 10  # grasps of most objects, so that each fold leaves one of each object out, as the published lists do


def measure(run: StageRun, recordings: dict[str, TouchSeries], repetitions: int) -> None:
    """Adds rows of each method: a row for each grasp, 1 where its object is recognised; the chance is the commonest's.

    part test: the publisher's lists, one grasp of each object for the test; training: each of all grasps is left out
    one time, with one of each other object. Bins and parameter are chosen within the training part of each.
    """
    work = functools.partial(process, series=recordings["grasps"], repetitions=repetitions, seed=run.seed)
    run.each(work, METHODS)


def process(method: str, folder: Path, series: TouchSeries, repetitions: int, seed: int) -> Rows:
    """Rows of one method."""
    with threadpool_limits(1):  # equal sums on any number of cores
        rows = [row for part, out in parts(series) for row in _rows(method, series, part, out, repetitions, seed)]
    return [
        {"group": "grasps", "method": method, "metric": "accuracy", "cells": series.values.shape[1]} | row
        for row in rows
    ]


def parts(series: TouchSeries) -> Iterator[tuple[str, np.ndarray]]:
    """(part, mask of the grasps held out): the published list, then the k-th grasp of each object for all k."""
    yield "test", series.test
    number = np.zeros(len(series.labels), dtype=int)
    for label in np.unique(series.labels):
        mask = series.labels == label
        number[mask] = np.arange(mask.sum()) % FOLDS
    for k in range(number.max() + 1):
        yield "training", number == k


def summary(rows: Rows) -> dict[str, float]:
    """{part.method: the share of grasps recognised}."""
    return named_means((f"{row['part']}.{row['method']}", row["value"]) for row in rows)


def _rows(method: str, series: TouchSeries, part: str, out: np.ndarray, repetitions: int, seed: int) -> Iterator[dict]:
    training, test = series.of(~out), series.of(out)
    choice = choose(method, training.values, training.labels, repetitions, seed)
    model = choice.fitted(binned(training.values, choice.bins), training.labels)
    answers = model.predict(binned(test.values, choice.bins))
    common = {
        "part": part,
        "split": Split.OBJECTS,
        "bins": choice.bins,
        "parameter": choice.parameter,
        "train": len(training.labels),
    }
    for name, label, answer in zip(test.names, test.labels, answers, strict=True):
        yield common | {"item": f"{label}/{name}", "value": float(answer == label)}

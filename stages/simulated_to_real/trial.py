"""Trains classifiers on simulated imprints, on real touches and on both, and tests them on real touches."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn.decomposition import PCA
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from threadpoolctl import threadpool_limits

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import CLASSIFIERS
from haptic_glance.know.classifiers import COMPONENTS
from haptic_glance.know.split import Split
from stages.kit.run import Rows
from stages.recorded.splits import block_split, split_number


@dataclass(frozen=True)
class Touches:
    """Features (k, 41) and class (k,) of k touches."""

    samples: np.ndarray
    labels: np.ndarray


@dataclass(frozen=True)
class Training:
    """One way to train: columns of its rows, training touches, and all real features (k, 41) on the same scale."""

    columns: dict
    touches: Touches
    real: np.ndarray


def process(repetition: int, folder: Path, real: Touches, simulated: dict[str, Touches], counts: list[int],
            seed: int) -> Rows:  # fmt: skip
    """Rows of one split: a run of neighbouring real touches of each class is tested.

    real: in the order of recording; simulated: {simulation: its Touches}; counts: real touches of each class to train
    on, drawn from the rest. aligned: features scaled by the mean and deviation of their own kind: the simulated ones,
    and the real ones outside the test part, whatever their classes.
    """
    number = split_number(seed, repetition)
    pool, test = block_split(real.labels, number)
    rows = []
    with threadpool_limits(1):  # equal sums on any number of cores
        for count in counts:
            chosen = _draw(real.labels, pool, count, number)
            for training in _trainings(real, simulated, chosen, pool):
                common = {"split": Split.BLOCKS, "touches": count, "repetition": repetition}
                rows += [common | row for row in _test(training, real.labels, test, count, number)]
    return rows


def _trainings(
    real: Touches, simulated: dict[str, Touches], chosen: np.ndarray, pool: np.ndarray
) -> Iterator[Training]:
    labels = real.labels[chosen]
    if len(chosen):
        yield Training({"training": "real"}, Touches(real.samples[chosen], labels), real.samples)
    for kind, touches in simulated.items():
        for aligned in (False, True):
            own, there = touches.samples, real.samples
            if aligned:
                own, there = _scaled(own, own), _scaled(there, there[pool])
            columns = {"training": "both" if len(chosen) else "simulated", "simulation": kind, "aligned": aligned}
            both = Touches(np.concatenate([own, there[chosen]]), np.concatenate([touches.labels, labels]))
            yield Training(columns, both, there)


def _test(training: Training, labels: np.ndarray, test: np.ndarray, count: int, number: int) -> Iterator[dict]:
    train, wanted = training.touches, labels[test]
    for name in CLASSIFIERS:
        parts = min(COMPONENTS, len(train.samples))
        model = make_pipeline(StandardScaler(), PCA(parts, svd_solver="full"), CLASSIFIERS[name](number))
        with Stopwatch() as watch:
            answers = model.fit(train.samples, train.labels).predict(training.real[test])
        row = {**training.columns, "classifier": name, "metric": "accuracy", "seconds": watch.seconds}
        yield {**row, "group": "all", "value": float((answers == wanted).mean())}
        if name == "knn" and count == 0:
            for one in dict.fromkeys(labels.tolist()):
                yield {**row, "group": one, "value": float((answers == one)[wanted == one].mean())}


def _draw(labels: np.ndarray, pool: np.ndarray, count: int, number: int) -> np.ndarray:
    random = np.random.default_rng([number, count])
    classes = dict.fromkeys(labels.tolist())
    drawn = [random.choice(pool[labels[pool] == one], count, replace=False) for one in classes]
    return np.concatenate(drawn).astype(np.int64)


def _scaled(samples: np.ndarray, reference: np.ndarray) -> np.ndarray:
    spread = reference.std(axis=0)
    return (samples - reference.mean(axis=0)) / np.where(spread > 0, spread, 1)

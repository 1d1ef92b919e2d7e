"""The classifier of T4 on the recorded touches that networks are trained on, on the same splits."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import classifier
from stages.classification.recorded import read_grasps, read_pressure_images
from stages.recorded.biotac_grasps import Model, publisher_split_rows, recognition_rows
from stages.recorded.pressure_images import describe
from stages.recorded.splits import SPLITS, split_number

METHOD = "features_knn"  # the hand-made features of T4, or the electrodes, and the k nearest neighbours
COLUMNS = ("item", "data", "split", "repetition", "metric", "value", "seconds")


def neighbour_rows(kind: str, path: Path, repetitions: int, seed: int) -> list[dict]:
    """Rows of the classifier on a kind of recording, split as in stage `recorded`; none for a kind of cameras."""
    if kind not in READERS:
        return []
    with threadpool_limits(1):  # equal sums on any number of cores
        rows = list(READERS[kind](path, repetitions, seed))
    return [{"method": METHOD, "metric": "accuracy"} | {key: row[key] for key in COLUMNS if key in row} for row in rows]


def _pressure(path: Path, repetitions: int, seed: int) -> Iterator[dict]:
    touches = describe(read_pressure_images(path))
    for split, draw in SPLITS.items():
        for repetition in range(repetitions):
            number = split_number(seed, repetition)
            train, test = draw(touches.labels, number)
            with Stopwatch() as watch:
                model = classifier("knn", number).fit(touches.samples[train], touches.labels[train])
                answers = model.predict(touches.samples[test])
            row = {"data": "pressure", "split": split, "repetition": repetition, "seconds": watch.seconds}
            yield row | {"value": float((answers == touches.labels[test]).mean())}


def _grasps(path: Path, repetitions: int, seed: int) -> Iterator[dict]:
    grasps, model = read_grasps(path), Model("knn", None)
    yield from ({"data": "grasps_object"} | row for row in recognition_rows(model, grasps, repetitions, seed))
    slips = [row for row in publisher_split_rows(model, grasps) if row["palm"] == "all"]
    common = {"data": "grasps_slip", "repetition": 0}
    yield from (row | common for row in slips)
    mean = np.average([row["value"] for row in slips], weights=[row["count"] for row in slips])
    yield common | {"split": slips[0]["split"], "value": float(mean)}


READERS: dict[str, Callable[[Path, int, int], Iterator[dict]]] = {
    "pressure_images": _pressure, "biotac_grasps": _grasps,
}  # fmt: skip

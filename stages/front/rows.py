"""The rows of the front: what each holds, and where they are kept for the report."""

from collections.abc import Iterable
from pathlib import Path

from haptic_glance.know.split import Split
from stages.kit.rows import SUFFIX, write_rows
from stages.kit.run import Rows

COLUMNS = {
    "rung": "a name of stages.front.halving.RUNGS, `confirmation` or `one_choice`",
    "number": "of the choice, in the order in which it was first asked about",
    "role": "of a choice that is confirmed: smallest (within two points of the best), or default (the project's own)",
    "viewpoints": "set of viewpoints; empty where the method looks at no picture",
    "image_rows": "rows of an image",
    "points": "places that are looked for and learned, of each object",
    "cells": "sensels a side of the array, which is as wide whatever their number",
    "level": "faces that the model of an object was to have: a number, or 100% for all",
    "faces": "faces that it has",
    "touches": "touches of one answer",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
    "simplifying": "seconds, the first part of the column `seconds`",
    "looking": "seconds: pictures, maps, saliency and the choice of the places",
    "pressing": "seconds: the array on the object, once for each touch, and the features",
    "asking": "seconds of the classifier's answer",
    "training": "seconds of learning the object, not part of `seconds`",
}
STAGE = "front"


def write(measurements: Path, sets: tuple[str, str], rows: Rows, seed: int) -> list[Path]:
    """Writes the rows of shapes and of classes below the names of their data sets, and returns the files.

    Those of an earlier search go, whatever its sets: rows of two searches do not belong together.
    """
    paths = []
    for older in measurements.glob(f"*/{STAGE}{SUFFIX}"):
        older.unlink()
    for dataset, split in zip(sets, (Split.REGIONS, Split.OBJECTS), strict=True):
        paths.append(measurements / dataset / f"{STAGE}{SUFFIX}")
        write_rows(paths[-1], _of(rows, split), COLUMNS, dataset, seed)
    return paths


def _of(rows: Rows, split: Split) -> Iterable[dict]:
    return (row for row in rows if row["split"] == split)

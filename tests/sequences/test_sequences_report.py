"""Table 4.9 of less than all rows."""

from functools import partial
from itertools import product

import numpy as np
import pandas as pd
import pytest

from stages.report.parts import build_item
from stages.sequences import report as sequences

CLASSES = ("car", "chair", "vase")
MEANS = {"cnn": 0.9, "cnn_images": 0.8, "cnn_normals": 0.4, "knn": 0.6, "svm": 0.7, "knn_no_som": 0.65,
         "svm_no_som": 0.75}  # fmt: skip


def rows(guided=0.08, unseen=-0.2, splits=("random", "objects"), dataset="furniture", known=True):
    """Rows whose truth is known: guided is better by a margin, and unseen objects are harder.

    known: whether rows say that the networks know their training part.
    """
    random, entries = np.random.default_rng(0), []
    ways = (("random", 0.0), ("thesis_ssim", guided), ("glance", guided))
    for (method, gain), split, (name, mean) in product(ways, splits, MEANS.items()):
        common = {"dataset": dataset, "method": method, "split": split, "classifier": name, "training": 0}
        common |= {"frames": 25, "cells": 32, "classes": len(CLASSES), "sequences": 900, "seconds": 5.0}
        level = mean + gain + (unseen if split == "objects" else 0.0)
        for number in range(3):
            by_class = level + 0.005 * random.normal(size=len(CLASSES))
            entry = common | {"repetition": number, "metric": "accuracy", "group": None}
            entries.append(entry | {"value": by_class.mean()})
            if known and name.startswith("cnn_"):
                entries += [
                    entry | {"metric": "train_accuracy", "value": 1.0},
                    entry | {"metric": "passes", "value": 10},
                ]
            if split == "objects":
                entries += [entry | {"metric": "accuracy_object", "group": label, "value": value}
                            for label, value in zip(CLASSES, by_class, strict=True)]  # fmt: skip
    return pd.DataFrame(entries).assign(seed=0, note=None)


table_4_9 = partial(build_item, sequences, "tables", "table_4_9")


@pytest.mark.slow
def test_larger_run_stands_below_where_there_is_one(measure):
    note = {"dataset": "furniture", "metric": "accuracy", "note": "class far: no sequences of away"}
    frame = pd.concat([rows(splits=("random",)), pd.DataFrame([note])], ignore_index=True)
    results = measure("sequences", frame)
    table = table_4_9(results)
    assert set(table.frame["split"]) == {"random"}  # one half, without objects left out
    assert "Not run: class far: no sequences of away." in table.notes
    table = table_4_9(measure("sequences", rows(dataset="princeton_eight"), results=results))
    assert list(dict.fromkeys(table.frame["objects"])) == ["furniture", "princeton_eight"]

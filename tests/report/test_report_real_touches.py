"""Real touches in the report: the readings of table 4.4, grasps counted one by one, and the claims."""

from functools import partial
from itertools import product

import numpy as np
import pandas as pd
import pytest

from stages.report import recorded as topic
from stages.report.recorded.tables import CLASSES
from stages.report.topics import build_one

CLASSIFIERS = {"knn": 0.7, "svm": 0.4, "decision_tree": 0.5, "naive_bayes": 0.6, "deep_learning": 0.65}
GAIN = {"all": 0.0, "selected": 0.05, "selected_control": 0.0, "selected_training": -0.05}
EVENTS = {"discriminant": 0.96, "linear_svm": 0.9, "knn": 0.6}
LOSS = {"random": 0.0, "blocks": 0.1, "folds": 0.02}


def recorded():
    """Rows in which the selection gains 5 points, in training alone loses 5; blocks lose 10."""
    random, rows = np.random.default_rng(0), []
    for name in CLASSES:
        rows.append({"group": name, "method": "all", "metric": "share_similar", "value": 0.2, "repetition": 0})
        rows[-1]["chosen"] = "can pen"
        for repetition in range(6):
            luck = 0.01 * random.normal()
            rows += [
                {
                    "group": name, "method": method, "classifier": classifier, "metric": "accuracy", "split": split,
                    "repetition": repetition, "chosen": "can pen", "scaling": "training",
                    "value": mean + gain - loss + luck + 0.002 * random.normal(),
                }
                for method, gain in GAIN.items() for classifier, mean in CLASSIFIERS.items()
                for split, loss in LOSS.items()
            ]  # fmt: skip
    for metric, value in (("neighbour_correlation", 0.6), ("pair_correlation", 0.3)):
        rows.append({"group": "can", "metric": metric, "value": value})
    return pd.DataFrame(rows)


def transferred(help=0.1):
    """Rows in which simulated imprints besides real ones raise the accuracy by `help`."""
    random, rows = np.random.default_rng(2), []
    for classifier in ("knn", "deep_learning"):
        for repetition in range(5):
            for touches in (0, 1, 5, 20):
                mean = 0.2 + 0.02 * touches + 0.01 * random.normal()
                common = {"classifier": classifier, "touches": touches, "repetition": repetition, "metric": "accuracy"}
                common |= {"group": "all", "seconds": 0.1}
                if touches:
                    rows.append(common | {"training": "real", "value": mean})
                for kind, aligned in product(("array", "resting_skin"), (False, True)):
                    fields = {"training": "both" if touches else "simulated", "simulation": kind, "aligned": aligned}
                    rows.append(common | fields | {"value": mean + help + 0.001 * random.normal()})
    return pd.DataFrame(rows)


def event_rows(levels=EVENTS):
    """Ten objects that differ alike in all methods, and the accuracies of EVENTS."""
    rows = []
    for group, (method, level), k in product(("objects", "containers"), levels.items(), range(10)):
        common = {"dataset": "touch_events", "group": group, "method": method, "item": f"{k:02}", "metric": "accuracy"}
        common |= {"bins": 10, "parameter": 0.1, "heard": 1.0, "cells": 39, "value": level + 0.004 * (k - 4.5)}
        rows.append(common | {"part": "test"})
        folded = common | {"part": "training", "split": "folds"}
        rows += [folded | {"heard": heard, "value": common["value"] * heard} for heard in (0.25, 1.0)]
        rows += [folded | {"cells": 20, "value": common["value"] - 0.01 - 0.001 * k}]
        rows += [folded | {"disturbance": "jitter", "severity": 5.0, "value": common["value"] / 2}]
    return pd.DataFrame(rows)


def grasp_rows():
    """Twenty grasps, of which the discriminant knows all but one and kNN every other; of the list all and none."""
    rows = []
    for method, k in product(("discriminant", "knn"), range(20)):
        right = float(k > 0 if method == "discriminant" else k % 2)
        row = {"dataset": "schunk", "group": "grasps", "method": method, "item": f"cup/{k}", "metric": "accuracy"}
        rows.append(row | {"part": "training", "split": "objects", "value": right})
        if k < 5:
            rows.append(row | {"part": "test", "split": "objects", "value": float(method == "discriminant")})
    return pd.DataFrame(rows)


@pytest.fixture(scope="module")
def every(measure):
    """The results of a root with rows of all kinds."""
    results = measure("simulated_to_real", transferred(), "pressure_images")
    sets = {"pressure_images": recorded(), "touch_events": event_rows(), "schunk": grasp_rows()}
    return measure("recorded", pd.concat([frame.assign(dataset=name) for name, frame in sets.items()]), results=results)


table = partial(build_one, topic, "tables")


def test_table_4_4_has_the_readings_of_the_scale_behind(measure):
    rows = recorded()
    other = rows[(rows["method"] == "all") & (rows["split"] == "random")].assign(scaling="min_max")
    other["value"] += np.where(other["classifier"] == "svm", 0.3, 0.0)
    results = measure("recorded", pd.concat([rows, other]), "pressure_images")
    shown = table("table_4_4", results).shown.set_index(["set", "selection"])
    cells = shown.loc[("all 22 classes", "no selection: all data from 0 to 1")]
    assert cells["SVM, %"].startswith("70 [") and cells["mean of all, %"].startswith("63 [")
    assert shown.loc[("all 22 classes", "no selection"), "SVM, %"].startswith("40 [")

"""Real touches in the report: the readings of table 4.4, and the claims."""

from functools import partial
from itertools import product

import numpy as np
import pandas as pd
import pytest

from stages.recorded.report import CLASSES
from stages.recorded_networks import report as topic
from stages.report.parts import build_item

CLASSIFIERS = {"knn": 0.7, "svm": 0.4, "decision_tree": 0.5, "naive_bayes": 0.6, "deep_learning": 0.65}
GAIN = {"all": 0.0, "selected": 0.05, "selected_control": 0.0, "selected_training": -0.05}
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


@pytest.fixture(scope="module")
def every(measure):
    """The results of a root with rows of all kinds."""
    results = measure("simulated_to_real", transferred(), "pressure_images")
    return measure("recorded", recorded(), "pressure_images", results=results)


table = partial(build_item, topic, "tables")


def test_table_4_4_has_the_readings_of_the_scale_behind(measure):
    rows = recorded()
    other = rows[(rows["method"] == "all") & (rows["split"] == "random")].assign(scaling="min_max")
    other["value"] += np.where(other["classifier"] == "svm", 0.3, 0.0)
    results = measure("recorded", pd.concat([rows, other]), "pressure_images")
    shown = table("table_4_4", results).shown.set_index(["set", "selection"])
    cells = shown.loc[("all 22 classes", "no selection: all data from 0 to 1")]
    assert cells["SVM, %"].startswith("70 [") and cells["mean of all, %"].startswith("63 [")
    assert shown.loc[("all 22 classes", "no selection"), "SVM, %"].startswith("40 [")

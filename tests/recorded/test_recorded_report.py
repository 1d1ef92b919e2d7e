"""The readings of table 4.4, on rows with a known truth."""

import numpy as np
import pandas as pd

from stages.recorded import report
from stages.recorded.report import CLASSES
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


def test_table_4_4_has_the_readings_of_the_scale_behind(measure):
    rows = recorded()
    other = rows[(rows["method"] == "all") & (rows["split"] == "random")].assign(scaling="min_max")
    other["value"] += np.where(other["classifier"] == "svm", 0.3, 0.0)
    results = measure("recorded", pd.concat([rows, other]), "pressure_images")
    shown = build_item(report, "tables", "table_4_4", results).shown.set_index(["set", "selection"])
    cells = shown.loc[("all 22 classes", "no selection: all data from 0 to 1")]
    assert cells["SVM, %"].startswith("70 [")
    assert shown.loc[("all 22 classes", "no selection"), "SVM, %"].startswith("40 [")

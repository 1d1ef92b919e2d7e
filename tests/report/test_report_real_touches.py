"""Real touches in the report: table 4.4's twin, grasps, simulation beside real touches, touch events, the claims."""

import re
from functools import partial
from itertools import product

import numpy as np
import pandas as pd
import pytest

from stages.report import recorded as topic
from stages.report.recorded.claims import SERIES
from stages.report.recorded.claims import TOUCHES as CLAIMS
from stages.report.recorded.grasps import TASKS
from stages.report.recorded.table_4_4 import CLASSES
from stages.report.recorded.touch_events import PUBLISHED
from stages.report.topics import build_one
from tests.report.frames import verdicts

CLASSIFIERS = {"knn": 0.7, "svm": 0.4, "decision_tree": 0.5, "naive_bayes": 0.6, "deep_learning": 0.65}
GAIN = {"all": 0.0, "selected": 0.05, "selected_control": 0.0, "selected_training": -0.05}
EVENTS = {"discriminant": 0.96, "linear_svm": 0.9, "knn": 0.6}
LOSS = {"random": 0.0, "blocks": 0.1, "folds": 0.02}


def recorded():
    """Rows in which the selection gains 5 points, in training alone loses 5; blocks lose 10."""
    random, rows = np.random.default_rng(0), []
    for name in CLASSES:
        share = {"group": name, "method": "all", "metric": "share_similar", "value": 0.2, "repetition": 0}
        rows.append(share | {"chosen": "can pen"})
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
    for name, near in (("can", 0.6), ("pen", 0.5), ("tube", 0.7)):
        rows.append({"group": name, "metric": "neighbour_correlation", "value": near})
        rows.append({"group": name, "metric": "pair_correlation", "value": near / 2})
    return pd.DataFrame(rows)


def grasped():
    """Rows in which the answers are right on 8 of 10 grasps of the objects, and one drift a palm."""
    random, rows = np.random.default_rng(1), []
    for (task, split), components in zip(TASKS, (12, 72, 12, 72), strict=True):
        for classifier in (*CLASSIFIERS, "majority"):
            common = {"task": task, "split": split, "palm": "all", "scaled": "training", "components": components}
            common |= {"classifier": classifier, "metric": "accuracy", "seconds": 0.1}
            for k in range(5):
                row = {"repetition": k} if task == "recognition" else {"item": f"o{k}"}
                rows.append(common | row | {"value": 0.8 + 0.01 * random.normal()})
    rows += [
        {"task": "slip", "palm": palm, "metric": metric, "value": value}
        for palm, metric, value in (("45", "drift", 0.5), ("down", "drift", 3), ("45", "drift_drawn", 0.4),
                                    ("down", "drift_drawn", 1.2))
    ]  # fmt: skip
    for classifier, mean in {"knn": 0.9, "svm": 0.5, "majority": 0.5}.items():
        common = {"task": "slip", "split": "test_objects", "palm": "down", "scaled": "own", "components": 12}
        common |= {"classifier": classifier, "metric": "accuracy", "seconds": 0.1}
        rows += [common | {"item": f"o{k}", "value": mean + 0.01 * (-1) ** k} for k in range(6)]
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
                for kind in ("array", "resting_skin"):
                    for aligned in (False, True):
                        fields = {
                            "training": "both" if touches else "simulated",
                            "simulation": kind,
                            "aligned": aligned,
                        }
                        rows.append(common | fields | {"value": mean + help + 0.001 * random.normal()})
                        if not touches:
                            rows.append(common | fields | {"group": "ball", "value": 0.5 + 0.1 * aligned})
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
        if k == 0:
            about = common | {"item": None, "part": "test"}
            rows += [about | {"metric": metric, "value": 2.0} for metric in ("milliseconds", "training_seconds")]
            rows.append(about | {"metric": "cross_validated", "value": level, "part": "training", "split": "folds"})
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
    sets = {
        "pressure_images": recorded(),
        "biotac_grasps": grasped(),
        "touch_events": event_rows(),
        "schunk": grasp_rows(),
    }
    return measure("recorded", pd.concat([frame.assign(dataset=name) for name, frame in sets.items()]), results=results)


table = partial(build_one, topic, "tables")


def test_table_4_4_stands_beside_the_thesis(every):
    made = table("table_4_4", every)
    rows = made.frame.set_index(["set", "selection", "classifier"])
    assert rows.loc[("six", "selected", "knn"), "accuracy"] == pytest.approx(0.75, abs=0.01)
    assert rows.loc[("six", "selected", "knn"), "thesis"] == 0.59 and rows.loc[("four", "all", "svm"), "thesis"] == 0.48
    assert rows.loc[("six", "selected_training", "knn"), "thesis"] != rows.loc[("six", "selected", "knn"), "thesis"]
    assert len(made.shown) == len(CLASSES) * 4 + 4 and made.shown.iloc[0, 0] == "first four classes"
    printed = made.shown.set_index(["set", "selection"])["kNN, %"]
    assert printed["the thesis, four toys", "no selection"] == "62"
    means = made.shown.set_index(["set", "selection"]).loc[("all 22 classes", "no selection")]
    assert (means["mean of all, %"][:2], means["mean without the SVM, %"][:2]) == ("57", "61")
    notes = " ".join(made.notes)
    assert "Gandarias" in notes and re.search(r"lowers kNN on all classes by (9\.9|10\.[01]) points", notes)
    assert "first four classes 20.0 %" in notes and "Most alike: can, pen; four: can, pen" in notes


def test_table_4_4_has_the_readings_of_the_scale_behind(measure):
    rows = recorded()
    other = rows[(rows["method"] == "all") & (rows["split"] == "random")].assign(scaling="min_max")
    other["value"] += np.where(other["classifier"] == "svm", 0.3, 0.0)
    results = measure("recorded", pd.concat([rows, other]), "pressure_images")
    shown = table("table_4_4", results).shown.set_index(["set", "selection"])
    cells = shown.loc[("all 22 classes", "no selection: all data from 0 to 1")]
    assert cells["SVM, %"].startswith("70 [") and cells["mean of all, %"].startswith("63 [")
    assert shown.loc[("all 22 classes", "no selection"), "SVM, %"].startswith("40 [")


def test_grasps_are_told_by_task_with_their_drift(every):
    made = table("grasps", every)
    shown = made.shown[made.shown["palm"] == "all"]
    assert shown["task"].tolist() == list(TASKS.values())
    assert made.frame.loc[made.frame["palm"] == "all", "accuracy"].to_numpy() == pytest.approx(0.8, abs=0.02)
    assert shown["values"].tolist() == ["12 components", "electrodes"] * 2
    notes = " ".join(made.notes)
    assert "palm 45 0.5, palm down 3.0" in notes
    assert "random training objects it moves by palm 45 0.4, palm down 1.2 at most" in notes
    assert "by palm and scale: palm down, each part by its own 1 of 2." in notes


def test_simulation_is_compared_by_the_number_of_real_touches(every):
    made = table("simulated_to_real", every)
    assert made.shown["simulated imprints"].iloc[0] == "none"
    assert made.shown.iloc[0, 1] == "–" and made.shown.iloc[1, 1].startswith("30 [")
    rows = made.frame.set_index(["training", "touches", "classifier"])
    assert rows.loc[("real", 5, "knn"), "accuracy"].item() == pytest.approx(0.3, abs=0.02)
    assert any("aligned, the best" in note and "ball 60" in note for note in made.notes)


@pytest.mark.slow
def test_selection_simulation_and_the_best_classifier_are_judged_on_real_touches(every, measure):
    judged = verdicts(CLAIMS, every)
    assert judged.loc["simulation_helps_5", "verdict"] == "supported"
    worse = measure("simulated_to_real", transferred(-0.1), "pressure_images")
    worse = verdicts(CLAIMS, worse, "simulation_helps_5").iloc[0]
    assert worse["verdict"] == "contradicted" and worse["effect"] == pytest.approx(-10, abs=0.5)
    assert judged.loc["real_selection_six_alike", "effect"] == pytest.approx(5, abs=0.3)
    assert judged.loc["real_selection_training", "verdict"] == "contradicted"
    assert judged.loc["real_knn_best_all", "effect"] == pytest.approx(5, abs=0.5)
    assert judged.loc["real_blocked", "verdict"] == "supported"


def test_methods_stand_beside_the_published_ones_with_what_they_take(every):
    made = table("touch_events", every)
    lines = made.text.set_index("method")
    assert lines.loc["linear discriminant", "36 objects"].startswith("96.00 [")
    assert lines.loc["kNN", "linear discriminant − it, objects"].startswith("+36.0")
    assert lines.loc["published: TactileSGNet, spiking graph network (Gu and others 2020)", "20 containers"] == "64.17"
    assert len(lines) == len(EVENTS) + len(PUBLISHED)
    assert "36 objects linear discriminant, 96.0" in "\n".join(made.notes)


def test_what_it_takes_has_a_row_a_condition(every):
    made = table("touch_events_conditions", every)
    levels = made.text.groupby("condition")["level"].apply(list).to_dict()
    assert levels == {
        "share of the touch heard": ["0.250", "1"], "taxels": ["20", "39"],
        "deviation of an event's time, steps": ["5"],
    }  # fmt: skip


def test_grasps_are_counted_one_by_one(every):
    made = table("grasp_series", every)
    assert made.text["published test list"].tolist() == ["5 of 5", "0 of 5"]
    assert made.text["grasps left out in turn, %"].str.split(" ").str[0].tolist() == ["95", "50"]
    key = "grasp_series_over_components"
    assert verdicts(SERIES, every, key).loc[key, "effect"] == pytest.approx(45)


def test_claims_on_events_turn_with_the_rows(every, measure):
    events = [claim for claim in SERIES if claim.dataset == "touch_events"]
    words = verdicts(events, every)["verdict"]
    assert words["events_discriminant_over_network_objects"] == "supported"
    assert words["events_linear_svm_over_network_containers"] == "supported"
    assert words["events_quarter_enough"] == "contradicted" and words["events_half_the_taxels_objects"] == "supported"
    worse = measure("recorded", event_rows(dict.fromkeys(EVENTS, 0.5)))
    words = verdicts(events, worse, "events_discriminant_over_network_objects")["verdict"]
    assert words.tolist() == ["contradicted"]

"""Real touches in the report: table 4.4's twin, grasps, simulation beside real touches, the claims."""

import re

import numpy as np
import pandas as pd
import pytest

from stages.report import recorded as topic
from stages.report.recorded.claims import TOUCHES as CLAIMS
from stages.report.recorded.grasps import CLASSES, TASKS
from stages.report.recorded.networks import PANELS
from stages.report.results import NotRun
from stages.report.topics import build_one
from stages.report.verdict import judge

CLASSIFIERS = {"knn": 0.7, "svm": 0.4, "decision_tree": 0.5, "naive_bayes": 0.6, "deep_learning": 0.65}
GAIN = {"all": 0.0, "selected": 0.05, "selected_control": 0.0, "selected_training": -0.05}
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
    for classifier in PANELS:
        for repetition in range(5):
            for touches in (0, 1, 5, 20):
                mean = 0.2 + 0.02 * touches + 0.01 * random.normal()
                common = {"classifier": classifier, "touches": touches, "repetition": repetition, "metric": "accuracy"}
                common |= {"group": "all", "seconds": 0.1}
                if touches:
                    rows.append(common | {"training": "real", "value": mean})
                for kind in ("array", "resting_skin"):
                    for aligned in (False, True):
                        said = {"training": "both" if touches else "simulated", "simulation": kind, "aligned": aligned}
                        rows.append(common | said | {"value": mean + help + 0.001 * random.normal()})
                        if not touches:
                            rows.append(common | said | {"group": "ball", "value": 0.5 + 0.1 * aligned})
    return pd.DataFrame(rows)


PLACES = {  # name of the rows -> their stage and set
    "real": ("recorded", "pressure_images"), "grasps": ("recorded", "biotac_grasps"),
    "simulated_to_real": ("simulated_to_real", "pressure_images"),
}  # fmt: skip


@pytest.fixture
def measured(bare, small):
    def write(**frames):
        for name, rows in frames.items():
            stage, dataset = PLACES[name]
            small.write(bare, stage, rows, dataset)
        return small.results(bare)

    return write


def table(name, results):
    return build_one(topic, "tables", name, results)


def judged(results):
    return judge(CLAIMS, results).set_index("key")


def test_table_4_4_stands_beside_the_thesis(measured):
    made = table("table_4_4", measured(real=recorded()))
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


def test_table_4_4_has_the_readings_of_the_scale_behind(measured):
    rows = recorded()
    other = rows[(rows["method"] == "all") & (rows["split"] == "random")].assign(scaling="min_max")
    other["value"] += np.where(other["classifier"] == "svm", 0.3, 0.0)
    shown = table("table_4_4", measured(real=pd.concat([rows, other]))).shown.set_index(["set", "selection"])
    cells = shown.loc[("all 22 classes", "no selection: all data from 0 to 1")]
    assert cells["SVM, %"].startswith("70 [") and cells["mean of all, %"].startswith("63 [")
    assert shown.loc[("all 22 classes", "no selection"), "SVM, %"].startswith("40 [")


@pytest.mark.slow
def test_a_set_without_a_selection_is_not_run_in_its_cells(measured):
    rows = recorded()
    rows = rows[~((rows["group"] == "six") & (rows["method"] == "selected"))]
    shown = table("table_4_4", measured(real=rows)).shown
    cell = shown[(shown["set"] == "first six classes") & (shown["selection"] == "selection")]
    assert cell["SVM, %"].item().startswith("not run")


def test_grasps_are_told_by_task_with_their_drift(measured):
    made = table("grasps", measured(grasps=grasped()))
    shown = made.shown[made.shown["palm"] == "all"]
    assert shown["task"].tolist() == list(TASKS.values())
    assert made.frame.loc[made.frame["palm"] == "all", "accuracy"].to_numpy() == pytest.approx(0.8, abs=0.02)
    assert shown["values"].tolist() == ["12 components", "electrodes"] * 2
    assert any("palm 45 0.5, palm down 3.0" in note for note in made.notes)


def test_the_note_on_drift_says_no_more_than_the_rows(measured):
    notes = " ".join(table("grasps", measured(grasps=grasped())).notes)
    assert "drawn at random, by palm 45 0.4, palm down 1.2 at most" in notes
    assert "by palm and scale: palm down, each part by its own 1 of 2." in notes


def test_simulation_is_compared_by_the_number_of_real_touches(measured):
    made = table("simulated_to_real", measured(simulated_to_real=transferred()))
    assert made.shown["simulated imprints"].iloc[0] == "none"
    assert made.shown.iloc[0, 1] == "–" and made.shown.iloc[1, 1].startswith("30 [")
    rows = made.frame.set_index(["training", "touches", "classifier"])
    assert rows.loc[("real", 5, "knn"), "accuracy"].item() == pytest.approx(0.3, abs=0.02)
    assert any("aligned, the best" in note and "ball 60" in note for note in made.notes)


@pytest.mark.slow
def test_the_picture_of_simulated_and_real_touches_is_drawn(measured):
    figure = build_one(topic, "figures", "real_touches", measured(simulated_to_real=transferred()))
    assert figure.paths[0].stat().st_size > 10_000


@pytest.mark.parametrize("help, word", [(0.1, "supported"), (-0.1, "contradicted")])
def test_whether_simulation_helps_is_judged(measured, help, word):
    found = judged(measured(simulated_to_real=transferred(help)))
    assert found.loc["simulation_helps_5", "verdict"] == word
    assert found.loc["simulation_helps_5", "effect"] == pytest.approx(100 * help, abs=0.5)


def test_selection_and_the_best_classifier_are_judged_on_real_touches(measured):
    found = judged(measured(real=recorded()))
    assert found.loc["real_selection_six_alike", "effect"] == pytest.approx(5, abs=0.3)
    assert found.loc["real_selection_training", "verdict"] == "contradicted"
    assert found.loc["real_knn_best_all", "effect"] == pytest.approx(5, abs=0.5)
    assert found.loc["real_blocked", "verdict"] == "supported"


@pytest.mark.parametrize("name", ["table_4_4", "grasps", "simulated_to_real", "real_touches"])
def test_without_recorded_touches_nothing_is_run_and_the_remedy_is_told(name, measured):
    with pytest.raises(NotRun, match="no measurements of"):
        (topic.TABLES | topic.FIGURES)[name](measured())


def test_claims_without_recorded_touches_are_open(measured):
    found = judged(measured())
    assert (found["verdict"] == "open").all() and found["tested_on"].str.startswith("not run: no measurements of").all()

"""Rows that are no evidence: a method that found, kept or learned nothing is left out before a verdict."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from stages.report.claims import Claim
from stages.report.effects import GUESSING, ONE_CLASS, SAME, UNTRAINED, causes, differences, invalid
from stages.report.pareto import NO_POINT, NO_RING
from stages.report.verdict import judge

OVER = Claim(
    key="one", section="T9", sentence="Sentence.", stage="lod", dataset="test", over=("item",), within=("target",),
    first={"method": "x"}, second={"method": "qem"}, where={"metric": "error"}, scale=1.0, unit="units",
)  # fmt: skip
COUNT = 12  # objects, each at two targets: a fifth of 24 pairs is 4.8


def simplified(root, small, without_points=0, without_rings=0, value=2.0):
    """Results of method x beside plain: the first pairs of x found no point, the next ones kept less than a ring."""
    x = pd.DataFrame({"item": np.repeat([f"o{k:02}" for k in range(COUNT)], 2), "target": ["1500", "3000"] * COUNT})
    x = x.assign(method="x", points=9, rings=3.0, value=value + np.linspace(0, 0.1, 2 * COUNT))
    x.loc[x.index[:without_points], ["points", "value"]] = 0, 100.0
    x.loc[x.index[without_points : without_points + without_rings], ["rings", "value"]] = 0.9, 100.0
    plain = x.assign(method="qem", points=0, rings=np.nan, value=1.0)
    small.write(root, "lod", pd.concat([x, plain]).assign(dataset="test", metric="error"))
    return small.results(root)


def test_plain_simplification_and_whole_rings_are_valid(root, small):
    results = simplified(root, small)
    assert set(causes(results, "lod", "test", results.rows("lod"))) == {""}
    assert invalid(results, OVER)[1] == 2 * COUNT and judge([OVER], results)["validity"].iloc[0] == ""


def test_a_few_invalid_pairs_are_left_out_and_counted(root, small):
    row = judge([OVER], simplified(root, small, without_points=1, without_rings=3)).iloc[0]
    assert row["verdict"] == "supported" and row["effect"] == pytest.approx(1.05, abs=0.05)
    assert row["units"] == COUNT - 2  # of two objects both targets are invalid
    assert row["validity"] == f"test: 4 of 24 pairs invalid: {NO_RING} (3), {NO_POINT} (1)"


def test_an_object_keeps_its_valid_target(root, small):
    results = simplified(root, small, without_points=1)
    assert len(differences(results, OVER)) == COUNT
    assert differences(results, OVER)["o00"] == pytest.approx(1.0, abs=0.05)
    assert differences(results, replace(OVER, checked=False))["o00"] > 40


def test_more_than_a_fifth_cannot_be_tested_and_says_why(root, small):
    row = judge([OVER], simplified(root, small, without_points=5)).iloc[0]
    assert row["verdict"] == "not testable" and row["holds"] == "" and row["effect"] > 10  # of all pairs
    assert row["validity"] == f"test: 5 of 24 pairs invalid: {NO_POINT} (5)"


def test_a_claim_about_all_rows_leaves_none_out(root, small):
    row = judge([replace(OVER, checked=False)], simplified(root, small, without_points=5)).iloc[0]
    assert row["verdict"] != "not testable" and row["validity"] == "" and row["pairs"] == COUNT


def test_a_mean_over_methods_needs_each_of_them(root, small):
    results = simplified(root, small, without_points=2)
    rows = results.rows("lod")
    other = rows[rows["method"] == "x"].assign(method="y", points=9, value=2.0)
    small.write(root, "lod", pd.concat([rows, other]))
    found = differences(small.results(root), replace(OVER, first={"method": ("x", "y")}))
    assert len(found) == COUNT - 1 and found.max() < 2


def test_two_sides_with_the_same_mesh_are_no_evidence(root, small):
    rows = simplified(root, small).rows("lod")
    other = rows[rows["method"] == "x"].assign(method="y")
    other.loc[other["item"] != "o00", "value"] = 1.5
    zero = rows.assign(value=rows["value"].where(rows["item"] != "o01", 0.0))  # two exact meshes
    other.loc[other["item"] == "o01", "value"] = 0.0
    small.write(root, "lod", pd.concat([zero.assign(value=zero["value"] + 9 * (zero["method"] == "qem")), other]))
    one = replace(OVER, second={"method": "y"})
    row = judge([one], small.results(root)).iloc[0]
    assert row["validity"] == f"test: 2 of 24 pairs invalid: {SAME} (2)" and row["units"] == COUNT - 1
    assert differences(small.results(root), one)["o01"] == 0
    same_as_plain = replace(OVER, first={"method": "y"}, second={"method": "qem"})
    small.write(root, "lod", pd.concat([rows, other.assign(value=1.0)]))
    assert judge([same_as_plain], small.results(root))["verdict"].iloc[0] == "not testable"


def test_a_statistic_of_its_own_leaves_the_same_pairs_out(root, small):
    results = simplified(root, small, without_points=2)
    falls = replace(OVER, statistic="falls_with_faces", second=None)
    rows = results.rows("lod")
    small.write(root, "lod", rows.assign(faces=rows["target"].astype(int)))
    assert len(differences(small.results(root), falls)) == COUNT - 1
    assert invalid(small.results(root), falls)[0].index.tolist() == [("o00", "1500"), ("o00", "3000")]


def test_a_classifier_with_one_answer_for_nearly_all_is_invalid(root, small):
    rows = pd.DataFrame({"dataset": "test", "method": "m", "classifier": ["svm", "knn"] * 2, "repetition": 0})
    rows = rows.assign(metric=["accuracy"] * 2 + ["commonest_share"] * 2, value=[0.3, 0.8, 0.4, 0.3])
    for group, words in (("six", [ONE_CLASS, ""]), ("four", ["", ""]), ("some", ["", ""])):
        small.write(root, "classification", rows.assign(group=group))
        small.write(root, "recorded", rows.assign(group=f"{group}_drawn"))
        results = small.results(root)
        for stage in ("classification", "recorded"):
            accuracy = results.rows(stage, metric="accuracy")
            assert causes(results, stage, "test", accuracy).tolist() == words


def test_a_kind_of_trial_that_is_less_accurate_than_guessing_is_invalid(root, small):
    rows = pd.DataFrame({"dataset": "test", "group": "six", "metric": "accuracy", "repetition": [0, 1] * 2})
    rows = rows.assign(classifier=["svm", "svm", "knn", "knn"], value=[0.18, 0.12, 0.1, 0.9])
    small.write(root, "classification", rows)
    results = small.results(root)
    assert (
        causes(results, "classification", "test", results.rows("classification")).tolist() == [GUESSING] * 2 + [""] * 2
    )


@pytest.mark.parametrize("stage", ["transfer", "recorded_networks"])
def test_a_tuned_network_is_valid_once_it_has_learned_its_training_part_or_stopped_by_itself(root, small, stage):
    rows = pd.DataFrame({"dataset": "test", "metric": "accuracy", "value": 0.6, "repetition": range(4)})
    rows = rows.assign(mode=["finetuned", "finetuned", "frozen", "18:139"], passes=["printed"] * 3 + ["converged"])
    learned = rows.assign(metric="train_accuracy", value=[0.77, 0.97, 0.1, 0.5])
    small.write(root, stage, pd.concat([rows, learned]))
    results = small.results(root)
    accuracy = results.rows(stage, metric="accuracy")
    assert causes(results, stage, "test", accuracy).tolist() == [UNTRAINED, "", "", ""]
    small.write(root, stage, rows.drop(columns="passes"))  # nobody knows how far these were trained
    results = small.results(root)
    assert causes(results, stage, "test", results.rows(stage)).tolist() == [UNTRAINED, UNTRAINED, "", UNTRAINED]

"""Rows that are no evidence: units without kept points, and what is left out before a verdict.

Also the table of points and rings, which counts such units.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from stages.report.claims import POINTS, Claim, Pick, Reading
from stages.report.effects import Effect, differences, effect_of
from stages.report.pairs import invalid
from stages.report.validity import (
    AS_PLAIN,
    BACKGROUND,
    DIVERGED,
    FROM_RANDOM,
    GUESSING,
    NO_POINT,
    NO_RING,
    NOISE_NEARER,
    NOTHING_OUT,
    ONE_CLASS,
    SAME,
    UNIT,
    UNKNOWN,
    UNMEASURED,
    UNTRAINED,
    causes,
    invalid_units,
)
from stages.report.verdict import judge

ERRORS = ("metro_mean", "ssim_error")


def unit(item, method, target="1500", points=10, kept=10, rings=3.0, errors=(0.2, 0.3), shrunk=None):
    """The rows of one mesh: the number of faces and two errors."""
    common = {"item": item, "method": method, "target": target, "points": points, "kept": kept, "rings": rings}
    common |= {"shrunk": points > 0 and rings < 3 if shrunk is None else shrunk, "infeasible": False, "note": ""}
    values = {"faces": int(target)} | dict(zip(ERRORS, errors, strict=True))
    return [common | {"metric": metric, "value": value} for metric, value in values.items()]


PLAIN: dict[str, Any] = {"points": 0, "kept": 0, "rings": np.nan, "errors": (0.1, 0.15)}
QEM = unit("a", "qem", **PLAIN) + unit("a", "qslim", **PLAIN)


def cause(method, **fields):
    """The cause for which one unit beside plain QEM is invalid, None for a valid one."""
    reasons = invalid_units(pd.DataFrame(QEM + unit("a", method, **fields)))
    assert set(reasons.index) <= {("a", method, fields.get("target", "1500"))}
    return reasons.get(("a", method, "1500"))


@pytest.mark.parametrize(("method", "fields", "word"), [
    ("itti", {}, None),
    ("SymRad", {"points": 0, "kept": 0, "rings": np.nan}, NO_POINT), ("SymRad", PLAIN, NO_POINT),
    ("glance-soft", {"points": 0, "kept": 0, "rings": np.nan}, None),  # weights keep nothing by design
    ("itti", {"errors": PLAIN["errors"]}, AS_PLAIN), ("itti", {"errors": (PLAIN["errors"][0], 0.2)}, None),
    ("glance-soft", PLAIN, AS_PLAIN),
    ("harris", {"rings": 0.9}, NO_RING), ("harris", {"rings": 1.0}, None),
    ("harris", {"kept": 0, "rings": np.nan}, NO_RING),
])  # fmt: skip
def test_a_unit_without_points_or_rings_or_with_the_mesh_of_plain_is_invalid(method, fields, word):
    assert cause(method, **fields) == word


def test_a_unit_is_compared_with_plain_of_its_object_and_needs_a_mesh():
    other = unit("b", "qem", **PLAIN | {"errors": (0.5, 0.6)}) + unit("b", "itti", errors=(0.1, 0.15))
    missing = unit("a", "SymRad", points=0, rings=np.nan, errors=(np.nan, np.nan))
    rows = pd.DataFrame(QEM + other + missing)
    rows.loc[rows["method"] == "SymRad", "value"] = np.nan
    assert not len(invalid_units(rows))


@pytest.fixture
def made():
    """Four objects: SymRad finds a point on one, harris keeps 0 to 1.5 rings, itti three on all but one."""
    rows = []
    for k, item in enumerate("abcd"):
        for target in ("3000", "1500"):
            rows += unit(item, "qem", target, **PLAIN)
            radial = {"points": 4, "kept": 4} if k == 0 else PLAIN
            rows += unit(item, "SymRad", target, **radial)
            rows += unit(item, "harris", target, points=100, kept=50, rings=k / 2 if target == "1500" else 2.5)
            rows += unit(item, "itti", target, points=20 + k, rings=2.0 if k == 3 else 3.0)
            rows += unit(item, "itti-area", target, points=20, rings=7.0)
    return pd.DataFrame(rows)


def test_the_numbers_of_points_and_rings(made):
    causes = invalid_units(made)
    assert causes.index.names == UNIT and causes.index.is_unique
    assert causes.value_counts().to_dict() == {NO_POINT: 6, NO_RING: 2}


OVER = Claim(
    key="one", section="T9", sentence="Sentence.", stage="lod", sets=("test",), over=("item",), within=("target",),
    first={"method": "x"}, second={"method": "qem"}, where={"metric": "error"}, scale=1.0, unit="units",
)  # fmt: skip
COUNT = 12  # objects, each at two targets: a fifth of 24 pairs is 4.8


def simplified(without_points=0, without_rings=0):
    """Rows of method x beside plain: the first pairs of x found no point, the next ones kept less than a ring."""
    x = pd.DataFrame({"item": np.repeat([f"o{k:02}" for k in range(COUNT)], 2), "target": ["1500", "3000"] * COUNT})
    x = x.assign(method="x", points=9, rings=3.0, value=2.0 + np.linspace(0, 0.1, 2 * COUNT))
    x.loc[x.index[:without_points], ["points", "value"]] = 0, 100.0
    x.loc[x.index[without_points : without_points + without_rings], ["rings", "value"]] = 0.9, 100.0
    plain = x.assign(method="qem", points=0, rings=np.nan, value=1.0)
    return pd.concat([x, plain]).assign(dataset="test", metric="error")


def test_a_few_invalid_pairs_are_left_out_and_counted(measured):
    row = judge([OVER], measured("lod", simplified(without_points=1, without_rings=3))).iloc[0]
    assert row["verdict"] == "supported" and row["effect"] == pytest.approx(1.05, abs=0.05)
    assert row["units"] == COUNT - 2  # of two objects both targets are invalid
    assert row["validity"] == f"test: 4 of 24 pairs invalid: {NO_RING} (3), {NO_POINT} (1)"


def test_an_object_keeps_its_valid_target(measured):
    results = measured("lod", simplified(without_points=1))
    assert len(differences(results, OVER)) == COUNT
    assert differences(results, OVER)["o00"] == pytest.approx(1.0, abs=0.05)
    assert differences(results, replace(OVER, checked=False))["o00"] > 40
    rows = results.rows("lod", "test", method="x").assign(method="y", points=9, value=2.0)
    rows.loc[rows["item"] == "o01", "points"] = 0
    claim = replace(OVER, first={"method": ("x", "y")})  # whose mean needs each of them
    assert "o01" not in differences(measured("lod", pd.concat([results.rows("lod", "test"), rows])), claim)


def test_more_than_a_fifth_cannot_be_tested_unless_the_claim_is_about_all_rows(measured):
    results = measured("lod", simplified(without_points=5))
    row, unchecked = (judge([claim], results).iloc[0] for claim in (OVER, replace(OVER, checked=False)))
    assert row["verdict"] == "not testable" and row["holds"] == ""
    assert row["effect"] == pytest.approx(1.05, abs=0.05)  # of the valid pairs
    assert row["validity"] == f"test: 5 of 24 pairs invalid: {NO_POINT} (5)"
    assert unchecked["verdict"] != "not testable" and unchecked["validity"] == "" and unchecked["pairs"] == COUNT


def test_where_no_pair_is_valid_the_numbers_are_of_all_pairs(measured):
    row = judge([OVER], measured("lod", simplified(without_points=2 * COUNT))).iloc[0]
    assert row["verdict"] == "not testable" and row["effect"] == 99 and row["pairs"] == COUNT


@pytest.mark.parametrize(("refused", "rival"), [(2, 2.5), (5, 1.5)])
def test_neither_a_refused_row_nor_a_method_of_many_is_the_best(measured, refused, rival):
    rows = simplified(without_points=refused)  # errors of 100; the valid ones of x are about 2
    other = rows[rows["method"] == "x"].assign(method="y", points=9, value=rival)
    results = measured("lod", pd.concat([rows, other]))
    claim = replace(OVER, first={"method": Pick(("x", "y"))})
    assert differences(results, claim).mean() == pytest.approx(rival - 1)
    assert differences(results, replace(claim, checked=False)).mean() > 5


def test_the_valid_pairs_of_a_refused_claim_count_as_a_reading(measured):
    rows = simplified(without_points=5)
    other = rows[rows["method"] == "x"].assign(method="y", points=9, value=lambda frame: 0.6 + 0.01 * frame["value"])
    results = measured("lod", pd.concat([rows, other.assign(value=other["value"].clip(upper=0.7))]))
    claim = replace(OVER, readings=(Reading("y", {"first": {"method": "y"}}),))
    row = judge([claim], results).iloc[0]
    assert row["effect"] < 0 and row["verdict"] == "depends on the reading"
    assert "as written: not testable" in row["readings"]


def test_valid_pairs_without_a_difference_that_matters_are_a_decided_reading(measured):
    rows = simplified(without_points=5)
    is_valid = (rows["method"] == "x") & (rows["points"] > 0)
    rows.loc[is_valid, "value"] = np.linspace(0.9, 1.1, is_valid.sum())
    results = measured("lod", pd.concat([rows, simplified().query("method == 'x'").assign(method="y")]))
    other = (Reading("y", {"first": {"method": "y"}}),)
    for unit_name, word in (("NSS", "supported"), (POINTS, "depends on the reading")):  # 0.1 is negligible in points
        row = judge([replace(OVER, unit=unit_name, readings=other)], results).iloc[0]
        assert row["verdict"] == word


def test_pairs_and_sets_are_those_that_the_effect_is_of(measured):
    valid, poor = simplified(), simplified(without_points=5).assign(dataset="other")
    results = measured("lod", pd.concat([valid, poor]))
    row = judge([replace(OVER, sets=("test", "other"))], results).iloc[0]
    assert row["pairs"] == row["units"] == COUNT and row["tested_on"].startswith("test, ")


def test_the_effect_is_of_all_testable_sets_or_else_of_all_sets():
    means = {"first": 1.0, "second": 3.0, "third": 8.0}
    sets = [
        Effect(name, pd.Series(mean + np.arange(-2.0, 3.0)), 0.0, ("no point",) * 5, 5) for name, mean in means.items()
    ]
    assert not any(effect.testable for effect in sets)
    assert effect_of(sets).interval[0] == pytest.approx(4.0, abs=0.1)
    sets[1] = replace(sets[1], refused=())
    assert effect_of(sets) is sets[1]


def test_sets_that_disagree_are_mixed(measured):
    leads = simplified().assign(dataset="leads")
    lags = leads.assign(dataset="lags", value=leads["value"] - 1.3 * (leads["method"] == "x"))
    results = measured("lod", pd.concat([leads, lags]))
    assert judge([replace(OVER, sets=("leads", "lags"))], results)["verdict"].tolist() == ["mixed"]


def test_two_sides_with_the_same_mesh_are_no_evidence(measured):
    rows = simplified()
    other = rows[rows["method"] == "x"].assign(method="y")
    other.loc[other["item"] != "o00", "value"] = 1.5
    zero = rows.assign(value=rows["value"].where(rows["item"] != "o01", 0.0))  # two exact meshes
    other.loc[other["item"] == "o01", "value"] = 0.0
    exact = pd.concat([zero.assign(value=zero["value"] + 9 * (zero["method"] == "qem")), other])
    results, claim = measured("lod", exact), replace(OVER, second={"method": "y"})
    row = judge([claim], results).iloc[0]
    assert row["validity"] == f"test: 2 of 24 pairs invalid: {SAME} (2)" and row["units"] == COUNT - 1
    assert differences(results, claim)["o01"] == 0
    as_result = judge([replace(claim, ties=True)], results).iloc[0]
    assert as_result["validity"] == "" and as_result["units"] == COUNT
    assert differences(results, replace(claim, ties=True))["o00"] == 0
    same_as_plain = replace(OVER, first={"method": "y"}, second={"method": "qem"})
    results = measured("lod", pd.concat([rows, other.assign(value=1.0)]))
    assert judge([same_as_plain], results)["verdict"].iloc[0] == "not testable"


def test_a_statistic_of_its_own_leaves_the_same_pairs_out(measured):
    falls = replace(OVER, statistic="falls_with_faces", second=None)
    rows = simplified(without_points=2)
    results = measured("lod", rows.assign(faces=rows["target"].astype(int)))
    assert len(differences(results, falls)) == COUNT - 1
    assert invalid(results, falls)[0].index.tolist() == [("o00", "1500"), ("o00", "3000")]


def causes_in(results, stage, metric="accuracy"):
    """The causes for which the accuracies of a stage are invalid."""
    return causes(results, stage, "test", results.rows(stage, "test", metric=metric)).tolist()


@pytest.mark.parametrize(("stage", "group"), [("classification", "{}"), ("recorded", "{}_drawn")])
def test_a_classifier_with_one_answer_for_nearly_all_is_invalid(measured, stage, group):
    rows = pd.DataFrame({"dataset": "test", "method": "m", "classifier": ["svm", "knn"] * 2, "repetition": 0})
    rows = rows.assign(metric=["accuracy"] * 2 + ["commonest_share"] * 2, value=[0.3, 0.8, 0.4, 0.3])
    for name, words in (("six", [ONE_CLASS, ""]), ("four", ["", ""]), ("some", ["", ""])):
        assert causes_in(measured(stage, rows.assign(group=group.format(name))), stage) == words


def test_a_classifier_that_is_right_more_often_than_its_commonest_answer_is_valid(measured):
    rows = {
        "group": "six",
        "classifier": "knn",
        "repetition": [0, 0, 1, 1],
        "metric": ["accuracy", "commonest_share"] * 2,
    }
    results = measured("classification", pd.DataFrame(rows | {"dataset": "test", "value": [0.5, 0.36, 0.3, 0.36]}))
    accuracies = results.rows("classification", "test", metric="accuracy")
    assert (causes(results, "classification", "test", accuracies) == "").tolist() == [True, False]


def test_a_kind_of_trial_that_is_less_accurate_than_guessing_is_invalid(measured):
    rows = pd.DataFrame({"dataset": "test", "group": "six", "metric": "accuracy", "repetition": [0, 1] * 2})
    rows = rows.assign(classifier=["svm", "svm", "knn", "knn"], value=[0.18, 0.12, 0.1, 0.9])
    assert causes_in(measured("classification", rows), "classification") == [GUESSING] * 2 + [""] * 2


@pytest.mark.parametrize("stage", ["transfer", "recorded_networks"])
def test_a_tuned_network_is_valid_once_it_has_learned_its_training_part_or_stopped_by_itself(measured, stage):
    rows = pd.DataFrame({"dataset": "test", "metric": "accuracy", "value": 0.6, "repetition": range(4)})
    rows = rows.assign(mode=["finetuned", "finetuned", "frozen", "18:139"], passes=["printed"] * 3 + ["converged"])
    learned = rows.assign(metric="train_accuracy", value=[0.77, 0.97, 0.1, 0.5])
    assert causes_in(measured(stage, pd.concat([rows, learned])), stage) == [UNTRAINED, "", "", ""]
    unknown = rows.drop(columns="passes").assign(value=[0.96, 0.99, 0.6, 0.6])  # nobody knows how far they were trained
    assert causes_in(measured(stage, unknown), stage) == [UNMEASURED, "", "", UNMEASURED]


def test_a_network_whose_loss_never_falls_below_guessing_is_no_evidence(measured):
    rows = pd.DataFrame(
        {"dataset": "test", "metric": "accuracy", "value": 0.6, "repetition": range(4), "mode": "frozen"}
    )
    curves = [(0, 1, 1.4), (0, 2, 1.5), (1, 1, 1.4), (1, 2, 1.3), (2, 1, 1.3), (2, 2, 9.0)]  # four classes: 1.386
    losses = pd.DataFrame(curves, columns=["repetition", "epoch", "value"]).assign(metric="curve_loss", mode="frozen")
    classes = pd.DataFrame({"group": list("abcd"), "metric": "class_accuracy", "value": 0.6, "mode": "frozen"})
    on_objects = rows[:2].assign(metric="object_accuracy", item="one")
    results = measured("transfer", pd.concat([rows, losses, classes, on_objects]).assign(dataset="test"))
    assert causes_in(results, "transfer") == [DIVERGED, "", "", ""]
    assert causes_in(results, "transfer", "object_accuracy") == [DIVERGED, ""]


def test_a_selection_that_left_nothing_out_is_no_evidence(measured):
    common = {"dataset": "test", "group": "six", "split": "random", "classifier": "knn", "metric": "accuracy"}
    rows = pd.DataFrame(common, index=range(8)).assign(repetition=np.repeat([0, 1], 4), value=0.6)
    rows = rows.assign(method=["all", "selected", "selected_control", "unreduced"] * 2)  # the last selects nothing
    rows = rows.assign(train=75, test=[25, 25, 25, 25, 25, 20, 20, 25])
    assert causes_in(measured("recorded", rows), "recorded") == ["", NOTHING_OUT, NOTHING_OUT, *[""] * 5]


def test_an_svm_whose_answers_nobody_counted_is_no_evidence_beside_counted_ones(measured):
    rows = pd.DataFrame({"dataset": "test", "group": "six", "metric": "accuracy", "value": 0.6, "repetition": 0},
                        index=range(4))  # fmt: skip
    rows = rows.assign(classifier=["svm", "svm", "svm", "knn"], scaling=["training"] * 2 + ["min_max", "training"])
    rows["variant"] = ["plain", "mixed", "mixed", "mixed"]
    counted = rows.iloc[:1].assign(metric="commonest_share", value=0.2)
    results = measured("classification", pd.concat([rows, counted]))
    assert causes_in(results, "classification") == ["", UNKNOWN, "", ""]
    assert causes_in(measured("classification", rows), "classification") == [""] * 4


def test_attention_of_vgg_alone_is_refused_but_not_its_accuracy_or_a_mean_with_another_network(measured):
    rows = pd.DataFrame({"dataset": "test", "metric": ["pcc", "accuracy", "pcc"], "value": 0.5})
    rows["method"] = ["vgg16-last_block", "vgg16-last_block", "resnet50-last_block"]
    results = measured("fixation", rows)
    alone, mixed, accuracy = {"metric": "pcc", "method": "vgg16-last_block"}, {"metric": "pcc"}, {"metric": "accuracy"}
    for where, words in ((alone, [FROM_RANDOM]), (mixed, ["", ""]), (accuracy, [""])):
        assert causes(results, "fixation", "test", results.rows("fixation", "test", **where)).tolist() == words


def test_a_map_farther_from_fixations_than_noise_is_refused_by_the_least_distance_alone(measured):
    rows = pd.DataFrame({"dataset": "test", "method": ["control", "near", "far"], "task": ["random", "a", "a"]})
    rows = pd.concat([rows.assign(metric=name, value=[0.2, 0.1, 0.3]) for name in ("distance", "distance_mean")])
    results = measured("fixation", rows)
    assert causes(results, "fixation", "test", results.rows("fixation", "test")).tolist() == [
        "",
        "",
        NOISE_NEARER,
        "",
        "",
        "",
    ]


def test_an_svm_worse_than_calling_all_background_refuses_its_kind_of_pixels_also_where_it_is_a_mean(measured):
    kinds = {("image", "one_per_object"): 0.93, ("image", "one_for_all"): 0.9,
             ("object", "one_per_object"): 0.7, ("object", "one_for_all"): 0.6}  # fmt: skip
    rows = [{"item": f"o{k}" if training == "one_per_object" else None, "area": area, "training": training,
             "validation": "pixels", "metric": "accuracy", "value": value + 0.001 * k,
             "background_alone": 0.91 if area == "image" else 0.5}
            for (area, training), value in kinds.items()
            for k in range(4 if training == "one_per_object" else 1)]  # fmt: skip
    results = measured("weights", pd.DataFrame(rows), "gaze")
    claim = Claim(key="own", section="T3.2.3", sentence="One each.", stage="weights", sets=("gaze",), over=("item",),
                where={"metric": "accuracy", "area": "image"}, first={"training": "one_per_object"},
                second={"training": "one_for_all"}, mean_of="second")  # fmt: skip
    on_object = replace(claim, key="object", where={"metric": "accuracy", "area": "object"})
    table = judge([claim, on_object], results).set_index("key")
    assert table["verdict"].to_dict() == {"own": "not testable", "object": "supported"}
    assert table.loc["own", "validity"] == f"meshes with human gaze: 4 of 4 pairs invalid: {BACKGROUND} (4)"
    assert table.loc["object", "effect"] == pytest.approx(10.15)


def test_a_network_of_contours_is_valid_once_it_knows_its_training_part_or_has_settled(measured):
    rows = pd.DataFrame({"dataset": "test", "metric": "accuracy", "value": 0.6, "repetition": np.repeat(range(3), 4)})
    rows = rows.assign(classifier=["cnn_images", "cnn_normals", "cnn", "knn"] * 3)
    networks = rows[rows["classifier"] != "knn"]
    learned = networks.assign(metric="train_accuracy", value=[1.0, 0.5, 1.0] + [1.0, 0.9, 1.0] + [0.9, 1.0, 0.9])
    settled = networks[networks["classifier"] != "cnn"].assign(metric="settled", value=[0, 0] + [0, 1] + [0, 0])
    reasons = causes_in(measured("sequences", pd.concat([rows, learned, settled])), "sequences")
    assert reasons == ["", UNTRAINED, UNTRAINED, ""] + [""] * 4 + [UNTRAINED, "", UNTRAINED, ""]
    assert causes_in(measured("sequences", rows), "sequences") == ([UNMEASURED] * 3 + [""]) * 3

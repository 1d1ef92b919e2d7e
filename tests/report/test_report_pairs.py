"""Pairs of a claim and its named statistics, on rows whose answer is known; pairs in which a run says nothing."""

import numpy as np
import pandas as pd
import pytest

from stages.engine.measurements import Measurements, Missing
from stages.report.claims import Claim, Pick
from stages.report.pairs import ALL_KEPT, NO_POINT, SAME, difference
from stages.report.statistics import STATISTICS
from stages.report.verdict import judge


def claim(statistic="difference", stage="test", **fields):
    common = {"key": "one", "section": "T9", "sentence": "Sentence.", "sets": ("test",), "where": {}, "first": {}}
    common |= {"over": ("item",), "scale": 1.0, "unit": "units"}
    return Claim(**common | fields, stage=stage, statistic=statistic)


def rows(columns, *values):
    return pd.DataFrame(values, columns=columns.split()).assign(dataset="test", metric="m")


def found(measurements, entry):
    """The differences of a claim."""
    return STATISTICS[entry.statistic](measurements, entry, "test").differences


@pytest.fixture
def values(measured):
    """A function of columns to the rows of the stage `test` that have these."""
    return lambda **columns: measured("test", pd.DataFrame({"dataset": "test", "metric": "error"} | columns))


def test_pairs_match_by_item_not_by_row(values):
    columns = {"item": list("abba"), "method": ["x", "x", "y", "y"], "value": [3, 5, 1, 2]}
    gaps = found(values(**columns), claim(first={"method": "x"}, second={"method": "y"}))
    assert gaps.to_dict() == {"a": 1, "b": 4}


def test_several_values_are_averaged_where_all_were_measured(values):
    columns = {"item": list("aaabbb"), "method": ["one", "two", "base"] * 2, "value": [1, 3, 1, np.nan, 5, 1]}
    gaps = found(values(**columns), claim(first={"method": ("one", "two")}, second={"method": "base"}))
    assert gaps.to_dict() == {"a": 1.0}


def test_best_and_worst_rival_are_picked_by_their_means_and_never_the_other_side(values):
    columns = {"item": list("aaaabbbb"), "method": ["mine", "low", "high", "seen"] * 2}
    results, side = values(**columns, value=[9, 1, 3, 8, 9, 2, 5, 8]), {"method": "mine"}
    assert found(results, claim(first=side, second={"method": Pick(but=("seen",))})).tolist() == [6, 4]
    assert found(results, claim(first=side, second={"method": Pick(lowest=True)})).tolist() == [8, 7]
    assert found(results, claim(first=side, second={"method": Pick(("low",))})).tolist() == [8, 7]
    with pytest.raises(Missing, match="measured no other method than mine"):
        found(results, claim(first=side, second={"method": Pick(("absent",))}))


def test_differences_within_a_unit_are_relative_and_averaged_or_contrasted(values):
    columns = {"item": list("aaaa"), "target": ["1", "1", "2", "2"], "method": ["x", "y"] * 2, "value": [3, 1, 0, 0]}
    sides = {"first": {"method": "x"}, "second": {"method": "y"}}
    gaps = found(values(**columns), claim(**sides, within=("target",), relative=True))
    assert gaps.to_dict() == {"a": 0.5}  # 2 / 2 at the first target, 0 where both are zero
    contrast = claim(**sides, contrast=({"target": "1"}, {"target": "2"}))
    assert found(values(**columns), contrast).tolist() == [2]


def test_the_rival_of_a_contrast_is_one_method_picked_by_what_the_contrast_is_of(values):
    levels = {("mine", "late"): 9, ("mine", "early"): 1, ("low", "late"): 2, ("low", "early"): 1,
              ("high", "late"): 7, ("high", "early"): 7}  # fmt: skip
    columns = {"item": list("ab") * 6, "method": np.repeat([name for name, _ in levels], 2)}
    columns["target"] = np.repeat([time for _, time in levels], 2)
    gains = claim(first={"method": "mine"}, second={"method": Pick(lowest=True)},
                  contrast=({"target": "late"}, {"target": "early"}))  # fmt: skip
    gaps = found(values(**columns, value=np.repeat(list(levels.values()), 2)), gains)
    assert gaps.tolist() == [8, 8]  # over high, which gains nothing; low gains one


def test_one_side_may_count_by_its_mean_or_be_of_another_set_or_stage(measure, values):
    columns = {"item": ["a", "b", None, None], "method": ["own", "own", "all", "all"], "value": [3, 4, 1, 2]}
    sides = {"first": {"method": "own"}, "second": {"method": "all"}, "mean_of": "second"}
    assert found(values(**columns), claim(**sides)).tolist() == [1.5, 2.5]
    table = {"dataset": ["test"] * 2 + ["other"] * 2, "item": list("abab"), "value": [3, 4, 7, 9]}
    elsewhere = claim(first={"dataset": "other"}, second={"dataset": "test"})
    assert found(values(**table), elsewhere).to_dict() == {"a": 4, "b": 5}
    far = measure("far", rows("item value", ("a", 1.0), ("b", 5.0)))
    results = Measurements(measure("test", rows("item value", ("a", 7.0), ("b", 9.0)), None, far).reports)
    assert found(results, claim(first={}, second={"stage": "far"})).to_dict() == {"a": 6, "b": 4}


COUNT = 10  # objects, each at two targets: a fifth of 20 pairs is 4


def simplified(without_points=0, equal=0, rings=3.0):
    """Rows of method x beside plain: the first pairs of x found no point, the next ones have the mesh of plain."""
    x = pd.DataFrame({"item": np.repeat([f"o{k:02}" for k in range(COUNT)], 2), "target": ["1500", "3000"] * COUNT})
    x = x.assign(method="x", points=9, rings=rings, value=2.0 + np.linspace(0, 0.1, 2 * COUNT))
    x.loc[x.index[:without_points], ["points", "value"]] = 0, 100.0
    x.loc[x.index[without_points : without_points + equal], "value"] = 1.0
    plain = x.assign(method="qem", points=0, rings=np.nan, value=1.0)
    return pd.concat([x, plain]).assign(dataset="test", metric="error")


OVER = claim(stage="lod", within=("target",), first={"method": "x"}, second={"method": "qem"},
             where={"metric": "error"})  # fmt: skip


def test_pairs_without_a_point_or_of_one_mesh_are_left_out_and_counted(measured):
    pairs = difference(measured("lod", simplified(without_points=1, equal=2)), OVER, "test")
    assert pairs.silent == {NO_POINT: 1, SAME: 2} and pairs.count == 20
    assert len(pairs.differences) == COUNT - 1 and pairs.differences.max() < 1.2  # the first object lost both pairs
    row = judge([OVER], measured("lod", simplified(without_points=1, equal=3))).iloc[0]
    assert row["verdict"] == "supported"
    assert row["caveat"] == "4 of 20 pairs say nothing: both sides are the same mesh or no point found"
    row = judge([OVER], measured("lod", simplified(without_points=1, equal=4))).iloc[0]
    assert row["verdict"] == "not testable" and row["effect"] == pytest.approx(1.05, abs=0.05)


def test_equal_meshes_may_be_a_result_and_few_rings_are_a_caveat(measured):
    tied = claim(**vars(OVER) | {"ties": True})
    assert difference(measured("lod", simplified(equal=20)), tied, "test").silent == {}
    row = judge([OVER], measured("lod", simplified(rings=0.9))).iloc[0]
    assert row["verdict"] == "supported" and row["caveat"] == "100 % of the meshes keep less than one ring"
    assert judge([OVER], measured("lod", simplified(rings=1.0))).iloc[0]["caveat"] == ""


def test_two_errors_of_zero_are_equal_and_no_silent_pair(measured):
    table = simplified()
    table.loc[table["item"] == "o00", "value"] = 0.0
    pairs = difference(measured("lod", table), claim(**vars(OVER) | {"relative": True}), "test")
    assert pairs.silent == {} and pairs.differences["o00"] == 0


def test_a_selection_that_leaves_nothing_out_says_nothing(measured):
    table = rows("group method repetition train test value", *(
        ("six", method, k, 30, 10 - (method == "selected") * (k % 2), 0.5) for method in ("all", "selected")
        for k in range(4)))  # fmt: skip
    sides = {"first": {"method": "selected"}, "second": {"method": "all"}, "over": ("repetition",)}
    pairs = difference(measured("recorded", table), claim(stage="recorded", **sides), "test")
    assert pairs.silent == {ALL_KEPT: 2} and [*pairs.differences.index] == [1, 3]


@pytest.fixture
def errors(measured):
    """Errors of five methods on two objects at two targets: `far` is 10 % above `base`, and 20 % at few faces."""
    levels = {"base": 1.0, "far": 1.1, "near": 1.01, "low": 0.9, "high": 1.3}
    table = rows("item target method value points", *(
        (item, target, name, level * scale * (1.2 / 1.1 if (name, target) == ("far", "1500") else 1), k + 1)
        for item, scale in (("a", 1.0), ("b", 2.0)) for target in ("1500", "3000")
        for k, (name, level) in enumerate(levels.items())))  # fmt: skip
    return measured("lod", table)


def test_spread_is_between_few_and_many_faces(errors):
    contrast = ({"target": "1500"}, {"target": "3000"})
    gaps = found(errors, claim("spread", "lod", first={"method": ("base", "far")}, contrast=contrast))
    assert gaps.tolist() == pytest.approx([0.1 / 2**0.5, 0.2 / 2**0.5])


def test_ranks_of_points_and_errors_are_correlated_by_object(errors, measured):
    sides = {"first": {"metric": "m"}, "second": {"metric": "m", "column": "points"}}
    assert found(errors, claim("ranks_agree", "lod", **sides)).tolist() == pytest.approx([0.3, 0.3])
    table = errors.rows("lod", "test")
    gone = (table["method"] == "high") & (table["target"] == "1500") & (table["item"] == "b")
    table.loc[table["target"] == "1500", "value"] *= -1  # would turn the ranks
    alone = found(measured("lod", table[~gone]), claim("ranks_agree", "lod", **sides))
    assert alone["b"] == pytest.approx(0.3)  # by the target that all methods reach
    few = claim("ranks_agree", "lod", where={"method": ("base", "far")}, **sides)
    with pytest.raises(Missing, match="fewer than 5 methods"):
        found(errors, few)


def test_ranks_without_a_second_side_follow_the_depth_of_the_layers(measured):
    changes = rows("repetition value", (0, 3.0), (0, 2.0), (0, 1.0), (1, 1.0), (1, 3.0), (1, 2.0))
    later = claim("ranks_agree", over=("repetition",))
    assert found(measured("test", changes), later).tolist() == pytest.approx([-1, 0.5])


def test_a_side_is_lower_by_the_quantile_of_both(measured):
    table = rows("item view method value", *(("a", str(k), name, k + shift) for k in range(4)
                                             for name, shift in (("x", 0), ("y", 2))))  # fmt: skip
    sides = {"first": {"method": "x"}, "second": {"method": "y"}, "within": ("view",)}
    results = measured("test", table)
    assert found(results, claim("median_below", **sides)).tolist() == [0.5]  # 2.5: three of four, one of four
    assert found(results, claim("upper_quartile_below", **sides)).tolist() == [0.5]


def test_weights_are_held_against_the_next_channel_as_pseudo_values(measured):
    weights = {"entropy": (0.5, 0.4, 0.6), "colour": (0.1, 0.1, 0.1), "rest": (0.3, 0.3, 0.3)}
    table = rows("channel item value", *((name, item, value) for name, values in weights.items()
                                         for item, value in zip((None, "a", "b"), values, strict=True)))  # fmt: skip
    results = measured("weights", table)
    largest = claim("left_out", "weights", first={"channel": "entropy"}, second={"channel": Pick()})
    assert found(results, largest).tolist() == pytest.approx([0.6 - 0.3, 0.4 - 0.3])  # 2 * 0.5 - 0.4, 2 * 0.5 - 0.6
    least = claim("left_out", "weights", first={"channel": "colour"}, second={"channel": Pick(lowest=True)})
    assert found(results, least).tolist() == pytest.approx([-0.2, -0.2])


def test_gains_are_shares_of_objects_whose_shape_orders_them(measured):
    gains = rows("item channel value", *((f"o{k}", name, value) for k in range(6)
                                         for name, value in (("symmetry", 1.0 + k), ("rest", 10.0))))  # fmt: skip
    shape = rows("item channel value", *((f"o{k}", None, float(k)) for k in range(6))).assign(metric="extremes")
    results = measured("weights", pd.concat([gains, shape]))
    sides = {"first": {"channel": "symmetry", "metric": "m"}, "second": {"metric": "extremes"}}
    assert found(results, claim("share_rises_with", "weights", **sides)).mean() == pytest.approx(1)
    apart = claim("shares_differ_with", "weights", **sides | {"first": {"metric": "m"}})
    assert found(results, apart).mean() > 0.9
    with pytest.raises(Missing, match="fewer than 5 objects"):
        few = pd.concat([gains, shape])
        found(measured("weights", few[few["item"] < "o3"]), apart)


def test_classes_that_feel_alike_are_confused_by_their_pair(measured):
    pairs = [("bird", "bird", 6), ("bird", "airplane", 4), ("airplane", "airplane", 10), ("bust", "bust", 10),
             ("vase", "vase", 10)]  # fmt: skip
    confused = measured("confused", rows("classifier group predicted value", *(("knn", *pair) for pair in pairs)))
    entry = claim("alike_confused", "confused", over=("classifier",))
    assert found(confused, entry).tolist() == pytest.approx([0.1])  # 4 of 20 and 0 of 20; others are not confused

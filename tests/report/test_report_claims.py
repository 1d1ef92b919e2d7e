"""Claims: pairing, intervals, words, and the one word."""

import pickle
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from stages.engine.statistics import interval
from stages.report.__main__ import write_claims
from stages.report.claims import POINTS, Claim, highest_of, lowest_of, reading, tested_on
from stages.report.claims_page import effect, open_text, over_text
from stages.report.effects import differences
from stages.report.results import SECTION_3_1, NotRun
from stages.report.topics import CLAIMS, build_all
from stages.report.verdict import counted, holding, judge, judged, over_readings, sentences, verdict


def of(results, key):
    return judge([claim for claim in CLAIMS if claim.key == key], results).iloc[0]


def values(root, small, **columns):
    """Results whose stage `test` has rows of these columns."""
    small.write(root, "test", pd.DataFrame({"dataset": "test", "metric": "error"} | columns))
    return small.results(root)


def claim(**fields):
    """A claim on the rows of `values`, one pair per item."""
    return Claim(**{"key": "one", "section": "T9", "sentence": "Sentence.", "stage": "test", "over": ("item",),
                    "scale": 1.0, "unit": "units"} | fields)  # fmt: skip


@pytest.mark.parametrize(
    ("low", "high", "word"),
    [(0.1, 0.3, "supported"), (-0.3, -0.1, "contradicted"), (-0.1, 0.3, "open"), (0, 1, "open"), (-1, 0, "open")],
)
def test_word_follows_from_the_interval_alone(low, high, word):
    assert verdict(low, high) == word


@pytest.mark.parametrize(
    ("low", "high", "unit", "word"),
    [
        (-2.9, 2.9, "points of accuracy", "no difference"),
        (-3.1, 2.9, "points of accuracy", "open"),
        (-2.9, 3.1, "points of accuracy", "open"),
        (0.1, 2.9, "points of accuracy", "supported"),
        (-0.04, 0.04, "NSS", "no difference"),
        (-0.04, 0.04, "PCC", "open"),
        (-0.04, 0.04, "touches", "open"),  # no margin was stated
    ],
)
def test_an_interval_about_zero_within_what_matters_shows_no_difference(low, high, unit, word):
    assert verdict(low, high, unit) == word


def test_what_is_decided_holds_or_falls_with_the_number_of_claims_of_its_chapter():
    few = pd.DataFrame({"section": ["T3.1", "T4.2"], "p": [0.001, 0.04], "verdict": ["supported", "contradicted"]})
    many = pd.DataFrame({"section": ["T4.2"] * 20, "p": np.linspace(0.3, 0.9, 20), "verdict": ["open"] * 20})
    assert holding(few).tolist() == ["yes", "yes"]
    assert holding(pd.concat([few, many], ignore_index=True)).tolist() == ["yes", "no", *[""] * 20]
    unknown = few.assign(p=np.nan, verdict="open")
    assert holding(unknown).tolist() == ["", ""]


def test_no_interval_is_open():
    assert verdict(np.nan, np.nan) == "open"


def test_a_side_may_be_of_another_set(root, small):
    for dataset, error in (("test", 1.0), ("other", 3.0)):
        small.write(
            root, "test", pd.DataFrame({"dataset": dataset, "metric": "error", "item": ["a", "b"], "value": error})
        )
    found = differences(small.results(root), claim(first={"dataset": "other"}, second={"metric": "error"}))
    assert found.to_dict() == {"a": 2, "b": 2}


def test_clear_effect_is_supported(results):
    row = of(results, "glance_over_blind_ours")
    assert row["verdict"] == "supported"
    assert row["effect"] == pytest.approx(30, abs=2)
    assert row["pairs"] == 6


def test_reversed_effect_is_contradicted(root, small):
    small.write(root, "classification", small.classification(thesis=0.4, rivals=0.7))
    assert of(small.results(root), "glance_over_blind_ours")["verdict"] == "contradicted"


def test_no_effect_shows_no_difference(results):
    assert of(results, "glance_over_ssim_ours")["verdict"] == "no difference"


def test_unmeasured_claim_is_open_and_names_the_stage(results):
    row = of(results, "tuned_over_frozen_objects")
    assert row["verdict"] == "open"
    assert "dvc repro transfer" in row["tested_on"]


def test_errors_are_compared_in_pairs_and_relative_to_their_size(results):
    row = of(results, "glance_keep_metro")
    assert row["effect"] == pytest.approx(100 * (1 - 2) / 1.5)
    assert row["pairs"] == 2


def test_more_faces_claim_takes_fewest_minus_most(root, small):
    frame = small.results(root).rows("lod").copy()
    frame.loc[frame["target"] == "25%", "faces"] = 50
    rows = frame[(frame["item"] == "ball") & (frame["method"] == "glance")]
    small.write(root, "lod", rows.assign(method="itti"), SECTION_3_1)
    assert of(small.results(root), "more_faces")["effect"] == pytest.approx(100 * (0.06 - 0.02))


def test_beyond_chance_takes_guessing_off(root, small):
    frame = small.classification()
    frame = frame.assign(value=frame["group"].map({"six": 1 / 6, "four": 1 / 4}))
    small.write(root, "classification", frame)
    results = small.results(root)
    assert of(results, "four_easier_ours")["effect"] == pytest.approx(100 * (1 / 4 - 1 / 6), rel=1e-3)
    assert of(results, "four_easier_beyond_chance_ours")["effect"] == pytest.approx(0, abs=1e-3)


def test_pairs_match_by_repetition_not_by_row(root, results, small):
    one = next(claim for claim in CLAIMS if claim.key == "glance_over_ssim_ours")
    before = differences(results, one)
    small.write(root, "classification", results.rows("classification").iloc[::-1])
    after = differences(small.results(root), one)
    assert np.allclose(before.sort_index(), after.sort_index())


def test_side_that_was_not_measured_is_not_run(results):
    one = next(claim for claim in CLAIMS if claim.key == "glance_over_ssim_ours")
    with pytest.raises(NotRun, match="heat_kernel"):
        differences(results, replace(one, second={"method": "heat_kernel"}))


def test_second_side_may_be_a_number(root, small):
    results = values(root, small, item=list("ab"), value=[0.5, 0.7])
    assert differences(results, claim(second=0.4)).tolist() == pytest.approx([0.1, 0.3])


def test_several_values_are_averaged_where_all_were_measured(root, small):
    columns = {"item": list("aaabbb"), "method": ["one", "two", "base"] * 2, "value": [1, 3, 1, np.nan, 5, 1]}
    found = differences(
        values(root, small, **columns), claim(first={"method": ("one", "two")}, second={"method": "base"})
    )
    assert found.to_dict() == {"a": 1.0}


def test_best_and_worst_rival_are_picked_by_their_means_and_never_the_other_side(root, small):
    columns = {"item": list("aaaabbbb"), "method": ["mine", "low", "high", "seen"] * 2}
    results = values(root, small, **columns, value=[9, 1, 3, 8, 9, 2, 5, 8])
    mine = {"method": "mine"}
    but = ("se*",)
    assert differences(results, claim(first=mine, second={"method": highest_of(but=but)})).tolist() == [6, 4]
    assert differences(results, claim(first=mine, second={"method": lowest_of()})).tolist() == [8, 7]
    assert differences(results, claim(first=mine, second={"method": highest_of("low")})).tolist() == [8, 7]
    with pytest.raises(NotRun, match="no other method than mine"):
        differences(results, claim(first=mine, second={"method": highest_of("absent")}))


def test_relative_differences_are_matched_within_a_unit_and_then_averaged(root, small):
    columns = {"item": list("aaaa"), "target": ["1", "1", "2", "2"], "method": ["x", "y"] * 2, "value": [3, 1, 0, 0]}
    sides = {"first": {"method": "x"}, "second": {"method": "y"}}
    found = differences(values(root, small, **columns), claim(**sides, within=("target",), relative=True))
    assert found.to_dict() == {"a": 0.5}  # 2 / 2 at the first target, 0 where both are zero


def test_contrast_is_a_difference_of_differences(root, small):
    columns = {"item": list("aaaa"), "target": ["1", "1", "2", "2"], "method": ["x", "y"] * 2, "value": [3, 1, 2, 1]}
    sides = {"first": {"method": "x"}, "second": {"method": "y"}}
    found = differences(values(root, small, **columns), claim(**sides, contrast=({"target": "1"}, {"target": "2"})))
    assert found.tolist() == [1.0]


def test_one_side_may_count_by_its_mean(root, small):
    columns = {"item": ["a", "b", None, None], "method": ["own", "own", "all", "all"], "value": [3, 4, 1, 2]}
    sides = {"first": {"method": "own"}, "second": {"method": "all"}, "mean_of": "second"}
    small.write(root, "test", pd.DataFrame({"dataset": "test", "fold": [0, 1, 2, 3]} | columns))
    found = differences(small.results(root), claim(**sides, over=("fold",)))
    assert found.tolist() == [1.5, 2.5]


def test_pattern_and_empty_cell_choose_rows(root, small):
    columns = {"item": list("aabb"), "method": ["net-frozen", "net-tuned"] * 2, "sense": [None, None, "x", "x"]}
    results = values(root, small, **columns, value=[1, 2, 3, 4])
    assert differences(results, claim(where={"method": "*-frozen"}, second=0)).to_dict() == {"a": 1, "b": 3}
    assert differences(results, claim(where={"sense": None}, second=0)).to_dict() == {"a": 1.5}


def test_scale_comes_before_margin(root, small):
    results = values(root, small, item=list("ab"), value=[0.01, 0.02])
    assert differences(results, claim(second=0, scale=100, margin=1)).tolist() == pytest.approx([2, 3])


def test_every_claim_has_its_own_key_and_answers_without_measurements(bare, small):
    table = judge(CLAIMS, small.results(bare))
    assert table["key"].is_unique
    assert set(table["verdict"]) == {"open"}


@pytest.mark.parametrize("one", CLAIMS, ids=lambda one: one.key)
def test_the_words_on_what_a_claim_is_tested_on_have_no_gap(bare, small, one):
    said = tested_on(one, small.results(bare), [name for name in one.sets if name] or ["household"])
    assert not re.search(r", ?,|  |,$|minus$", said), said


def test_equal_differences_are_open_and_say_why(root, small):
    results = values(root, small, item=list("abc"), value=[6.67, 6.67, 6.67])
    table = judge([claim(second=0.0)], results)
    assert table["verdict"].tolist() == ["open"]
    assert table["tested_on"][0].endswith("; no interval: all 3 differences are equal")
    assert effect(table.iloc[0]) == "+6.67 units"


def test_words_are_written_from_the_fields(root, results, small):
    said = "test, kNN, six objects, test part drawn at random, all imprints, our glance minus blind touch, "
    said += "five draws"
    assert of(results, "glance_over_blind_ours")["tested_on"] == said
    small.write_set(root, "six", 4)
    assert of(results, "glance_over_blind_ours")["tested_on"] == said.replace("six objects", "4 objects (group six)")
    rivals = of(results, "knn_best_ours")["tested_on"]
    assert rivals.endswith("kNN minus the highest of the others")


def test_a_change_of_a_field_changes_the_words(results):
    one = next(claim for claim in CLAIMS if claim.key == "glance_over_blind_ours")
    other = replace(one, where=one.where | {"classifier": "deep_learning"}, note="so")
    words = [judge([claim], results)["tested_on"][0] for claim in (one, other)]
    assert words[1] == words[0].replace("kNN", "deep learning") + ", so"


def test_chance_follows_the_objects_that_the_group_held(root, small):
    frame = small.classification()
    small.write(root, "classification", frame.assign(value=frame["group"].map({"six": 1 / 3, "four": 1 / 4})))
    small.write_set(root, "six", 3)
    row = of(small.results(root), "four_easier_beyond_chance_ours")
    assert row["effect"] == pytest.approx(0, abs=1e-3)


def test_group_that_was_left_out_hands_on_its_note(root, small):
    small.write(root, "classification", small.left_out(small.classification(), "six: no duck", group="six"))
    results = small.results(root)
    for key in ("glance_over_blind_ours", "knn_best_ours", "four_easier_ours"):
        assert of(results, key)["tested_on"] == "not run: six: no duck"


def test_sampling_or_classifier_that_was_left_out_hands_on_its_note(root, small):
    frame = small.left_out(small.classification(), "too few touches", group="six", method="thesis_ssim")
    failed = {"group": "six", "method": "random", "classifier": "knn", "metric": "accuracy"}
    small.write(root, "classification", small.left_out(frame, "knn failed: why", **failed))
    results = small.results(root)
    assert of(results, "glance_over_ssim_ours")["tested_on"] == "not run: too few touches"
    assert of(results, "glance_over_blind_ours")["tested_on"] == "not run: knn failed: why"


def test_absent_group_is_called_a_group(root, small):
    frame = small.classification()
    small.write(root, "classification", frame[frame["group"] == "four"])
    assert of(small.results(root), "knn_best_ours")["tested_on"].startswith("not run: group six is not among")


@pytest.mark.slow
def test_transfer_that_was_left_out_hands_on_its_note(root, small):
    row = {"dataset": "test", "method": None, "metric": "accuracy", "value": None, "seconds": None, "note": "no cup"}
    small.write(root, "transfer", pd.DataFrame([row]))
    results = small.results(root)
    assert of(results, "tuned_over_frozen_objects")["tested_on"] == "not run: no cup"
    assert of(results, "frozen_over_chance_objects")["tested_on"] == "not run: no cup"
    assert build_all("tables", results).not_run["table_5_4"] == "no cup"
    assert build_all("tradeoff", results).not_run["networks"] == "no cup"


def frame_of(words, **columns):
    """A frame of `judge` with these verdicts, each of a primary claim."""
    found = {"verdict": words, "section": "T3.1", "claim": "Sentence.", "pairs": 5, "of": ""}
    return pd.DataFrame(found | {"holds": ""} | columns)


def test_verdicts_are_counted_with_those_that_hold_among_so_many():
    words = ["supported"] * 30 + ["contradicted"] * 10 + ["no difference"] * 5 + ["mixed"] * 2 + ["open"] * 45
    said = counted(frame_of(words, holds=["yes"] * 33 + ["no"] * 7 + [""] * 52))
    words = "30 supported, 10 contradicted, 5 no difference, 2 mixed, 45 open"
    assert said.startswith(f"Sentences of the thesis (92): {words}. Sentences of this project (0): none.")
    assert f"that test a sentence elsewhere (92): {words}." in said
    assert "Of the 40 that are supported or contradicted, 33 hold" in said


def sets_of_rows(root, small, **found):
    """Results whose stage `test` has these differences from zero on these sets, one an item."""
    for dataset, values in found.items():
        frame = {"dataset": dataset, "metric": "error", "item": [f"{dataset}{k}" for k in range(len(values))]}
        small.write(root, "test", pd.DataFrame(frame | {"value": values}), dataset)
    return small.results(root)


def spread_about(mean, seed=0, count=12, spread=1.0):
    values = np.random.default_rng(seed).normal(size=count)
    return mean + spread * (values - values.mean()) / values.std(ddof=1)


def pooled(results, *sets, **fields):
    """The row of a claim of ours, which all its sets judge."""
    return judge([claim(second=0.0, dataset=sets, **{"section": "ours"} | fields)], results).iloc[0]


def test_sets_that_say_the_same_are_pooled_and_decide_what_none_decides_alone(root, small):
    results = sets_of_rows(root, small, one=spread_about(0.5), two=spread_about(0.5, 1), more=spread_about(0.5, 2))
    alone = judge([claim(second=0.0, dataset="one")], results).iloc[0]
    row = pooled(results, "one", "two", "more")
    assert alone["verdict"] == "open" and row["verdict"] == "supported"
    assert row["effect"] == pytest.approx(0.5, abs=1e-3) and row["i2"] == 0 and row["pairs"] == row["units"] == 36
    assert row["by_set"].count("+0.5") == 3 and row["tested_on"].startswith("one and two and more")


def test_sets_on_either_side_of_zero_are_mixed(root, small):
    results = sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(-1.0))
    row = pooled(results, "one", "two")
    assert row["verdict"] == "mixed" and row["i2"] > 0.9 and row["holds"] == ""


def test_sets_of_both_signs_that_differ_beyond_chance_are_mixed_and_others_are_not(root, small):
    beyond, within = (
        sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(low)) for low in (-0.1, 1.5)
    )  # fmt: skip
    assert pooled(within, "one", "two")["verdict"] == "supported"
    results = sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(-0.1))
    assert pooled(results, "one", "two")["verdict"] == "mixed"
    results = sets_of_rows(root, small, one=spread_about(0.2), two=spread_about(-0.1))
    row = pooled(results, "one", "two")
    assert row["verdict"] == "open" and row["carries"] == ""  # both were judged, and are open


def test_sets_that_agree_by_different_amounts_are_open_together_and_decided_in_each(root, small):
    results = sets_of_rows(root, small, one=spread_about(1.0), two=spread_about(5.0), more=spread_about(20.0))
    row = pooled(results, "one", "two", "more")
    assert row["verdict"] == "open" and row["i2"] > 0.9 and row["low"] < 0 < row["effect"] and row["p"] > 0.05
    assert row["carries"].startswith("open, supported in each set +8.67 [")
    thesis = pooled(results, "one", "two", "more", section="T9")
    assert thesis["verdict"] == "supported" and thesis["carries"].startswith("open, supported in each set +8.67 [")


def test_the_printed_set_judges_the_thesis_and_the_others_show_whether_it_carries_over(root, small):
    results = sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(-2.0, 1), more=spread_about(2.0, 2))
    row = pooled(results, "one", "two", "more", section="T9")
    assert (row["verdict"], row["units"], row["pairs"]) == ("supported", 12, 12)
    assert row["carries"].startswith("mixed") and row["by_set"].count("(12)") == 3 and row["tested_on"] == "one"
    both = pooled(results, "one", "two", "more", section="T9", printed=2)
    assert both["verdict"] == "mixed" and both["units"] == 24
    assert pooled(results, "absent", "one", section="T9")["verdict"] == "supported"  # as printed it was not run
    assert pooled(results, "absent", "one", section="T9")["tested_on"] == "one; not measured on absent"
    assert pooled(results, "absent", "one", "two", section="T9")["units"] == 12  # of the first that was measured


def test_a_later_claim_in_the_same_words_tests_the_sentence_elsewhere(root, small):
    results = sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(-2.0))
    claims = [claim(key="a", second=0.0, dataset="one"), claim(key="b", second=0.0, dataset="two"),
              claim(key="c", second=0.0, dataset="two", section="ours"),
              claim(key="d", sentence="Other words.", second=0.0, dataset="two", of="a")]  # fmt: skip
    table = judge(claims, results)
    assert table["of"].tolist() == ["", "a", "", "a"]
    assert sentences(table)["verdict"].tolist() == ["supported", "contradicted"]
    said = "Sentences of the thesis (1): 1 supported. Sentences of this project (1): 1 contradicted. Verdicts, with 2"
    assert counted(table).startswith(said)


@pytest.mark.parametrize(
    ("words", "word"),
    [
        (["supported", "supported"], "supported"),
        (["supported", "open"], "supported"),
        (["supported", "contradicted"], "depends on the reading"),
        (["supported", "open", "no difference"], "depends on the reading"),
        (["open", "supported"], "open"),
        (["not testable", "supported"], "supported"),
        (["not testable", "supported", "contradicted"], "depends on the reading"),
        (["not testable", "not testable"], "not testable"),
        (["mixed", "supported"], "mixed"),
    ],
)
def test_a_verdict_holds_in_each_reading_or_depends_on_the_reading(words, word):
    assert over_readings(words) == word


def test_readings_are_judged_by_their_own_rows_and_told(root, small):
    frame = {"dataset": "test", "metric": "error", "item": [*range(12)] * 2, "way": ["a"] * 12 + ["b"] * 12}
    small.write(root, "test", pd.DataFrame(frame | {"value": [*spread_about(2.0), *spread_about(-2.0)]}))
    one = claim(second=0.0, where={"way": "a"}, readings=(reading("the other way", where={"way": "b"}),
                                                          reading("absent", where={"way": "c"})))  # fmt: skip
    row = judge([one], small.results(root)).iloc[0]
    assert row["verdict"] == "depends on the reading" and row["effect"] == pytest.approx(2.0)
    assert row["readings"].startswith("as written: supported +2.00 [") and row["readings"].count(";") == 1
    assert "the other way: contradicted -2.00 [" in row["readings"] and row["holds"] == ""


def test_a_set_without_rows_is_named_and_the_others_decide(root, small):
    results = sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(2.0, 1))
    row = pooled(results, "absent", "one", "two")
    assert row["verdict"] == "supported" and row["tested_on"].endswith("; not measured on absent")
    assert pooled(results, "absent", "one")["by_set"] == ""


def test_a_set_without_an_interval_is_told_and_not_pooled(root, small):
    results = sets_of_rows(root, small, one=spread_about(2.0), two=np.full(5, 3.0))
    row = pooled(results, "one", "two")
    assert row["units"] == 12 and row["effect"] == pytest.approx(2.0, abs=1e-3)
    assert row["tested_on"].endswith("no interval of two: all 5 differences are equal")


def test_methods_give_way_to_others_on_all_sets_but_the_first():
    one = claim(
        dataset=("a", "b"), elsewhere={"x": "y"}, first={"method": ("x", "z")}, second={"method": highest_of("x")}
    )
    assert one.on("a").first == {"method": ("x", "z")}
    assert one.on("b").first == {"method": ("y", "z")} and one.on("b").second == {"method": highest_of("y")}


def test_copies_of_a_shape_count_once(root, small):
    names = ["cubesmall", "cubemedium", "cubelarge", "mug", "cup"]
    row = judge([claim(second=0.0)], values(root, small, item=names, value=[1, 1, 1, 3, 5])).iloc[0]
    assert row["effect"] == 3 and (row["pairs"], row["units"]) == (5, 3)
    assert over_text(row) == "5 objects, 3 units"


@pytest.mark.parametrize(
    ("values", "cause"),
    [
        ([0.5, -0.4, 1.0, -0.5], "5 units or fewer a set"),
        (spread_about(0.3), "fewer than 100 units needed"),
        (spread_about(0.1), "100 units or more needed"),
        (spread_about(0.001), "hardly an effect"),
        ([1.0, 1.0], "no spread"),
    ],
)
def test_an_open_claim_says_why_and_how_many_units_would_decide_it(root, small, values, cause):
    row = judge([claim(second=0.0)], sets_of_rows(root, small, one=values)).iloc[0]
    assert row["verdict"] == "open" and row["cause"] == cause
    assert (row["needed"] == row["needed"]) == ("unit" in cause) and open_text(row).startswith(cause)


@pytest.mark.parametrize(("counts", "few"), [((4, 4), True), ((4, 12), False), ((12, 4), False)])
def test_sets_are_few_units_where_the_largest_has_five_or_fewer(root, small, counts, few):
    one, two = (spread_about(0.2, seed, count) for seed, count in enumerate(counts))
    row = pooled(sets_of_rows(root, small, one=one, two=two), "one", "two")
    assert row["verdict"] == "open" and (row["cause"] == "5 units or fewer a set") == few


def test_splits_of_the_same_data_may_never_decide(root, small):
    frame = pd.DataFrame({"dataset": "test", "metric": "error", "repetition": range(12), "value": spread_about(0.3)})
    small.write(root, "test", frame)
    row = judge([claim(second=0.0, over=("repetition",), shared=1 / 3)], small.results(root)).iloc[0]
    assert row["cause"] == "more splits of the same data would not decide"


def test_where_sets_differ_more_sets_are_needed(root, small):
    far = {name: spread_about(mean, spread=0.5) for name, mean in (("one", 3.0), ("two", 0.1), ("more", 1.0))}
    row = pooled(sets_of_rows(root, small, **far), "one", "two", "more")
    assert row["verdict"] == "open" and row["needed_of"] == "data sets" and 3 < row["needed"] < 50


def test_no_margin_is_wider_than_what_it_is_a_margin_of():
    rooms = [one for one in CLAIMS if one.statistic == "room"]
    assert rooms and all(one.margin <= 10 and "%" in one.unit for one in rooms)  # shares of the errors themselves
    others = [one for one in CLAIMS if one.margin and one.statistic != "room"]
    assert all(one.unit in (POINTS, "% of the faces") and one.margin < 10 for one in others)


def test_every_verdict_of_grad_cam_by_pcc_has_its_like_by_nss_and_auc():
    own = {one.key: one for one in CLAIMS if one.stage == "fixation" and one.where.get("metric") == "pcc"}
    own.pop("noise_correlates")  # which is about the printed correlation alone
    every = {one.key: one for one in CLAIMS}
    assert len(own) > 20
    for key, one in own.items():
        for metric in ("nss", "auc"):
            other = every[f"{key}_{metric}"]
            assert other.sentence == one.sentence and other.where["metric"] == metric and other.unit == metric.upper()
            assert (other.first, other.second, other.within) == (one.first, one.second, one.within)


def test_no_two_sets_of_a_claim_share_an_object():
    alike = [{"household", SECTION_3_1, None}, {"gaze", "gaze_3_2", "gaze_on_black"}, {"princeton", "princeton_3_1"}]
    for one in CLAIMS:
        assert all(len(same & set(one.sets)) < 2 for same in alike), one.key


@pytest.mark.slow
def test_chance_calls_as_many_verdicts_as_is_said(root, small):
    noise = np.random.default_rng(0).normal(size=(800, 20))
    frame = pd.DataFrame({"dataset": "test", "method": np.repeat([f"m{k}" for k in range(800)], 20)})
    small.write(root, "test", frame.assign(item=list(range(20)) * 800, value=noise.ravel()))
    claims = [claim(key=str(k), first={"method": f"m{k}"}, second=0) for k in range(800)]
    judged = judge(claims, small.results(root))
    words = judged["verdict"].value_counts()
    assert 5 < words["supported"] < 40 and 5 < words["contradicted"] < 40  # 20 of each: 2.5 % either way
    assert (judged["holds"] == "yes").sum() <= 2  # not one of them is an effect


def test_a_new_claim_is_one_entry(root, small):
    results = values(root, small, item=list("abcde"), value=[1.0, 1.1, 0.9, 1.0, 1.05])
    assert judge([claim(second=0)], results)["verdict"].tolist() == ["supported"]


def test_every_verdict_can_be_recomputed_from_the_differences(root, results, small):
    small.write(
        root, "test", pd.DataFrame({"dataset": "test", "item": list("abc"), "value": [0.1234567891, 0.2, -0.01]})
    )
    table, pairs = judged([*CLAIMS, claim(second=0)], small.results(root))
    write_claims(table, pairs, root / "reports")
    claims = pd.read_csv(root / "reports/claims.csv")
    stored = pd.read_csv(root / "reports/claims/differences.csv.gz", dtype={"pair": str})
    found = {key: part["difference"] for key, part in stored[stored["judged"]].groupby("key", sort=False)}
    assert set(found) == set(claims.loc[claims["pairs"] > 0, "key"]) and len(found) > 5
    for row in claims[claims["pairs"] > 0].itertuples():
        mean, low, high = interval(found[row.key], row.shared)
        assert len(found[row.key]) == row.pairs and verdict(low, high, row.unit) == row.verdict
        assert (mean, low, high) == pytest.approx((row.effect, row.low, row.high), rel=1e-5, nan_ok=True)


@pytest.mark.slow
def test_a_process_that_imported_no_topic_knows_the_statistic_of_a_claim():
    program = (
        "import pickle, sys; from pathlib import Path\n"
        "from stages.engine.settings import Workspace; from stages.report import Params\n"
        "from stages.report.results import Results; from stages.report.verdict import judge\n"
        "one, workspace = pickle.load(sys.stdin.buffer), Workspace(Path('.'))\n"
        "assert 'stages.report.topics' not in sys.modules\n"
        "print(judge([one], Results(workspace, workspace.settings(Params)))['verdict'].iloc[0])"
    )
    one = pickle.dumps(next(claim for claim in CLAIMS if claim.statistic == "falls_with_faces"))
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", program], input=one, cwd=root, capture_output=True, check=True)
    assert done.stdout.strip()


def test_a_reading_on_sets_of_its_own_is_judged_by_their_rows_alone(root, small):
    results = sets_of_rows(root, small, one=spread_about(2.0), two=spread_about(-2.0), more=spread_about(2.0))
    absent, there = (reading("elsewhere", dataset=(name, "two")) for name in ("absent", "more"))
    row = pooled(results, "one", "two", section="T9", readings=(absent,))
    assert row["verdict"] == "supported" and pd.isna(row["readings"])
    row = pooled(results, "one", "two", section="T9", readings=(there,))
    assert row["verdict"] == "supported" and "elsewhere: supported +2" in row["readings"]

"""Claims: pairing, intervals, words, and the one word."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from stages.charts.datasets import SECTION_3_1
from stages.charts.results import NotRun
from stages.engine.statistics import interval, p_value
from stages.report import effects, parts
from stages.report.__main__ import write_claims
from stages.report.claims import POINTS, Claim, highest_of, in_sums, lowest_of, reading
from stages.report.claims_page import effect, open_text, over_text
from stages.report.effects import STATISTICS, differences
from stages.report.parts import CLAIMS
from stages.report.verdict import counted, holding, judge, judged, over_readings, sentences, verdict
from tests.report.frames import verdicts


@pytest.fixture
def values(measure):
    """A function of columns to the results whose stage `test` has rows of these."""
    return lambda **columns: measure("test", pd.DataFrame({"dataset": "test", "metric": "error"} | columns))


@pytest.fixture
def sets_of_rows(measure):
    """A function of sets and their differences from zero, one an item, to the results whose stage `test` has these."""

    def write(**differences_by_set):
        rows = [
            (name, "error", f"{name}{k}", value)
            for name, numbers in differences_by_set.items()
            for k, value in enumerate(numbers)
        ]
        return measure("test", pd.DataFrame(rows, columns=["dataset", "metric", "item", "value"]))

    return write


def of(results, key):
    return verdicts(CLAIMS, results, key).loc[key]


def claim(**fields):
    """A claim on the rows of `values`, one pair per item."""
    return Claim(**{"key": "one", "section": "T9", "sentence": "Sentence.", "stage": "test", "over": ("item",),
                    "scale": 1.0, "unit": "units"} | fields)  # fmt: skip


@pytest.mark.parametrize(("low", "high", "unit", "word"), [
    (0.1, 2.9, POINTS, "supported"), (-0.3, -0.1, "", "contradicted"), (-0.1, 0.3, "", "open"), (0, 1, "", "open"),
    (-1, 0, "", "open"), (np.nan, np.nan, "", "open"), (-2.9, 2.9, POINTS, "no difference"),
    (-3.1, 2.9, POINTS, "open"), (-2.9, 3.1, POINTS, "open"), (-0.04, 0.04, "NSS", "no difference"),
    (-0.04, 0.04, "PCC", "open"), (-0.04, 0.04, "touches", "open"),  # no margin was stated
])  # fmt: skip
def test_word_follows_from_the_interval_and_from_what_matters_in_its_unit(low, high, unit, word):
    assert verdict(low, high, unit) == word


def test_what_is_decided_holds_or_falls_with_the_number_of_claims_of_its_chapter():
    few = pd.DataFrame({"section": ["T3.1", "T4.2"], "p": [0.001, 0.04], "verdict": ["supported", "contradicted"]})
    many = pd.DataFrame({"section": ["T4.2"] * 20, "p": np.linspace(0.3, 0.9, 20), "verdict": ["open"] * 20})
    assert holding(few).tolist() == ["yes", "yes"]
    assert holding(pd.concat([few, many], ignore_index=True)).tolist() == ["yes", "no", *[""] * 20]
    unknown = few.assign(p=np.nan, verdict="open")
    assert holding(unknown).tolist() == ["", ""]


@pytest.mark.parametrize(("key", "word", "size", "pairs"), [
    ("glance_over_blind_ours", "supported", 30, 6), ("glance_over_ssim_ours", "no difference", 0, 6),
    ("glance_keep_metro", "open", 100 * (1 - 2) / 1.5, 2),
])  # fmt: skip
def test_claims_on_the_small_run_have_its_effects(results, key, word, size, pairs):
    row = of(results, key)
    assert (row["verdict"], row["pairs"]) == (word, pairs) and row["effect"] == pytest.approx(size, abs=2)


def test_a_reading_without_an_interval_is_told_from_one_that_was_not_run(results):
    readings = dict(text.split(": ") for text in of(results, "glance_keep_metro")["readings"].split("; "))
    assert readings["only where three rings fit"] == "not testable, no interval"
    assert readings["1,500 faces alone"] == "not run"


@pytest.mark.parametrize(("six", "four", "beyond"), [(1 / 3, 1 / 4, 0), (2 / 3, 1 / 2, 1 / 3 - 1 / 2)])
def test_beyond_chance_takes_off_the_guessing_of_the_objects_that_the_group_held(root, small, six, four, beyond):
    frame = small.classification()
    small.write(root, "classification", frame.assign(value=frame["group"].map({"six": six, "four": four})))
    small.write_set(root, "six", 3)
    results = small.results(root)
    assert of(results, "four_easier_ours")["effect"] == pytest.approx(100 * (four - six), rel=1e-3)
    assert of(results, "four_easier_beyond_chance_ours")["effect"] == pytest.approx(100 * beyond, abs=1e-3)


def test_pairs_match_by_repetition_not_by_row(values):
    columns = {"item": list("abba"), "method": ["x", "x", "y", "y"], "value": [3, 5, 1, 2]}
    gaps = differences(values(**columns), claim(first={"method": "x"}, second={"method": "y"}))
    assert gaps.to_dict() == {"a": 1, "b": 4}


@pytest.mark.parametrize(("where", "note", "key", "words"), [
    ({"group": "six"}, "no duck", "four_easier_ours", "no duck"),  # a note of all methods and classifiers
    ({"group": "six"}, "not run: no duck", "four_easier_ours", "no duck"),
    ({"group": "six", "method": "thesis_ssim"}, "no duck", "glance_over_ssim_ours", "no duck"),
    ({"group": "six", "method": "random", "classifier": "knn", "metric": "accuracy"}, "no duck",
     "glance_over_blind_ours", "no duck"),
    ({"group": "six"}, None, "knn_best_ours", "group six is not among those that classification measured"),
])  # fmt: skip
def test_rows_that_were_left_out_hand_on_their_note(measure, small, where, note, key, words):
    frame = small.left_out(small.classification(), note, **where)
    frame = frame if note else frame.dropna(subset=["value"])
    row = of(measure("classification", frame), key)
    assert row["tested_on"] == f"not run: {words}" and (row["pairs"], row["units"]) == (0, 0)


def test_several_values_are_averaged_where_all_were_measured(values):
    columns = {"item": list("aaabbb"), "method": ["one", "two", "base"] * 2, "value": [1, 3, 1, np.nan, 5, 1]}
    gaps = differences(values(**columns), claim(first={"method": ("one", "two")}, second={"method": "base"}))
    assert gaps.to_dict() == {"a": 1.0}


def test_best_and_worst_rival_are_picked_by_their_means_and_never_the_other_side(values):
    columns = {"item": list("aaaabbbb"), "method": ["mine", "low", "high", "seen"] * 2}
    results = values(**columns, value=[9, 1, 3, 8, 9, 2, 5, 8])
    side = {"method": "mine"}
    but = ("se*",)
    assert differences(results, claim(first=side, second={"method": highest_of(but=but)})).tolist() == [6, 4]
    assert differences(results, claim(first=side, second={"method": lowest_of()})).tolist() == [8, 7]
    assert differences(results, claim(first=side, second={"method": highest_of("low")})).tolist() == [8, 7]
    with pytest.raises(NotRun, match="no other method than mine"):
        differences(results, claim(first=side, second={"method": highest_of("absent")}))


def test_the_best_of_several_rivals_contradicts_only_where_one_would_beyond_their_number(values):
    differences = [0.1, 0.3, 0.3, 0.1, 0.0, 0.3]
    columns = {"item": [f"o{k}" for k in range(6)] * 4, "method": np.repeat(["ours", "a", "b", "c"], 6)}
    rows = values(**columns, value=[0.0] * 6 + differences + [-1.0] * 12)
    sides = {"first": {"method": "ours"}, "second": {"method": "a"}}
    picked = sides | {"second": {"method": highest_of("a", "b", "c")}}
    one, best = (judge([claim(**fields)], rows).iloc[0] for fields in (sides, picked))
    assert (one["verdict"], best["verdict"]) == ("contradicted", "open") and one["p"] == best["p"] > 0.05 / 3


def test_differences_within_a_unit_are_relative_and_averaged_or_contrasted(values):
    columns = {"item": list("aaaa"), "target": ["1", "1", "2", "2"], "method": ["x", "y"] * 2, "value": [3, 1, 0, 0]}
    sides = {"first": {"method": "x"}, "second": {"method": "y"}}
    results = values(**columns)
    gaps = differences(results, claim(**sides, within=("target",), relative=True))
    assert gaps.to_dict() == {"a": 0.5}  # 2 / 2 at the first target, 0 where both are zero
    contrast = claim(**sides, contrast=({"target": "1"}, {"target": "2"}), scale=100, margin=1)
    assert differences(results, contrast).tolist() == [201]  # the scale comes before the margin


def test_the_rival_of_a_contrast_is_one_method_picked_by_what_the_contrast_is_of(values):
    levels = {("mine", "late"): 9, ("mine", "early"): 1, ("low", "late"): 2, ("low", "early"): 1,
              ("high", "late"): 7, ("high", "early"): 7}  # fmt: skip
    columns = {"item": list("ab") * 6, "method": np.repeat([name for name, _ in levels], 2)}
    columns["target"] = np.repeat([time for _, time in levels], 2)
    gains = claim(first={"method": "mine"}, second={"method": lowest_of()},
                  contrast=({"target": "late"}, {"target": "early"}))  # fmt: skip
    results = values(**columns, value=np.repeat(list(levels.values()), 2))
    assert differences(results, gains).tolist() == [8, 8]  # over high, which gains nothing; low gains one


def test_one_side_may_count_by_its_mean_or_be_of_another_set(measure, values):
    columns = {"item": ["a", "b", None, None], "method": ["own", "own", "all", "all"], "value": [3, 4, 1, 2]}
    sides = {"first": {"method": "own"}, "second": {"method": "all"}, "mean_of": "second"}
    results = values(fold=[0, 1, 2, 3], **columns)
    assert differences(results, claim(**sides, over=("fold",))).tolist() == [1.5, 2.5]
    other = pd.DataFrame({"dataset": "other", "metric": "error", "item": ["a", "b"], "value": [7, 9]})
    elsewhere = claim(first={"dataset": "other"}, second={"method": "own"})
    assert differences(measure("test", other, results=results), elsewhere).to_dict() == {"a": 4, "b": 5}


def test_pattern_and_empty_cell_choose_rows(values):
    columns = {"item": list("aabb"), "method": ["net-frozen", "net-tuned"] * 2, "sense": [None, None, "x", "x"]}
    results = values(**columns, value=[1, 2, 3, 4])
    assert differences(results, claim(where={"method": "*-frozen"}, second=0)).to_dict() == {"a": 1, "b": 3}
    assert differences(results, claim(where={"sense": None}, second=0)).to_dict() == {"a": 1.5}


def test_equal_differences_are_open_and_say_why(values):
    results = values(item=list("abc"), value=[6.67, 6.67, 6.67])
    table = judge([claim(second=0.0)], results)
    assert table["verdict"].tolist() == ["open"]
    assert table["tested_on"][0].endswith("; no interval: all 3 differences are equal")
    assert effect(table.iloc[0]) == "+6.67 units"


def test_words_are_written_from_the_fields(root, results, small):
    text = "test, kNN, six objects, test part drawn at random, all imprints, our glance minus blind touch, one draw"
    entry = next(claim for claim in CLAIMS if claim.key == "glance_over_blind_ours")
    other = replace(entry, where=entry.where | {"classifier": "deep_learning"}, note="so")
    assert judge([entry, other], results)["tested_on"].tolist() == [text, text.replace("kNN", "deep learning") + ", so"]
    assert of(results, "knn_best_ours")["tested_on"].endswith("kNN minus the highest of the others")
    small.write_set(root, "six", 4)
    assert of(results, entry.key)["tested_on"] == text.replace("six objects", "4 objects (group six)")


def frame_of(words, **columns):
    """A frame of `judge` with these verdicts, each of a primary claim."""
    fields = {"verdict": words, "section": "T3.1", "claim": "Sentence.", "pairs": 5, "of": ""}
    return pd.DataFrame(fields | {"holds": ""} | columns)


def test_verdicts_are_counted_with_those_that_hold_among_so_many():
    words = ["supported"] * 30 + ["contradicted"] * 10 + ["no difference"] * 5 + ["mixed"] * 2 + ["open"] * 45
    text = counted(frame_of(words, holds=["yes"] * 33 + ["no"] * 7 + [""] * 52))
    words = "30 supported, 10 contradicted, 5 no difference, 2 mixed, 45 open"
    start = f"Sentences of the thesis (92): {words}. Its proposals for future work (T6.3, 0): none. Sentences of this"
    assert text.startswith(f"{start} project (0): none.")
    mixed = counted(frame_of(["supported", "open", "mixed"], section=["T3.1", "T6.3", "ours"], holds=""))
    assert mixed.startswith(
        "Sentences of the thesis (1): 1 supported. Its proposals for future work (T6.3, 1): 1 open."
    )
    assert "Sentences of this project (1): 1 mixed." in mixed
    assert f"that test a sentence elsewhere (92): {words}." in text
    assert "Of the 40 that are supported or contradicted, 33 hold" in text


def spread_about(mean, seed=0, count=12, spread=1.0):
    values = np.random.default_rng(seed).normal(size=count)
    return mean + spread * (values - values.mean()) / values.std(ddof=1)


def pooled(results, *sets, **fields):
    """The row of a claim of ours, which all its sets judge."""
    return judge([claim(second=0.0, dataset=sets, **{"section": "ours"} | fields)], results).iloc[0]


def test_sets_that_say_the_same_are_pooled_and_decide_what_none_decides_alone(sets_of_rows):
    results = sets_of_rows(one=spread_about(0.5), two=spread_about(0.5, 1), more=spread_about(0.5, 2))
    alone = judge([claim(second=0.0, dataset="one")], results).iloc[0]
    row = pooled(results, "one", "two", "more")
    assert alone["verdict"] == "open" and row["verdict"] == "supported"
    assert row["effect"] == pytest.approx(0.5, abs=1e-3) and row["i2"] == 0 and row["pairs"] == row["units"] == 36
    assert row["by_set"].count("+0.5") == 3 and row["tested_on"].startswith("one and two and more")


@pytest.mark.parametrize(("first", "second", "word"), [
    (2.0, -1.0, "mixed"),  # each side of zero has a set
    (2.0, -0.1, "mixed"),  # they differ by chance alone in less than 5 %
    (2.0, 1.5, "supported"), (0.2, -0.1, "open"),
])  # fmt: skip
def test_sets_of_both_signs_that_differ_beyond_chance_are_mixed(sets_of_rows, first, second, word):
    row = pooled(sets_of_rows(one=spread_about(first), two=spread_about(second)), "one", "two")
    assert (row["verdict"], row["carries"]) == (word, "")  # both were judged


def test_sets_that_agree_by_different_amounts_are_open_together_and_decided_in_each(sets_of_rows):
    results = sets_of_rows(one=spread_about(1.0), two=spread_about(5.0), more=spread_about(20.0))
    row = pooled(results, "one", "two", "more")
    assert row["verdict"] == "open" and row["i2"] > 0.9 and row["low"] < 0 < row["effect"] and row["p"] > 0.05
    assert row["carries"].startswith("open, supported in each set +8.67 [")
    thesis = pooled(results, "one", "two", "more", section="T9")
    assert thesis["verdict"] == "supported" and thesis["carries"].startswith("open, supported in each set +8.67 [")


def test_the_printed_set_judges_the_thesis_and_the_others_show_whether_it_carries_over(sets_of_rows):
    results = sets_of_rows(one=spread_about(2.0), two=spread_about(-2.0, 1), more=spread_about(2.0, 2))
    row = pooled(results, "one", "two", "more", section="T9")
    assert (row["verdict"], row["units"], row["pairs"]) == ("supported", 12, 12)
    assert row["carries"].startswith("mixed") and row["by_set"].count("(12)") == 3 and row["tested_on"] == "one"
    two_sets = pooled(results, "one", "two", "more", section="T9", printed=2)
    assert two_sets["verdict"] == "mixed" and two_sets["units"] == 24
    assert pooled(results, "absent", "one", section="T9")["verdict"] == "supported"  # as printed it was not run
    assert pooled(results, "absent", "one", section="T9")["tested_on"] == "one; not measured on absent"
    assert pooled(results, "absent", "one", "two", section="T9")["units"] == 12  # of the first that was measured
    assert pooled(results, "absent", "one")["by_set"] == ""


def test_a_later_claim_in_the_same_words_tests_the_sentence_elsewhere(sets_of_rows):
    results = sets_of_rows(one=spread_about(2.0), two=spread_about(-2.0))
    claims = [claim(key="a", second=0.0, dataset="one"), claim(key="b", second=0.0, dataset="two"),
              claim(key="c", second=0.0, dataset="two", section="ours"),
              claim(key="d", sentence="Other words.", second=0.0, dataset="two", of="a")]  # fmt: skip
    table = judge(claims, results)
    assert table["of"].tolist() == ["", "a", "", "a"]
    assert sentences(table)["verdict"].tolist() == ["supported", "contradicted"]
    text = counted(table)
    assert text.startswith("Sentences of the thesis (1): 1 supported.")
    assert "Sentences of this project (1): 1 contradicted. Verdicts, with 2" in text


def test_each_claim_that_tests_a_sentence_elsewhere_names_a_primary_claim():
    primaries = {entry.key for entry in CLAIMS if not entry.of}
    assert {entry.key: entry.of for entry in CLAIMS if entry.of and entry.of not in primaries} == {}


@pytest.mark.parametrize(("words", "word"), [
    (["supported", "open"], "supported"), (["supported", "open", "no difference"], "depends on the reading"),
    (["open", "supported"], "open"), (["mixed", "supported"], "mixed"),
    (["not testable", "supported", "contradicted"], "depends on the reading"),
    (["supported", "mixed"], "depends on the reading"), (["open", "mixed"], "open"),
    (["open", "supported", "contradicted"], "depends on the reading"),
    (["not testable", "supported"], "supported"), (["not testable", "not testable"], "not testable"),
])  # fmt: skip
def test_a_verdict_holds_in_each_reading_or_depends_on_the_reading(words, word):
    assert over_readings(words) == word


@pytest.mark.parametrize(("written", "literal", "word"), [
    ("contradicted", "open", "depends on the reading"), ("open", "supported", "depends on the reading"),
    ("open", "open", "open"), ("supported", "supported", "supported"), ("open", "mixed", "open"),
    ("no difference", "open", "no difference"),
    ("supported", "not testable", "supported"), ("open", "not testable", "open"), ("not testable", "open", "open"),
])  # fmt: skip
def test_a_word_that_the_literal_reading_alone_decides_or_leaves_open_depends_on_the_reading(written, literal, word):
    assert over_readings([written, literal], literal) == word


def test_readings_are_judged_by_their_own_rows_and_told(values):
    numbers = [*spread_about(2.0), *spread_about(-2.0)]
    results = values(item=[*range(12)] * 2, way=["a"] * 12 + ["b"] * 12, value=numbers)
    entry = claim(second=0.0, where={"way": "a"}, readings=(reading("the other way", where={"way": "b"}),
                                                          reading("absent", where={"way": "c"})))  # fmt: skip
    row = judge([entry], results).iloc[0]
    assert row["verdict"] == "depends on the reading" and row["effect"] == pytest.approx(2.0)
    assert row["readings"].startswith("as written: supported +2.00 [") and row["readings"].endswith("; absent: not run")
    assert "the other way: contradicted -2.00 [" in row["readings"] and row["holds"] == ""


def test_a_set_without_an_interval_is_told_and_not_pooled(sets_of_rows):
    results = sets_of_rows(one=spread_about(2.0), two=np.full(5, 3.0))
    row = pooled(results, "one", "two")
    assert row["units"] == 12 and row["effect"] == pytest.approx(2.0, abs=1e-3)
    assert row["tested_on"].endswith("no interval of two: all 5 differences are equal")


def test_a_set_of_two_units_does_not_rule_the_mean_of_several(sets_of_rows):
    rows = {"one": spread_about(0.4), "two": np.array([3.0, 3.01])}
    row = pooled(sets_of_rows(**rows), "one", "two")
    assert row["verdict"] == "open" and row["units"] == 12 and row["effect"] == pytest.approx(0.4, abs=1e-3)
    row = pooled(sets_of_rows(two=rows["two"], more=rows["two"] + 1), "two", "more")  # where all sets are so small
    assert row["units"] == 4


def test_a_reading_that_the_printed_set_does_not_have_is_not_judged_by_another_set(sets_of_rows):
    results = sets_of_rows(one=spread_about(0.1), two=spread_about(2.0))
    for name, rows in (("one", {"way": "a"}), ("two", {"way": "b"})):
        path = results.workspace.root / f"reports/measurements/{name}/test.csv.gz"
        pd.read_csv(path).assign(**rows).to_csv(path, index=False)
    other = reading("the other way", where={"way": "b"})
    entry = claim(second=0.0, dataset=("one", "two"), printed=1, where={"way": "a"}, readings=(other,))
    row = judge([entry], type(results)(results.workspace, results.settings)).iloc[0]
    assert row["verdict"] == "open" and "supported" not in str(row["readings"])


def test_methods_give_way_to_others_on_all_sets_but_the_first():
    sides = {"first": {"method": ("x", "z")}, "second": {"method": highest_of("x")}}
    entry = claim(dataset=("a", "b"), elsewhere={"x": "y"}, **sides)
    assert entry.on("a").first == {"method": ("x", "z")}
    assert entry.on("b").first == {"method": ("y", "z")} and entry.on("b").second == {"method": highest_of("y")}


def test_copies_of_a_shape_count_once(values):
    names = ["cubesmall", "cubemedium", "cubelarge", "mug", "cup"]
    row = judge([claim(second=0.0)], values(item=names, value=[1, 1, 1, 3, 5])).iloc[0]
    assert row["effect"] == 3 and (row["pairs"], row["units"]) == (5, 3)
    assert over_text(row) == "5 objects, 3 units"


@pytest.mark.parametrize(("values", "cause"), [
    ([0.5, -0.4, 1.0, -0.5], "5 units or fewer a set"), (spread_about(0.3), "fewer than 100 units needed"),
    (spread_about(0.1), "100 units or more needed"), (spread_about(0.001), "hardly an effect"),
    ([1.0, 1.0], "no spread"),
])  # fmt: skip
def test_an_open_claim_says_why_and_how_many_units_would_decide_it(sets_of_rows, cause, values):
    row = judge([claim(second=0.0)], sets_of_rows(one=values)).iloc[0]
    assert row["verdict"] == "open" and row["cause"] == cause
    assert (row["needed"] == row["needed"]) == ("unit" in cause) and open_text(row).startswith(cause)


@pytest.mark.parametrize(("counts", "few"), [((4, 4), True), ((4, 12), False), ((12, 4), False)])
def test_sets_are_few_units_where_the_largest_has_five_or_fewer(sets_of_rows, counts, few):
    first, second = (spread_about(0.2, seed, count) for seed, count in enumerate(counts))
    row = pooled(sets_of_rows(one=first, two=second), "one", "two")
    assert row["verdict"] == "open" and (row["cause"] == "5 units or fewer a set") == few


def test_splits_of_the_same_data_may_never_decide(values):
    results = values(repetition=range(12), value=spread_about(0.3))
    row = judge([claim(second=0.0, over=("repetition",), shared=1 / 3)], results).iloc[0]
    assert row["cause"] == "more splits of the same data would not decide"


def test_where_sets_differ_more_sets_are_needed(sets_of_rows):
    far = {name: spread_about(mean, spread=0.5) for name, mean in (("one", 3.0), ("two", 0.1), ("more", 1.0))}
    row = pooled(sets_of_rows(**far), "one", "two", "more")
    assert row["verdict"] == "open" and row["needed_of"] == "data sets" and 3 < row["needed"] < 50


def test_no_two_sets_of_a_claim_share_an_object():
    alike = [{"household", SECTION_3_1, None}, {"gaze", "gaze_3_2"}, {"princeton", "princeton_3_1"}]
    for entry in CLAIMS:
        assert all(len(same & set(entry.sets)) < 2 for same in alike), entry.key


@pytest.mark.slow
def test_every_verdict_can_be_recomputed_from_the_differences(root, small):
    rows = {"dataset": "test", "item": list("abc"), "value": [0.1234567891, 0.2, -0.01]}
    small.write(root, "test", pd.DataFrame(rows))
    table, pairs = judged([*CLAIMS, claim(second=0)], small.results(root))
    write_claims(table, pairs, root / "reports")
    claims = pd.read_csv(root / "reports/claims.csv")
    stored = pd.read_csv(root / "reports/claims/differences.csv.gz", dtype={"pair": str})
    by_key = {key: part["difference"] for key, part in stored[stored["judged"]].groupby("key", sort=False)}
    assert set(by_key) == set(claims.loc[claims["pairs"] > 0, "key"]) and len(by_key) > 5
    for row in claims[claims["pairs"] > 0].itertuples():
        mean, low, high = interval(by_key[row.key], row.shared)
        assert len(by_key[row.key]) == row.pairs and verdict(low, high, row.unit) == row.verdict
        assert (mean, low, high) == pytest.approx((row.effect, row.low, row.high), rel=1e-5, nan_ok=True)


def test_a_process_that_imported_no_topic_loads_the_statistic_of_a_claim(values, monkeypatch):
    known = {parts.__name__: dict(STATISTICS)}
    monkeypatch.setattr(effects, "import_module", lambda name: STATISTICS.update(known[name]))
    monkeypatch.delitem(STATISTICS, "difference")
    assert differences(values(item=list("ab"), value=[1.0, 2.0]), claim(second=0)).tolist() == [1, 2]


def test_a_reading_on_sets_of_its_own_is_judged_by_their_rows_alone(sets_of_rows):
    results = sets_of_rows(one=spread_about(2.0), two=spread_about(-2.0), more=spread_about(2.0))
    absent, present = (reading("elsewhere", dataset=(name, "two")) for name in ("absent", "more"))
    row = pooled(results, "one", "two", section="T9", readings=(absent,))
    assert row["verdict"] == "supported" and row["readings"].endswith("]; elsewhere: not run")
    row = pooled(results, "one", "two", section="T9", readings=(present,))
    assert row["verdict"] == "supported" and "elsewhere: supported +2" in row["readings"]


def test_a_reading_in_the_place_of_the_claim_shows_all_its_sets(sets_of_rows):
    results = sets_of_rows(one=spread_about(2.0), two=spread_about(3.0))
    row = pooled(results, "absent", section="T9", readings=(reading("elsewhere", dataset=("one", "two")),))
    assert row["units"] == 12 and row["effect"] == pytest.approx(2.0, abs=1e-3)
    assert row["by_set"].startswith("one +2") and "; two +3" in row["by_set"]
    assert row["tested_on"].endswith("in the reading elsewhere, since as written it was not run")


def test_chance_calls_as_many_verdicts_as_is_said():
    noise = np.random.default_rng(0).normal(size=(800, 20))
    words = [verdict(*interval(values)[1:]) for values in noise]
    assert 5 < words.count("supported") < 40 and 5 < words.count("contradicted") < 40  # 20 of each: 2.5 % either way
    p_values = [p_value(values) if word != "open" else 0.5 for values, word in zip(noise, words, strict=True)]
    frame = pd.DataFrame({"section": "T9", "p": p_values, "verdict": words})
    assert (holding(frame) == "yes").sum() <= 2  # not one of them is an effect


def test_a_reading_in_sums_names_each_combination_anew_and_leaves_the_other_methods():
    (sums,) = in_sums("itti", lowest_of("VisAttCon-area", "SymLat", "heat_kernel"))
    assert sums.changes["first"] == {"method": "VisAttSummed"}
    assert sums.changes["second"] == {"method": lowest_of("VisAttConSummed-area", "SymLat", "heat_kernel")}
    assert in_sums("SymLat", "Curv") == ()

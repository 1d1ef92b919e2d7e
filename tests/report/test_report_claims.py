"""Claims: the entries of conf/claims, pairing, intervals, words, and the one word."""

import re

import numpy as np
import pandas as pd
import pytest

from stages.engine.measurements import Measurements, Missing
from stages.engine.settings import conf_folder
from stages.engine.statistics import interval, p_value
from stages.report.__main__ import write_claims
from stages.report.claims import POINTS, Claim, ClaimError, Pick, Reading, Words, load
from stages.report.claims_page import effect
from stages.report.effects import check, differences
from stages.report.verdict import counted, holding, judge, judged, over_readings, over_text, verdict

ROOT = conf_folder().parent


def test_every_entry_names_rows_that_are_measured_and_sentences_that_are_there():
    claims, measurements = load(), Measurements(ROOT / "reports")
    assert len({claim.key for claim in claims}) == len(claims) <= 200
    for claim in claims:
        check(claim, measurements)
        text = Words().tested_on(claim, claim.sets)
        assert not re.search(r", ?,|  |,$|minus$", text), (claim.key, text)


ENTRY = """\
readings:
  at night: {where: {light: 0}}
defaults:
  lod: {sets: [household], over: [item], unit: mm}
claims:
  - key: one
    section: T3.1
    sentence: Sentence.
    stage: lod
    where: {metric: error, target: ['1500', '3000']}
    first: {method: {lowest: [a, b], but: [c]}}
    second: 0.5
    shared: {household: 1/3}
    readings: [at night, {name: far, scale: 2, literal: true}]
"""


@pytest.fixture
def written(tmp_path):
    """A function of the text of a file to the claims in it."""

    def claims(text):
        (tmp_path / "chapter_3.yaml").write_text(text)
        return load(tmp_path)

    return claims


def test_an_entry_is_read_with_the_defaults_of_its_stage_and_named_readings(written):
    (entry,) = written(ENTRY)
    assert entry.sets == ("household",) and entry.over == ("item",) and entry.unit == "mm"
    assert entry.where["target"] == ("1500", "3000") and entry.first["method"] == Pick(("a", "b"), True, ("c",))
    assert entry.share("household") == 1 / 3 and entry.place.endswith("chapter_3.yaml:6")
    night, far = entry.readings
    assert night.of(entry).where == {**entry.where, "light": 0} and not night.literal
    assert far.of(entry).scale == 2 and far.literal and far.of(entry).readings == ()


@pytest.mark.parametrize(("old", "new", "message"), [
    ("    second:", "    secnd:", r"chapter_3.yaml:6 \(one\): secnd is unknown, perhaps second"),
    ("[at night,", "[at nigth,", r":6 \(one\): at nigth is unknown, perhaps at night"),
    ("sets: [household]", "sets: [houshold]", r":6 \(one\): set houshold is not in conf/data"),
    ("stage: lod", "stage: lods", r":6 \(one\): no sets"),
    ("section: T3.1", "section: chapter", r":6 \(one\): section chapter is neither"),
    ("lowest:", "last:", r":6 \(one\), method: last is unknown, perhaps lowest"),
    ("    sentence: Sentence.\n", "", r":6 \(one\): no sentence"),
    ("    shared", "    of: two\n    shared", ":6: one is `of` two, which is no claim"),
    ("claims:", "claim:", "no list `claims`"), ("claims:", "claims: [", "chapter_3.yaml: while parsing"),
])  # fmt: skip
def test_an_entry_that_is_wrong_is_named_with_its_line(written, old, new, message):
    with pytest.raises(ClaimError, match=message):
        written(ENTRY.replace(old, new))


def test_an_entry_whose_metric_or_statistic_is_not_there_is_named_with_its_line(written, measured):
    rows = pd.DataFrame({"item": ["a"], "method": "a", "target": "1500", "metric": "error", "value": 1.0})
    measurements = measured("lod", rows, "household")
    (entry,) = written(ENTRY)
    with pytest.raises(ClaimError, match=r"chapter_3.yaml:6 \(one\): no column light in rows of lod"):
        check(entry, measurements)
    (entry,) = written(ENTRY.replace("metric: error", "metric: eror"))
    with pytest.raises(ClaimError, match=r":6 \(one\): metric eror is not among those that lod measured"):
        check(entry, measurements)
    (entry,) = written(ENTRY + "    statistic: meen\n")
    with pytest.raises(ClaimError, match=r":6 \(one\): statistic meen is unknown"):
        check(entry, measurements)


@pytest.fixture
def values(measured):
    """A function of columns to the rows of the stage `test` that have these."""
    return lambda **columns: measured("test", pd.DataFrame({"dataset": "test", "metric": "error"} | columns))


@pytest.fixture
def sets_of_rows(measured):
    """A function of sets and their differences from zero, one an item, to the rows of the stage `test` with these."""

    def write(**differences_by_set):
        rows = [
            (name, "error", f"{name}{k}", value)
            for name, numbers in differences_by_set.items()
            for k, value in enumerate(numbers)
        ]
        return measured("test", pd.DataFrame(rows, columns=["dataset", "metric", "item", "value"]))

    return write


def claim(**fields):
    """A claim on the rows of `values`, one pair per item."""
    return Claim(**{"key": "one", "section": "T9", "sentence": "Sentence.", "stage": "test", "sets": ("test",),
                    "where": {}, "first": {}, "over": ("item",), "scale": 1.0, "unit": "units"} | fields)  # fmt: skip


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


def test_pairs_match_by_repetition_not_by_row(values):
    columns = {"item": list("abba"), "method": ["x", "x", "y", "y"], "value": [3, 5, 1, 2]}
    gaps = differences(values(**columns), claim(first={"method": "x"}, second={"method": "y"}))
    assert gaps.to_dict() == {"a": 1, "b": 4}


def test_several_values_are_averaged_where_all_were_measured(values):
    columns = {"item": list("aaabbb"), "method": ["one", "two", "base"] * 2, "value": [1, 3, 1, np.nan, 5, 1]}
    gaps = differences(values(**columns), claim(first={"method": ("one", "two")}, second={"method": "base"}))
    assert gaps.to_dict() == {"a": 1.0}


def test_best_and_worst_rival_are_picked_by_their_means_and_never_the_other_side(values):
    columns = {"item": list("aaaabbbb"), "method": ["mine", "low", "high", "seen"] * 2}
    results = values(**columns, value=[9, 1, 3, 8, 9, 2, 5, 8])
    side = {"method": "mine"}
    but = ("seen",)
    assert differences(results, claim(first=side, second={"method": Pick(but=but)})).tolist() == [6, 4]
    assert differences(results, claim(first=side, second={"method": Pick(lowest=True)})).tolist() == [8, 7]
    assert differences(results, claim(first=side, second={"method": Pick(("low",))})).tolist() == [8, 7]
    with pytest.raises(Missing, match="measured no other method than mine"):
        differences(results, claim(first=side, second={"method": Pick(("absent",))}))


def test_the_best_of_several_rivals_contradicts_only_where_one_would_beyond_their_number(values):
    differences = [0.1, 0.3, 0.3, 0.1, 0.0, 0.3]
    columns = {"item": [f"o{k}" for k in range(6)] * 4, "method": np.repeat(["ours", "a", "b", "c"], 6)}
    rows = values(**columns, value=[0.0] * 6 + differences + [-1.0] * 12)
    sides = {"first": {"method": "ours"}, "second": {"method": "a"}}
    picked = sides | {"second": {"method": Pick(("a", "b", "c"))}}
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
    gains = claim(first={"method": "mine"}, second={"method": Pick(lowest=True)},
                  contrast=({"target": "late"}, {"target": "early"}))  # fmt: skip
    results = values(**columns, value=np.repeat(list(levels.values()), 2))
    assert differences(results, gains).tolist() == [8, 8]  # over high, which gains nothing; low gains one


def test_one_side_may_count_by_its_mean_or_be_of_another_set(measured, values):
    columns = {"item": ["a", "b", None, None], "method": ["own", "own", "all", "all"], "value": [3, 4, 1, 2]}
    sides = {"first": {"method": "own"}, "second": {"method": "all"}, "mean_of": "second"}
    results = values(fold=[0, 1, 2, 3], **columns)
    assert differences(results, claim(**sides, over=("fold",))).tolist() == [1.5, 2.5]
    rows = {"dataset": ["test"] * 2 + ["other"] * 2, "item": list("abab"), "value": [3, 4, 7, 9]}
    elsewhere = claim(first={"dataset": "other"}, second={"dataset": "test"})
    assert differences(values(**rows), elsewhere).to_dict() == {"a": 4, "b": 5}


def test_equal_differences_are_open_and_say_why(values):
    results = values(item=list("abc"), value=[6.67, 6.67, 6.67])
    table = judge([claim(second=0.0)], results)
    assert table["verdict"].tolist() == ["open"]
    assert table["tested_on"][0].endswith("; no interval: all 3 differences are equal")
    assert effect(table.iloc[0]) == "+6.67 units"


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
    return judge([claim(second=0.0, sets=sets, **{"section": "ours"} | fields)], results).iloc[0]


def test_sets_that_say_the_same_are_pooled_and_decide_what_none_decides_alone(sets_of_rows):
    results = sets_of_rows(one=spread_about(0.5), two=spread_about(0.5, 1), more=spread_about(0.5, 2))
    alone = judge([claim(second=0.0, sets=("one",))], results).iloc[0]
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
    assert row["verdict"] == word


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
    entry = claim(second=0.0, where={"way": "a"}, readings=(Reading("the other way", {"where": {"way": "b"}}),
                                                          Reading("absent", {"where": {"way": "c"}})))  # fmt: skip
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


def test_copies_of_a_shape_count_once(values):
    names = ["cubesmall", "cubemedium", "cubelarge", "mug", "cup"]
    row = judge([claim(second=0.0)], values(item=names, value=[1, 1, 1, 3, 5])).iloc[0]
    assert row["effect"] == 3 and (row["pairs"], row["units"]) == (5, 3)
    assert over_text(row) == "5 objects, 3 units"


@pytest.mark.slow
def test_every_verdict_can_be_recomputed_from_the_differences(root, small):
    rows = {"dataset": "test", "item": list("abc"), "value": [0.1234567891, 0.2, -0.01]}
    small.write_measurements(root, "test", pd.DataFrame(rows))
    reports = small.read_results(root).reports
    table, pairs = judged([*load(), claim(second=0)], Measurements(reports))
    write_claims(table, pairs, root / "reports")
    claims = pd.read_csv(root / "reports/claims.csv")
    stored = pd.read_csv(root / "reports/claims/differences.csv.gz", dtype={"pair": str})
    by_key = {key: part["difference"] for key, part in stored[stored["judged"]].groupby("key", sort=False)}
    assert set(by_key) == set(claims.loc[claims["pairs"] > 0, "key"]) == {"one"}
    for row in claims[claims["pairs"] > 0].itertuples():
        mean, low, high = interval(by_key[row.key], row.shared)
        assert len(by_key[row.key]) == row.pairs and verdict(low, high, row.unit) == row.verdict
        assert (mean, low, high) == pytest.approx((row.effect, row.low, row.high), rel=1e-5, nan_ok=True)


def test_a_reading_in_the_place_of_the_claim_shows_all_its_sets(sets_of_rows):
    results = sets_of_rows(one=spread_about(2.0), two=spread_about(3.0))
    row = pooled(results, "absent", section="T9", readings=(Reading("elsewhere", {"sets": ("one", "two")}),))
    assert row["units"] == 24 and row["effect"] == pytest.approx(2.5, abs=1e-3)
    assert row["by_set"].startswith("one +2") and "; two +3" in row["by_set"]
    assert row["tested_on"].endswith("in the reading elsewhere, since as written it was not run")


def test_chance_calls_as_many_verdicts_as_is_said():
    noise = np.random.default_rng(0).normal(size=(800, 20))
    words = [verdict(*interval(values)[1:]) for values in noise]
    assert 5 < words.count("supported") < 40 and 5 < words.count("contradicted") < 40  # 20 of each: 2.5 % either way
    p_values = [p_value(values) if word != "open" else 0.5 for values, word in zip(noise, words, strict=True)]
    frame = pd.DataFrame({"section": "T9", "p": p_values, "verdict": words})
    assert (holding(frame) == "yes").sum() <= 2  # not one of them is an effect

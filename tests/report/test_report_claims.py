"""Claims: the entries of conf/claims, words from intervals, size beside the printed effect, readings and caveats."""

import numpy as np
import pandas as pd
import pytest

from stages.engine.measurements import Measurements
from stages.engine.settings import conf_folder
from stages.engine.statistics import interval, p_value
from stages.report.claims import Claim, ClaimError, Pick, Reading, load
from stages.report.claims_page import claims_text, counted, effect
from stages.report.statistics import STATISTICS
from stages.report.verdict import differing, judge, judgement, size, verdict

ROOT = conf_folder().parent
NOT_AT_HAND = "recorded_frozen_over_guessing_vitac"


@pytest.mark.slow
def test_every_entry_and_reading_names_rows_that_are_measured():
    claims, measurements = load(), Measurements(ROOT / "reports")
    assert len({claim.key for claim in claims}) == len(claims) <= 185
    assert 140 <= sum(claim.section != "ours" for claim in claims) <= 160
    for claim in claims:
        assert claim.statistic in STATISTICS and len(claim.sentence.split()) <= 25, claim.key
        for variant in (claim, *(reading.of(claim) for reading in claim.readings)):
            if claim.key != NOT_AT_HAND:
                assert judgement(variant, measurements).effects, claim.key


ENTRY = """\
readings:
  at night: {where: {light: 0}}
defaults:
  lod: {sets: [household], over: [item], unit: mm}
claims:
  - key: one
    section: T3.1
    sentence: Sentence.
    printed: 1.5 mm, table 3.2
    stage: lod
    where: {metric: error, target: ['1500', '3000']}
    first: {method: {lowest: [a, b], but: [c]}}
    second: 0.5
    shared: {household: 1/3}
    readings: [at night, {name: far, scale: 2}]
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
    assert entry.sets == ("household",) and entry.over == ("item",) and entry.printed_effect == 1.5
    assert entry.where["target"] == ("1500", "3000") and entry.first["method"] == Pick(("a", "b"), True, ("c",))
    assert entry.share("household") == 1 / 3 and entry.place.endswith("chapter_3.yaml:6 (one)")
    night, far = entry.readings
    assert night.of(entry).where == {**entry.where, "light": 0} and far.of(entry).scale == 2
    assert far.of(entry).readings == () and entry.files() == [("lod", "household")]


@pytest.mark.parametrize(("old", "new", "message"), [
    ("    second:", "    secnd:", r"chapter_3.yaml:6 \(one\): secnd is unknown, perhaps second"),
    ("[at night,", "[at nigth,", r":6 \(one\): at nigth is unknown, perhaps at night"),
    ("sets: [household]", "sets: [houshold]", r":6 \(one\): set houshold is not in conf/data"),
    ("stage: lod", "stage: lods", r":6 \(one\): no sets"),
    ("section: T3.1", "section: chapter", r":6 \(one\): section chapter is neither"),
    ("lowest:", "last:", r":6 \(one\), method: last is unknown, perhaps lowest"),
    ("    sentence: Sentence.\n", "", r":6 \(one\): no sentence"),
    ("1.5 mm, table", "1.5, table", r":6 \(one\): printed is `1.5, table 3.2`; write the number with the unit .*`mm`"),
    ("1.5 mm, table", "1.5 points, table", r":6 \(one\): printed is `1.5 points, table 3.2`"),
    ("claims:", "claim:", "no list `claims`"), ("claims:", "claims: [", "chapter_3.yaml: while parsing"),
])  # fmt: skip
def test_an_entry_that_is_wrong_is_named_with_its_line(written, old, new, message):
    with pytest.raises(ClaimError, match=message):
        written(ENTRY.replace(old, new))


@pytest.mark.parametrize(("low", "high", "fields", "word"), [
    (0.1, 2.9, {"unit": "points"}, "supported"), (-0.3, -0.1, {}, "contradicted"), (-0.1, 0.3, {}, "open"),
    (0, 1, {}, "open"), (-1, 0, {}, "open"), (np.nan, np.nan, {}, "open"),
    (-2.9, 2.9, {"unit": "points"}, "no difference"), (-3.1, 2.9, {"unit": "points"}, "open"),
    (-0.04, 0.04, {"unit": "NSS"}, "no difference"), (-0.04, 0.04, {"unit": "PCC"}, "open"),
    (-1.9, 0.5, {"margin": 2}, "supported"), (-2.1, 0.5, {"margin": 2}, "open"),
    (-4, -2.1, {"margin": 2}, "contradicted"),
    (-1.9, 1.9, {"margin": 2, "same": True}, "supported"), (-1.9, 2.1, {"margin": 2, "same": True}, "open"),
    (2.1, 3, {"margin": 2, "same": True}, "contradicted"), (-3, -2.1, {"margin": 2, "same": True}, "contradicted"),
])  # fmt: skip
def test_word_follows_from_the_interval_the_margin_and_what_matters_in_its_unit(low, high, fields, word):
    assert verdict(low, high, **fields) == word


@pytest.mark.parametrize(("printed", "numbers", "word"), [
    (None, (1, 0, 2), ""), (15.68, (15, 12, 18), "as printed"), (15.68, (-0.6, -3.4, 2.8), "smaller"),
    (15.68, (20, 16, 24), "larger"), (15.68, (-5, -7, -3), "opposite"), (-14, (-24, -27, -21), "larger"),
    (-14, (-10, -12, -8), "smaller"), (-14, (3, 1, 5), "opposite"), (0, (3, 1, 5), "larger"),
    (-14, (-13, -16, -12), "as printed"), (0, (0, -1, 1), "as printed"),
    (1.4284, (1.4295, np.nan, np.nan), "as printed"), (1.4284, (1.42, np.nan, np.nan), "smaller"),
])  # fmt: skip
def test_the_size_says_how_the_interval_lies_beside_the_printed_effect(printed, numbers, word):
    assert size(printed, *numbers) == word


def claim(**fields):
    """A claim on the rows of `values`, one pair per item."""
    return Claim(**{"key": "one", "section": "T9", "sentence": "Sentence.", "stage": "test", "sets": ("test",),
                    "where": {}, "first": {}, "over": ("item",), "scale": 1.0, "unit": "units"} | fields)  # fmt: skip


@pytest.fixture
def values(measured):
    """A function of columns to the rows of the stage `test` that have these."""
    return lambda **columns: measured("test", pd.DataFrame({"dataset": "test", "metric": "error"} | columns))


@pytest.fixture
def sets_of_rows(measured):
    """A function of sets and their differences from zero, one an item, to the rows of the stage `test` with these."""

    def write(**differences):
        rows = [(name, "error", f"{name}{k}", value) for name, numbers in differences.items()
                for k, value in enumerate(numbers)]  # fmt: skip
        return measured("test", pd.DataFrame(rows, columns=["dataset", "metric", "item", "value"]))

    return write


def spread_about(mean, seed=0, count=12):
    """Values of this mean and of a standard deviation of one."""
    numbers = np.random.default_rng(seed).normal(size=count)
    return mean + (numbers - numbers.mean()) / numbers.std(ddof=1)


def judged(results, *sets, **fields):
    """The row of a claim on these sets."""
    return judge([claim(second=0.0, **({"sets": sets} if sets else {}) | fields)], results).iloc[0]


def test_the_row_has_the_effect_before_the_margin_and_its_size(values):
    results = values(item=[*range(12)], value=spread_about(2.0))
    row = judged(results, margin=-3, printed="5 units, T9.1")
    assert row["verdict"] == "contradicted" and row["effect"] == pytest.approx(2.0) and row["size"] == "smaller"
    assert (row["pairs"], row["units"], row["over"]) == (12, 12, "objects") and np.isnan(row["p"])
    low, high = interval(pd.Series(spread_about(2.0)))[1:]
    assert (row["low"], row["high"]) == pytest.approx((low, high), rel=1e-4)


def test_a_single_number_has_no_interval_and_is_decided_by_itself(values):
    results = values(item=list("abc"), value=[1.4295, 1.4295, 1.4295])
    row = judged(results, over=(), margin=-1.4284, printed="1.4284 units, T5.5")
    assert row["verdict"] == "supported" and np.isnan(row["low"]) and row["size"] == "as printed" and not row["caveat"]
    assert judged(results, over=(), margin=-1.43)["verdict"] == "contradicted"
    assert effect(row) == "+1.4 units"


def test_readings_with_another_word_are_told_and_do_not_change_the_verdict(values):
    numbers = [*spread_about(2.0), *spread_about(-2.0)]
    results = values(item=[*range(12)] * 2, way=["a"] * 12 + ["b"] * 12, value=numbers)
    readings = [Reading(name, {"where": {"way": way}}) for name, way in (("other", "b"), ("same", "a"), ("none", "c"))]
    row = judged(results, where={"way": "a"}, readings=tuple(readings))
    assert row["verdict"] == "supported" and row["readings"] == "contradicted: other"
    words = {"a": "open", "b": "contradicted", "c": "open", "d": "not testable", "e": "supported"}
    assert differing("supported", words) == "open: a / c; contradicted: b"


def test_what_the_printed_run_does_not_tell_is_not_testable_and_keeps_its_numbers(values):
    row = judged(values(item=[*range(12)], value=spread_about(2.0)), says_nothing="one answer", caveat="small")
    assert row["verdict"] == "not testable" and row["effect"] == pytest.approx(2.0)
    assert row["caveat"] == "one answer; small"


def test_rows_that_are_absent_leave_a_claim_open_and_say_so(values):
    row = judged(values(item=["a"], value=[1.0]), where={"way": "b"})
    assert (row["verdict"], row["pairs"], row["size"]) == ("open", 0, "")
    assert row["caveat"] == "not run: no column way in the rows of test on test"
    row = judged(values(item=list("abc"), value=[6.67] * 3))
    assert row["verdict"] == "open" and row["caveat"] == "no interval: fewer than two units, or all equal"


def test_the_best_of_several_rivals_contradicts_only_where_one_would_beyond_their_number(values):
    differences = [0.1, 0.3, 0.3, 0.1, 0.0, 0.3]
    columns = {"item": [f"o{k}" for k in range(6)] * 4, "method": np.repeat(["ours", "a", "b", "c"], 6)}
    rows = values(**columns, value=[0.0] * 6 + differences + [-1.0] * 12)
    sides = {"first": {"method": "ours"}, "second": {"method": "a"}}
    picked = sides | {"second": {"method": Pick(("a", "b", "c"))}}
    one, best = (judge([claim(**fields)], rows).iloc[0] for fields in (sides, picked))
    assert (one["verdict"], best["verdict"]) == ("contradicted", "open") and one["p"] == best["p"] > 0.05 / 3


def test_sets_that_say_the_same_are_pooled_and_decide_what_none_decides_alone(sets_of_rows):
    results = sets_of_rows(one=spread_about(0.5), two=spread_about(0.5, 1), more=spread_about(0.5, 2))
    assert judged(results, "one")["verdict"] == "open"
    row = judged(results, "one", "two", "more", "absent")
    assert row["verdict"] == "supported" and row["effect"] == pytest.approx(0.5, abs=1e-3) and row["units"] == 36
    assert row["sets"] == "one, two, more" and row["caveat"] == "not measured on absent"


@pytest.mark.parametrize(("first", "second", "word", "told"), [
    (2.0, -1.0, "open", True), (2.0, -0.1, "open", True), (2.0, 1.5, "supported", False), (0.2, -0.1, "open", False),
])  # fmt: skip
def test_sets_of_both_signs_that_differ_beyond_chance_are_a_caveat(sets_of_rows, first, second, word, told):
    row = judged(sets_of_rows(one=spread_about(first), two=spread_about(second)), "one", "two")
    assert row["verdict"] == word and ("the sets disagree: one 2" in row["caveat"]) == told


def test_a_set_of_two_units_or_without_an_interval_does_not_rule_the_mean_of_several(sets_of_rows):
    rows = {"one": spread_about(0.4), "two": np.array([3.0, 3.01]), "flat": np.full(5, 3.0)}
    row = judged(sets_of_rows(**rows), "one", "two", "flat")
    assert row["verdict"] == "open" and row["units"] == 12 and row["effect"] == pytest.approx(0.4, abs=1e-3)
    small = sets_of_rows(two=rows["two"], more=rows["two"] + 1)
    assert judged(small, "two", "more")["units"] == 4  # where all sets are so small


def test_copies_of_a_shape_count_once(values):
    row = judged(values(item=["cubesmall", "cubemedium", "cubelarge", "mug", "cup"], value=[1, 1, 1, 3, 5]))
    assert row["effect"] == 3 and (row["pairs"], row["units"]) == (5, 3)


def test_chance_decides_as_many_claims_as_is_said_and_a_caveat_marks_them(values):
    noise = np.random.default_rng(0).normal(size=(800, 20))
    words = [verdict(*interval(numbers)[1:]) for numbers in noise]
    assert 5 < words.count("supported") < 40 and 5 < words.count("contradicted") < 40  # 20 of each: 2.5 % either way
    weak = next(numbers for numbers in noise if verdict(*interval(numbers)[1:]) == "supported")
    assert p_value(weak) > 0.002
    rows = {"item": [*range(20)] * 41, "way": np.repeat(np.arange(41), 20)}
    frame = values(**rows, value=np.concatenate([weak, *noise[:40]]))
    table = judge([claim(key=str(k), second=0.0, where={"way": k}) for k in range(41)], frame)
    assert table["verdict"][0] == "supported" and table["caveat"][0] == "one of many tests"
    assert judge([claim(second=0.0, where={"way": 0})], frame)["caveat"][0] == ""


def test_verdicts_and_sizes_are_counted_and_listed_by_chapter():
    frame = pd.DataFrame({
        "section": ["T3.1", "T3.2", "T6.3", "ours"], "claim": "Sentence.", "readings": "", "caveat": "", "unit": "mm",
        "verdict": ["supported", "open", "open", "contradicted"], "size": ["smaller", "as printed", "", ""],
        "printed": "", "effect": [1.234, 120.4, np.nan, -0.0004], "low": [0.5, 110, np.nan, -0.0006],
        "high": [2.0, 130, np.nan, -0.0002], "key": list("abcd"),
    })  # fmt: skip
    assert counted(frame) == (
        "Sentences of the thesis (3): 1 supported, 2 open. Sentences of the project (1): 1 contradicted. Effects with "
        "a printed number (2): 1 as printed, 1 smaller."
    )
    shown = ["+1.2 [0.5, 2.0] mm", "+120 [110, 130] mm", "–", "-0.0004 [-0.0006, -0.0002] mm"]
    assert [effect(row) for row in frame.itertuples()] == shown
    text = claims_text(frame)
    assert text.count("## ") == 3 and "| Sentence. (T3.1) | supported | +1.2 [0.5, 2.0] mm |" in text

"""Claims: pairing, intervals, and the one word."""

import numpy as np
import pandas as pd
import pytest

from stages.report import CLAIMS, Claim, judge, tables, tradeoff, verdict
from stages.report.intervals import HOLD_OUT, interval
from stages.report.items import build_all
from stages.report.page import effect
from stages.report.results import NotRun, Results
from stages.report.verdict import COLUMNS, counted, paired


def judged(results, key):
    return judge([claim for claim in CLAIMS if claim.key == key], results).iloc[0]


@pytest.mark.parametrize(
    ("low", "high", "word"),
    [(0.1, 0.3, "supported"), (-0.3, -0.1, "contradicted"), (-0.1, 0.3, "open"), (0, 1, "open"), (-1, 0, "open")],
)
def test_word_follows_from_the_interval_alone(low, high, word):
    assert verdict(low, high) == word


def test_no_interval_is_open():
    assert verdict(np.nan, np.nan) == "open"


def test_clear_effect_is_supported(results):
    row = judged(results, "enhanced_over_itti")
    assert row["verdict"] == "supported"
    assert row["effect"] == pytest.approx(30, abs=2)
    assert row["pairs"] == 6


def test_reversed_effect_is_contradicted(root, small):
    small.write(root, "classification", small.classification(enhanced=0.4, rivals=0.7))
    assert judged(Results(small.settings(), root), "enhanced_over_itti")["verdict"] == "contradicted"


def test_no_effect_is_open(results):
    assert judged(results, "itti_over_blind")["verdict"] == "open"


def test_unmeasured_claim_is_open_and_names_the_stage(results):
    row = judged(results, "tuned_over_frozen_random")
    assert row["verdict"] == "open"
    assert "dvc repro transfer" in row["tested_on"]


def test_errors_are_compared_in_pairs_and_relative_to_their_size(results):
    row = judged(results, "keep_metro")
    assert row["effect"] == pytest.approx(100 * (1 - 2) / 1.5)
    assert row["pairs"] == 2


def test_more_faces_claim_takes_fewest_minus_most(root, small):
    frame = Results(small.settings(), root).measurements("lod").copy()
    frame.loc[frame["target"] == "25%", "faces"] = 50
    small.write(root, "lod", frame[frame["object"] == "ball"])
    assert judged(Results(small.settings(), root), "more_faces")["effect"] == pytest.approx(100 * (0.06 - 0.02))


def test_beyond_chance_takes_guessing_off(root, small):
    frame = small.classification()
    frame = frame.assign(value=frame["object"].map({"six": 1 / 6, "four": 1 / 4}))
    small.write(root, "classification", frame)
    results = Results(small.settings(), root)
    assert judged(results, "four_easier")["effect"] == pytest.approx(100 * (1 / 4 - 1 / 6), rel=1e-3)
    assert judged(results, "four_easier_beyond_chance")["effect"] == pytest.approx(0, abs=1e-3)


def test_pairs_match_by_repetition_not_by_row(results, small):
    frame = results.measurements("classification").iloc[::-1]
    small.write(results.data.parent, "classification", frame)
    again = Results(small.settings(), results.data.parent)
    sides = {"first": {"method": "enhanced"}, "second": {"method": "itti"}}
    where = {"object": "six", "classifier": "knn"}
    before = paired(results, "classification", ["repetition"], **sides, **where)
    after = paired(again, "classification", ["repetition"], **sides, **where)
    assert np.allclose(before.sort_index(), after.sort_index())


def test_side_that_was_not_measured_is_not_run(results):
    with pytest.raises(NotRun, match="heat_kernel"):
        paired(results, "classification", ["repetition"], {"method": "heat_kernel"}, {"method": "itti"})


def test_every_claim_has_its_own_key_and_answers_without_measurements(bare, small):
    table = judge(CLAIMS, Results(small.settings(), bare))
    assert table["key"].is_unique
    assert set(table["verdict"]) == {"open"}


def test_interval_covers_as_often_as_it_says():
    rng = np.random.default_rng(0)
    for count in (4, 15):
        found = [interval(rng.normal(size=count)) for _ in range(400)]
        assert np.mean([low < 0 < high for _, low, high in found]) > 0.91


def test_splitting_the_same_data_more_often_does_not_shrink_the_interval_to_nothing():
    values = np.random.default_rng(0).normal(size=4000)
    width = {n: np.subtract(*interval(values[:n], HOLD_OUT)[:0:-1]) for n in (100, 4000)}
    assert width[4000] > 0.8 * width[100]
    independent = np.subtract(*interval(values)[:0:-1])
    assert independent < 0.1 * width[4000]


def test_one_value_has_no_interval():
    mean, low, high = interval([0.5])
    assert mean == 0.5
    assert np.isnan([low, high]).all()


def test_equal_values_have_no_interval():
    mean, low, high = interval([0.066667, 0.066666, 0.066667])  # equal but for the six digits of the measurements
    assert mean == pytest.approx(0.0666667, abs=1e-6)
    assert np.isnan([low, high]).all()
    assert np.isfinite(interval([0.066, 0.067, 0.068])).all()


def test_equal_differences_are_open_and_say_why(results):
    claim = Claim("equal", "T9", "Sentence.", "what", "unit", "repetitions", lambda _: np.array([6.67, 6.67, 6.67]))
    table = judge([claim], results)
    assert table["verdict"].tolist() == ["open"]
    assert table["tested_on"][0] == "what; no interval: all 3 differences are equal"
    assert effect(table.iloc[0]) == "+6.67 unit"


def test_tested_on_tells_the_objects_that_the_set_held(root, results, small):
    assert judged(results, "enhanced_over_itti")["tested_on"] == "kNN, six objects, enhanced minus itti"
    small.write_set(root, "six", 4)
    assert judged(results, "enhanced_over_itti")["tested_on"] == "kNN, 4 objects (set six), enhanced minus itti"


def test_chance_follows_the_objects_that_the_set_held(root, small):
    frame = small.classification()
    small.write(root, "classification", frame.assign(value=frame["object"].map({"six": 1 / 3, "four": 1 / 4})))
    small.write_set(root, "six", 3)
    row = judged(Results(small.settings(), root), "four_easier_beyond_chance")
    assert row["effect"] == pytest.approx(0, abs=1e-3)


def test_set_that_was_left_out_hands_on_its_note(root, small):
    small.write(root, "classification", small.left_out(small.classification(), "six: no duck", object="six"))
    results = Results(small.settings(), root)
    for key in ("enhanced_over_itti", "enhanced_over_blind_all", "knn_best", "four_easier"):
        assert judged(results, key)["tested_on"] == "not run: six: no duck"
    assert judged(results, "enhanced_over_blind_four")["verdict"] == "supported"


def test_sampling_or_classifier_that_was_left_out_hands_on_its_note(root, small):
    frame = small.left_out(small.classification(), "too few touches", object="six", method="thesis_ssim")
    failed = {"object": "six", "method": "random", "classifier": "knn", "metric": "accuracy_holdout"}
    small.write(root, "classification", small.left_out(frame, "knn failed: why", **failed))
    results = Results(small.settings(), root)
    assert judged(results, "enhanced_over_itti")["tested_on"] == "not run: too few touches"
    assert judged(results, "itti_over_blind")["tested_on"] == "not run: knn failed: why"


def test_absent_set_is_called_a_set(root, small):
    frame = small.classification()
    small.write(root, "classification", frame[frame["object"] == "four"])
    assert judged(Results(small.settings(), root), "knn_best")["tested_on"].startswith("not run: set six is not among")


def test_transfer_that_was_left_out_hands_on_its_note(root, small):
    small.write(root, "transfer", pd.DataFrame([{"dataset": "test", "object": "six", "value": None, "note": "no cup"}]))
    results = Results(small.settings(), root)
    assert judged(results, "tuned_over_frozen_random")["tested_on"] == "not run: no cup"
    assert judged(results, "frozen_over_chance_random")["tested_on"] == "not run: no cup"
    assert build_all(tables, results).not_run["table_5_4"] == "no cup"
    assert build_all(tradeoff, results).not_run["networks"] == "no cup"


def test_verdicts_are_counted_beside_what_chance_alone_would_give():
    words = ["supported"] * 30 + ["contradicted"] * 10 + ["open"] * 50
    lows = [0.0] * 80 + [np.nan] * 10  # ten are open for want of an interval
    said = counted(pd.DataFrame({"verdict": words, "low": lows}, columns=COLUMNS))
    assert said.startswith("90 verdicts: 30 supported, 10 contradicted, 50 open.")
    assert "any of the 80 that have an interval, chance alone would call about 2 of them supported" in said


def test_chance_calls_as_many_verdicts_as_is_said():
    rng = np.random.default_rng(0)
    claims = [
        Claim(str(k), "T9", "Sentence.", "what", "unit", "objects", lambda _: rng.normal(size=20)) for k in range(800)
    ]
    words = judge(claims, None)["verdict"].value_counts()
    assert 5 < words["supported"] < 40 and 5 < words["contradicted"] < 40  # 20 of each are said


def test_rows_put_in_place_of_a_stage_s_leave_the_others_and_the_run_alone(results):
    frame = results.measurements("lod")
    other = results.instead("lod", frame.assign(value=7.0))
    assert set(other.measurements("lod")["value"]) == {7.0} and set(results.measurements("lod")["value"]) != {7.0}
    assert other.measurements("classification").equals(results.measurements("classification"))


def test_a_new_claim_is_one_entry(results):
    claim = Claim("new", "T9", "Sentence.", "what", "unit", "objects", lambda _: np.array([1.0, 1.1, 0.9, 1.0, 1.05]))
    assert judge([claim], results)["verdict"].tolist() == ["supported"]

"""Networks on recorded touches in the report: gains, guesses and claims on trainings whose truth is known."""

from itertools import product

import numpy as np
import pandas as pd
import pytest

from haptic_glance.know.split import shared_by
from stages.engine.statistics import interval
from stages.report import recorded as topic
from stages.report.recorded.claims import NETWORKS as CLAIMS
from stages.report.recorded.claims import SETTINGS
from stages.report.results import NotRun
from stages.report.topics import build_one
from stages.report.verdict import judge

LEVELS = {  # (network, weights, mode) -> accuracy; the gain of each way is exact, the splits differ by far more
    ("mobilenet_v2", "imagenet", "frozen"): 0.7,
    ("mobilenet_v2", "imagenet", "finetuned"): 0.8,
    ("mobilenet_v2", "random", "frozen"): 0.3,
    ("mobilenet_v2", "random", "finetuned"): 0.5,
    ("alexnet", "imagenet", "frozen"): 0.65,
    ("alexnet", "random", "frozen"): 0.5,
    ("resnet50", "imagenet", "frozen"): 0.75,
    ("resnet50", "random", "frozen"): 0.3,
}
FEATURES, CHANCE, MAJORITY = 0.6, 0.1, 0.2
COLUMNS = [
    "dataset",
    "data",
    "item",
    "method",
    "weights",
    "pretrained",
    "mode",
    "size",
    "split",
    "repetition",
    "metric",
    "value",
]
DATASETS = {"pressure": "pressure_images", "grasps_object": "biotac_grasps", "grasps_slip": "biotac_grasps"}
DATASETS |= dict.fromkeys(("schunk", "schunk_coarse"), "schunk")
PIXELS = {"frozen": 96, "finetuned": 64}
OBJECTS = ("cup", "hat", "pan", "shoe")


def touches(levels=LEVELS, repetitions=4):
    """Trainings in all settings: hard and easy splits, but the same gains in each, to within a thousandth."""
    random, rows = np.random.default_rng(0), []
    for data, split in SETTINGS.values():
        for (network, weights, mode), level in levels.items():
            way = {"method": network, "weights": weights, "mode": mode, "size": PIXELS[mode]}
            way |= {"pretrained": "complete" if weights == "imagenet" else "none"}
            rows += _trained({"data": data, "split": split} | way, level, random, repetitions)
        rows += _trained({"data": data, "split": split, "method": "features_knn"}, FEATURES, random, repetitions + 3)
    return pd.DataFrame(rows, columns=COLUMNS)


def _trained(said, level, random, repetitions):
    """Rows of one way; a later repetition is a harder split, and a later object a harder one."""
    kept = OBJECTS if said["split"] == "test_objects" else ()
    for number in range(repetitions):
        common = said | {"repetition": number, "dataset": DATASETS[said["data"]]}
        yield common | {"metric": "accuracy", "value": level - 0.05 * number + 0.001 * random.normal()}
        if "mode" in said:
            yield common | {"metric": "chance", "value": CHANCE}
            yield common | {"metric": "majority", "value": MAJORITY}
            yield common | {"metric": "train_accuracy", "value": 1.0}
        for k, name in enumerate(kept):
            value = level - 0.1 * k + 0.001 * random.normal()
            yield common | {"item": name, "metric": "accuracy", "value": value}
            if "mode" in said:
                yield common | {"item": name, "metric": "train_accuracy", "value": 1.0}


def majority():
    """Rows of the recorded grasps: what the commonest answer gets right, of each object kept for the test."""
    said = {"task": "slip", "split": "test_objects", "palm": "all", "scaled": "training", "metric": "accuracy"}
    rows = [said | {"classifier": "majority", "item": name, "value": 0.4 - 0.1 * k} for k, name in enumerate(OBJECTS)]
    others = [{"palm": "side"}, {"task": "recognition"}, {"scaled": "own"}, {"classifier": "knn"}]
    return pd.DataFrame([*rows, *(rows[0] | other | {"value": 1.0} for other in others)])


@pytest.fixture
def measured(bare, small):
    """frame -> the Results of a root with these trainings, and with what guessing gets right of grasps."""

    def write(frame):
        small.write(bare, "recorded_networks", frame)
        small.write(bare, "recorded", majority(), "biotac_grasps")
        return small.results(bare)

    return write


def only(frame, **where):
    """The one row of a frame."""
    for column, value in where.items():
        frame = frame[frame[column] == value]
    assert len(frame) == 1
    return frame.iloc[0]


def real_networks(results):
    return build_one(topic, "tables", "real_networks", results)


def line(results, data="pressure", split="random", method="mobilenet_v2", weights="imagenet", mode="frozen"):
    frame = real_networks(results).frame
    return only(frame, data=data, split=split, method=method, weights=weights, mode=mode)


@pytest.mark.slow
@pytest.mark.parametrize(("data", "split"), SETTINGS.values())
def test_gains_are_paired_so_that_hard_splits_and_objects_cancel(measured, data, split):
    found = line(measured(touches()), data, split)
    assert found["over_features"] == pytest.approx(0.1, abs=0.003)
    assert found["over_random"] == pytest.approx(0.4, abs=0.003)
    assert found["over_random_low"] > 0.39 and found["over_random_high"] < 0.41
    assert found["high"] - found["low"] > 0.1  # the accuracies themselves differ from split to split


def test_gains_run_over_the_splits_that_both_have(measured):
    frame = touches()
    short = (frame["weights"] == "random") & (frame["repetition"] > 1)
    found = line(measured(frame[~short]))
    assert (found["values"], found["over_features_pairs"], found["over_random_pairs"]) == (4, 4, 2)
    assert found["over_random"] == pytest.approx(0.4, abs=0.003)


def test_objects_kept_for_the_test_are_the_pairs(measured):
    found = line(measured(touches(repetitions=2)), "grasps_slip", "test_objects")
    assert found["values"] == found["over_features_pairs"] == len(OBJECTS)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("data", "split", "unit", "shared"),
    [("pressure", "random", "repetition", shared_by("random")), ("grasps_slip", "test_objects", "item", 0.0)],
)
def test_intervals_are_widened_for_repeated_splits_and_not_for_objects(measured, data, split, unit, shared):
    frame = touches()
    mine = frame[(frame["data"] == data) & (frame["split"] == split) & (frame["method"] == "features_knn")]
    mine = mine[mine["item"].notna() == (unit == "item")]
    mean, low, high = interval(mine.groupby(unit)["value"].mean(), shared)
    found = line(measured(frame), data, split, "features_knn", "", "")
    assert (found["accuracy"], found["low"], found["high"]) == pytest.approx((mean, low, high))


@pytest.mark.slow
def test_a_network_is_compared_at_its_own_size_and_mode(measured):
    frame = touches()
    mine = frame[(frame["method"] == "mobilenet_v2") & (frame["mode"] == "frozen") & (frame["weights"] == "imagenet")]
    larger = mine.assign(size=224, value=mine["value"] + 0.1)
    made = real_networks(measured(pd.concat([frame, larger])))
    shown = only(made.shown, data="pressure array, 22 objects", split="touches at random", filters="frozen, 224 px")
    assert shown["over random weights"] == "–" and shown["over features and kNN"].startswith("+20")
    assert line(measured(frame), mode="finetuned")["over_random"] == pytest.approx(0.3, abs=0.003)


def test_guessing_is_what_is_right_more_often(measured):
    frame = touches()
    assert line(measured(frame))["guess"] == MAJORITY
    frame.loc[frame["metric"] == "chance", "value"] = 0.3
    assert line(measured(frame))["guess"] == 0.3


def test_guessing_of_kept_objects_is_of_each_object(measured):
    found = line(measured(touches()), "grasps_slip", "test_objects")
    assert found["guess"] == pytest.approx(0.25)


def test_classical_features_lead_each_split_and_have_no_gains(measured):
    shown = real_networks(measured(touches())).shown
    first = shown.drop_duplicates(["data", "split"])
    assert set(first["network"]) == {"features and kNN"} and len(first) == len(SETTINGS)
    assert set(first["over features and kNN"]) == set(first["over random weights"]) == {"–"}
    assert set(first["guessing, %"]) == {"20.0", "25.0"}


def test_a_table_of_classical_features_alone_has_no_guesses(measured):
    frame = touches(levels={})
    shown = real_networks(measured(frame[frame["data"] == "pressure"])).shown
    assert list(shown["guessing, %"]) == ["–", "–"] and list(shown["starts from"]) == ["–", "–"]


def test_untrained_networks_have_no_gain_over_themselves(measured):
    assert np.isnan(line(measured(touches()), weights="random")["over_random"])


def test_data_sets_that_are_not_at_hand_are_left_out(measured):
    absent = {
        "dataset": "vt60",
        "data": "vt60",
        "method": "alexnet",
        "weights": "imagenet",
        "mode": "frozen",
        "metric": "accuracy",
    }
    shown = real_networks(measured(pd.concat([touches(), pd.DataFrame([absent])]))).shown
    assert "VT-60 (BathTip)" not in set(shown["data"])


@pytest.mark.parametrize("build", [*topic.CHARTS.values(), topic.TABLES["real_networks"], topic.TABLES["table_5_1"]])
def test_without_accuracies_the_pieces_are_not_run(measured, build):
    frame = touches()
    with pytest.raises(NotRun, match="no accuracy|no measurements"):
        build(measured(frame.assign(value=np.nan)))


def verdicts(results, start=""):
    """The claims whose key starts so (behind `recorded_`), judged."""
    return judge([one for one in CLAIMS if one.key.startswith(f"recorded_{start}")], results).set_index("key")


WORDS = {
    "frozen_over_guessing": "supported",
    "frozen_by_guessing": "contradicted",
    "seen_over_random_frozen": "supported",
    "seen_over_random_tuned": "supported",
    "tuned_over_frozen": "supported",
    "resnet_best": "supported",
    "frozen_over_features": "supported",
}


@pytest.mark.slow
@pytest.mark.parametrize(("key", "word"), WORDS.items())
def test_claims_say_what_the_rows_hold_in_every_setting(measured, key, word):
    mine = verdicts(measured(touches()), key)
    assert len(mine) in (2, len(SETTINGS)) and set(mine["verdict"]) == {word}


@pytest.mark.slow
@pytest.mark.parametrize("key", WORDS)
def test_claims_turn_with_the_rows(measured, key):
    worse = {way: 1 - level for way, level in LEVELS.items()} | {("mobilenet_v2", "imagenet", "frozen"): 0.1}
    worse |= {("mobilenet_v2", "imagenet", "finetuned"): 0.05}
    judged = verdicts(measured(touches(worse)), key)
    turned = {"supported": "contradicted", "contradicted": "supported"}[WORDS[key]]
    assert judged.loc[f"recorded_{key}_pressure_random", "verdict"] == turned


@pytest.mark.slow
def test_effects_are_points_over_repetitions_or_objects(measured):
    judged = verdicts(measured(touches()))
    assert judged.loc["recorded_tuned_over_frozen_pressure_runs", "effect"] == pytest.approx(10, abs=0.3)
    assert judged.loc["recorded_resnet_best_pressure_runs", "effect"] == pytest.approx(5, abs=0.3)
    assert judged.loc["recorded_tuned_over_frozen_pressure_runs", "over"] == "repetitions"
    assert judged.loc["recorded_tuned_over_frozen_fingers_slip", "over"] == "objects"
    assert judged.loc["recorded_frozen_over_guessing_fingers_slip", "effect"] == pytest.approx(30, abs=0.3)


@pytest.mark.parametrize(("instant", "word"), [(0.1, "supported"), (0.6, "contradicted")])
def test_one_reading_is_held_against_guessing_and_against_the_series(measured, instant, word):
    said = {"method": "mobilenet_v2", "weights": "imagenet", "mode": "frozen", "size": 96, "pretrained": "complete"}
    rows, random = [], np.random.default_rng(0)
    for (data, level), split in product({"schunk": 0.4, "schunk_coarse": instant}.items(), ("random", "objects")):
        rows += _trained(said | {"data": data, "split": split}, level, random, 4)
    judged = verdicts(measured(pd.DataFrame(rows, columns=COLUMNS)))
    for split in ("random", "grasps"):
        assert judged.loc[f"recorded_instant_by_guessing_hand_{split}", "verdict"] == word
        found = judged.loc[f"recorded_series_over_instant_hand_{split}"]
        assert (found["verdict"], found["pairs"]) == (word, 4)
        assert found["effect"] == pytest.approx(100 * (0.4 - instant), abs=0.3)


def test_thesis_s_own_lead_over_guessing_is_the_bar(measured):
    judged = verdicts(measured(touches()), "frozen_by").loc["recorded_frozen_by_guessing_pressure_random"]
    assert judged["effect"] == pytest.approx(7.6 - 100 * (0.7 - 0.075 - MAJORITY), abs=0.3)


def test_claims_over_repeated_splits_alone_are_widened():
    shares = {(claim.pairs, claim.share) for claim in CLAIMS}
    assert shares == {("repetitions", shared_by("random")), ("objects", 0.0), ("networks", 0.0)}


def test_networks_are_the_pairs_where_all_of_them_are_asked(measured):
    judged = verdicts(measured(touches()), "seen").loc["recorded_seen_over_random_networks_pressure_random"]
    assert (judged["pairs"], judged["over"]) == (3, "networks")
    assert judged["effect"] == pytest.approx(100 * (0.4 + 0.15 + 0.45) / 3, abs=0.3)


def test_a_claim_names_the_training_that_it_lacks(measured):
    levels = {way: level for way, level in LEVELS.items() if way[2] == "frozen"}
    judged = verdicts(measured(touches(levels)))
    found = judged.loc["recorded_tuned_over_frozen_pressure_random"]
    assert found["verdict"] == "open"
    assert found["tested_on"] == "not run: mode finetuned is not among those that recorded_networks measured"
    assert judged.loc["recorded_frozen_over_features_pressure_random", "verdict"] == "supported"


def test_a_network_alone_is_not_the_best(measured):
    levels = {way: level for way, level in LEVELS.items() if way[0] == "resnet50"}
    found = verdicts(measured(touches(levels)), "resnet").loc["recorded_resnet_best_pressure_random"]
    assert found["verdict"] == "open" and "no other method than resnet50" in found["tested_on"]


def test_without_recorded_touches_all_claims_are_open_and_say_what_to_run(bare, small):
    path = bare / "params.yaml"
    path.write_text(path.read_text().replace("sets: [", "sets: [pressure_images, biotac_grasps, schunk, "))
    judged = verdicts(small.results(bare))
    assert set(judged["verdict"]) == {"open"} and judged["tested_on"].str.contains("dvc repro recorded_networks").all()


def test_every_claim_of_recorded_touches_is_in_the_report():
    from stages.report.topics import CLAIMS as ALL

    assert {claim.key for claim in CLAIMS} <= {claim.key for claim in ALL}

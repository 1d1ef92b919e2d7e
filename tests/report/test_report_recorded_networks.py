"""Networks on recorded touches in the report: gains, guesses and claims on trainings whose truth is known."""

from functools import partial
from itertools import product

import numpy as np
import pandas as pd
import pytest

from haptic_glance.know.split import shared_by
from stages.engine.statistics import interval
from stages.report import recorded as topic
from stages.report.parts import build_item
from stages.report.recorded.claims import NETWORKS as CLAIMS
from stages.report.recorded.claims import SETTINGS
from tests.report.frames import only, verdicts

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
COLUMNS = ["dataset", "data", "item", "method", "weights", "pretrained", "mode", "size", "split", "repetition",
           "passes", "metric", "value"]  # fmt: skip
DATASETS = {"pressure": "pressure_images", "grasps_object": "biotac_grasps", "grasps_slip": "biotac_grasps"}
DATASETS |= dict.fromkeys(("schunk", "schunk_coarse"), "schunk")
PIXELS = {"frozen": 96, "finetuned": 64}
OBJECTS = ("cup", "hat", "pan", "shoe")
PRESSURE = [("pressure", "random")]


def touches(levels=LEVELS, settings=None, repetitions=3):
    """Trainings in these settings, or all: hard and easy splits, but the same gains in each, to within a thousandth."""
    random, rows = np.random.default_rng(0), []
    for data, split in settings or SETTINGS.values():
        for (network, weights, mode), level in levels.items():
            way = {"method": network, "weights": weights, "mode": mode, "size": PIXELS[mode], "passes": "printed"}
            way |= {"pretrained": "complete" if weights == "imagenet" else "none"}
            rows += _trained({"data": data, "split": split} | way, level, random, repetitions)
        rows += _trained({"data": data, "split": split, "method": "features_knn"}, FEATURES, random, repetitions + 3)
    return pd.DataFrame(rows, columns=COLUMNS)


def _trained(columns, level, random, repetitions):
    """Rows of one way; a later repetition is a harder split, and a later object a harder one."""
    kept = OBJECTS if columns["split"] == "test_objects" else ()
    for number in range(repetitions):
        common = columns | {"repetition": number, "dataset": DATASETS[columns["data"]]}
        yield common | {"metric": "accuracy", "value": level - 0.05 * number + 0.001 * random.normal()}
        if "mode" in columns:
            yield common | {"metric": "chance", "value": CHANCE}
            yield common | {"metric": "majority", "value": MAJORITY}
            yield common | {"metric": "train_accuracy", "value": 1.0}
        for k, name in enumerate(kept):
            value = level - 0.1 * k + 0.001 * random.normal()
            yield common | {"item": name, "metric": "accuracy", "value": value}
            if "mode" in columns:
                yield common | {"item": name, "metric": "train_accuracy", "value": 1.0}


def majority():
    """Rows of the recorded grasps: what the commonest answer gets right, of each object kept for the test."""
    fields = {"task": "slip", "split": "test_objects", "palm": "all", "scaled": "training", "metric": "accuracy"}
    rows = [fields | {"classifier": "majority", "item": name, "value": 0.4 - 0.1 * k} for k, name in enumerate(OBJECTS)]
    others = [{"palm": "side"}, {"task": "recognition"}, {"scaled": "own"}, {"classifier": "knn"}]
    return pd.DataFrame([*rows, *(rows[0] | other | {"value": 1.0} for other in others)])


real_networks = partial(build_item, topic, "tables", "real_networks")
judge = partial(verdicts, CLAIMS)


@pytest.fixture
def measured(measure):
    """A function of trainings to the results."""
    return partial(measure, "recorded_networks")


@pytest.fixture(scope="module")
def touched(measure):
    """The results of trainings in all settings, and of what guessing gets right of grasps."""
    return measure("recorded", majority(), "biotac_grasps", measure("recorded_networks", touches()))


@pytest.fixture(scope="module")
def table(touched):
    return real_networks(touched)


@pytest.fixture(scope="module")
def judged(touched):
    return judge(touched)


def line(table, data="pressure", split="random", method="mobilenet_v2", weights="imagenet", mode="frozen", **more):
    return only(table.frame, data=data, split=split, method=method, weights=weights, mode=mode, **more)


@pytest.mark.parametrize(("data", "split"), SETTINGS.values())
def test_gains_are_paired_so_that_hard_splits_and_objects_cancel(table, data, split):
    row = line(table, data, split)
    assert row["over_features"] == pytest.approx(0.1, abs=0.003)
    assert row["over_random"] == pytest.approx(0.4, abs=0.003)
    assert row["over_random_low"] > 0.39 and row["over_random_high"] < 0.41
    assert row["high"] - row["low"] > 0.1  # the accuracies themselves differ from split to split
    assert np.isnan(line(table, data, split, weights="random")["over_random"])  # over itself
    assert row["values"] == row["over_features_pairs"] == (len(OBJECTS) if split == "test_objects" else 3)
    assert line(table, mode="finetuned")["over_random"] == pytest.approx(0.3, abs=0.003)


def test_gains_run_over_the_splits_that_both_have(measured):
    frame = touches(settings=PRESSURE, repetitions=4)
    short = (frame["weights"] == "random") & (frame["repetition"] > 1)
    row = line(real_networks(measured(frame[~short])))
    assert (row["values"], row["over_features_pairs"], row["over_random_pairs"]) == (4, 4, 2)
    assert row["over_random"] == pytest.approx(0.4, abs=0.003)


@pytest.mark.parametrize(
    ("data", "split", "unit", "shared"),
    [("pressure", "random", "repetition", shared_by("random")), ("grasps_slip", "test_objects", "item", 0.0)],
)
def test_intervals_are_widened_for_repeated_splits_and_not_for_objects(table, data, split, unit, shared):
    frame = touches()
    subset = frame[(frame["data"] == data) & (frame["split"] == split) & (frame["method"] == "features_knn")]
    subset = subset[subset["item"].notna() == (unit == "item")]
    mean, low, high = interval(subset.groupby(unit)["value"].mean(), shared)
    row = line(table, data, split, "features_knn", "", "")
    assert (row["accuracy"], row["low"], row["high"]) == pytest.approx((mean, low, high))


def test_a_network_is_compared_at_its_own_size_and_mode(measured):
    frame = touches(settings=PRESSURE)
    subset = frame[(frame["method"] == "mobilenet_v2") & (frame["mode"] == "frozen") & (frame["weights"] == "imagenet")]
    larger = subset.assign(size=224, value=subset["value"] + 0.1)
    shown = real_networks(measured(pd.concat([frame, larger]))).shown
    shown = only(shown, data="pressure array, 22 objects", split="touches at random", filters="frozen, 224 px")
    assert shown["over random weights"] == "–" and shown["over features and kNN"].startswith("+20")


def test_guessing_is_what_is_right_more_often_and_of_each_kept_object(table, measured):
    assert line(table)["guess"] == pytest.approx(MAJORITY)
    assert line(table, "grasps_slip", "test_objects")["guess"] == pytest.approx(0.25)
    frame = touches(settings=PRESSURE)
    frame.loc[frame["metric"] == "chance", "value"] = 0.3
    assert line(real_networks(measured(frame)))["guess"] == pytest.approx(0.3)


WORDS = {
    "frozen_over_guessing_fingers": "supported",
    "frozen_by_guessing": "contradicted",
    "seen_over_random_frozen": "supported",
    "seen_over_random_tuned": "supported",
    "tuned_over_frozen": "supported",
    "resnet_best": "supported",
}


@pytest.mark.slow
def test_claims_say_what_the_rows_hold_in_every_setting(judged):
    for key, word in WORDS.items():
        subset = judged[judged.index.str.startswith(f"recorded_{key}")]
        assert len(subset) in (2, 3, len(SETTINGS)) and set(subset["verdict"]) == {word}, key


@pytest.mark.slow
def test_one_reading_is_a_sentence_and_pressure_arrays_have_one_side_alone(judged):
    primary = judged[judged["of"] == ""].index
    assert "recorded_instant_by_guessing_hand_random" in primary and "recorded_frozen_over_guessing_vitac" in primary
    assert not judged.index.str.startswith("recorded_frozen_over_guessing_pressure").any()  # T5.4 says the contrary


@pytest.mark.parametrize(("key", "effect", "over"), [
    ("tuned_over_frozen_pressure_runs", 10, "repetitions"), ("resnet_best_pressure_runs", 5, "repetitions"),
    ("tuned_over_frozen_fingers_slip", 10, "objects"), ("frozen_over_guessing_fingers_slip", 30, "objects"),
    ("frozen_by_guessing_pressure_random", 7.6 - 100 * (0.7 - 0.05 - MAJORITY), "repetitions"),  # the thesis's lead
    ("seen_over_random_networks_pressure_random", 100 * (0.4 + 0.15 + 0.45) / 3, "networks"),
])  # fmt: skip
def test_effects_are_points_over_repetitions_objects_or_networks(judged, key, effect, over):
    row = judged.loc[f"recorded_{key}"]
    assert row["effect"] == pytest.approx(effect, abs=0.3) and row["over"] == over
    assert row["pairs"] == {"repetitions": 3, "objects": len(OBJECTS), "networks": 3}[over]


@pytest.mark.parametrize(("best", "word"), [(0.65, "supported"), (0.75, "contradicted")])
def test_the_best_classifier_of_any_scaling_is_the_rival_of_frozen_filters(measured, measure, best, word):
    ways = {("knn", "training"): 0.6, ("svm", "min_max"): best, ("tree", "training"): 0.5, ("majority", "training"): 1}
    rows = [{"group": group, "method": "all", "split": "random", "classifier": name, "scaling": scaling,
             "repetition": number, "metric": "accuracy", "value": (level if group == "all" else 0.9) - 0.05 * number}
            for (name, scaling), level in ways.items() for group in ("all", "six") for number in range(3)]  # fmt: skip
    results = measure("recorded", pd.DataFrame(rows), "pressure_images", measured(touches(settings=PRESSURE)))
    row = judge(results, "recorded_frozen_over_features_pressure_random").iloc[0]
    assert row["verdict"] == word and row["effect"] == pytest.approx(100 * (0.7 - best), abs=0.3)


@pytest.mark.parametrize(("instant", "word"), [(0.1, "supported"), (0.6, "contradicted")])
def test_one_reading_is_held_against_guessing_and_against_the_series(measured, instant, word):
    fields = {"method": "mobilenet_v2", "weights": "imagenet", "mode": "frozen", "size": 96, "pretrained": "complete"}
    rows, random = [], np.random.default_rng(0)
    for (data, level), split in product({"schunk": 0.4, "schunk_coarse": instant}.items(), ("random", "objects")):
        rows += _trained(fields | {"data": data, "split": split}, level, random, 4)
    keys = [f"recorded_{key}_hand_{split}" for key in ("instant_by_guessing", "series_over_instant")
            for split in ("random", "grasps")]  # fmt: skip
    frame = judge(measured(pd.DataFrame(rows, columns=COLUMNS)), *keys)
    assert frame["verdict"].tolist() == [word] * 4 and frame["pairs"].tolist() == [4] * 4
    series = frame[frame.index.str.contains("series")]
    assert series["effect"].to_numpy() == pytest.approx(100 * (0.4 - instant), abs=0.3)


def test_a_claim_names_the_training_or_the_rival_that_it_lacks(measured):
    levels = {way: level for way, level in LEVELS.items() if way[0] == "resnet50"}
    levels |= {way: level for way, level in LEVELS.items() if way[0] == "mobilenet_v2" and way[2] == "frozen"}
    keys = ("recorded_tuned_over_frozen_pressure_random", "recorded_frozen_over_features_pressure_random")
    frame = judge(measured(touches(levels, PRESSURE)), *keys)
    lacking = frame.loc[keys[0]]
    assert lacking["tested_on"] == "not run: mode finetuned is not among those that recorded_networks measured"
    assert lacking["verdict"] == "open" and "no measurements of recorded" in frame.loc[keys[1], "tested_on"]
    alone = {way: level for way, level in levels.items() if way[0] == "resnet50"}
    alone = judge(measured(touches(alone, PRESSURE)), "recorded_resnet_best_pressure_random").iloc[0]
    assert alone["verdict"] == "open" and "no other method than resnet50" in alone["tested_on"]


def test_trainings_until_nothing_improves_are_a_reading_of_their_own(measured):
    more = touches({way: 0.9 for way in LEVELS if way[2] == "finetuned"}, PRESSURE)
    more = more.assign(passes="converged", value=more["value"] - 0.01 * more["repetition"])
    keys = [f"recorded_{key}_pressure_random" for key in ("seen_over_random_tuned", "tuned_over_frozen")]
    results = measured(pd.concat([touches(settings=PRESSURE), more]))
    frame = judge(results, *keys)
    assert frame["effect"].to_numpy() == pytest.approx([30, 10], abs=0.3)
    readings = frame["readings"].str.partition("trained until nothing improves: ")[2]
    assert readings.iloc[0].startswith("no difference") and readings.iloc[1].startswith("supported +19")
    table = real_networks(results)
    gains = [line(table, mode="finetuned", passes=passes)["over_random"] for passes in ("printed", "converged")]
    assert gains == pytest.approx([0.3, 0.0], abs=0.003)
    assert "fine-tuned, 64 px, until nothing improves" in set(table.text["filters"])


def test_claims_over_repeated_splits_alone_are_widened():
    shares = {(claim.pairs, claim.share) for claim in CLAIMS}
    assert shares == {("repetitions", shared_by("random")), ("objects", 0.0), ("networks", 0.0)}

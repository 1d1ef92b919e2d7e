"""Networks on recorded touches in the report: gains, guesses and claims on trainings whose truth is known."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from haptic_glance.know.split import shared_by
from stages.engine.statistics import interval
from stages.recorded_networks import report as topic
from stages.report.parts import build_item
from tests.frames import only

SETTINGS = {
    "pressure_random": ("pressure", "random"), "pressure_runs": ("pressure", "blocks"),
    "fingers_random": ("grasps_object", "random"), "fingers_runs": ("grasps_object", "blocks"),
    "fingers_slip": ("grasps_slip", "test_objects"),
}  # fmt: skip
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

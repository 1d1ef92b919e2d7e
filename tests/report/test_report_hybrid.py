"""The claims of the hybrid network, on rows whose truth is known."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.report import hybrid
from stages.report.parts import build_item
from stages.transfer.hybrid_report import JOINED, NEW_OBJECTS
from tests.report import frames

FIRST = "18:139"
HYBRIDS = ("hybrid", "hybrid_float16", "hybrid_int8")
LEVELS = {"vision": 0.95, "touch": 0.6}


def rows(repetitions=3, both=0.05, small=-0.003):
    """Three hybrid networks a split: sight beats touch, both senses beat the better one by a margin.

    small: what weights of 8 bits gain.
    """
    random, entries = np.random.default_rng(0), []
    for split in ("random", "objects"):
        for number in range(repetitions):
            base = {"data": "hybrid", "weights": "imagenet", "mode": FIRST, "split": split}
            base |= {"repetition": number, "pretrained": "complete", "size": 80, "touches": 20}
            for sense, level in LEVELS.items():
                value = level + 0.003 * random.normal()
                for name in (sense, *HYBRIDS):
                    gain = small + 0.0005 * number if name == "hybrid_int8" else 0.0
                    entries.append(base | {"method": name, "sense": sense, "metric": "accuracy", "value": value + gain})
            entries.append(base | {"method": "hybrid", "metric": "size_ratio", "value": 1.43 + 1e-5 * number})
            dark = "picture_darkness"
            for damage, severity, loss in (("none", 0.0, 0.0), (dark, 0.7, 0.2), (dark, 0.95, 0.8)):
                for way in JOINED:
                    value = 0.6 if way in ("touch", "sum_mean") else 0.9 - loss
                    value = max(value, 0.6) + both if way == "fusion_entropy" else value
                    value += 0.003 * random.normal()
                    entries.append(base | {"method": way, "sense": "both", "metric": "accuracy", "value": value}
                                 | {"perturbation": damage, "severity": severity})  # fmt: skip
    for number in range(repetitions):
        touch = {"data": "imprints128", "method": "mobilenet_v2", "weights": "imagenet"}
        touch |= {"mode": "frozen", "split": "random", "repetition": number}
        entries += [touch | {"metric": "accuracy", "value": 0.5}, touch | {"metric": "chance", "value": 0.125}]
    entries += [row | {"metric": "train_accuracy", "value": 1.0} for row in entries if row["metric"] == "accuracy"]
    return pd.DataFrame(entries).assign(note=None, seconds=10.0, dataset="furniture", seed=0)


@pytest.fixture(scope="module")
def run(measure):
    """Results of a run that has stitched hybrid networks."""
    return measure("transfer", rows(), "furniture")


verdicts = partial(frames.verdicts, hybrid.CLAIMS)


KEYS = ("sight_over_touch", "both_over_better", "touch_in_the_dark", "eight_bits_sight", "eight_bits_touch")
EVERY = [f"{key}_{split}" for key in KEYS for split in ("random", "objects")] + ["apart_over_sum_random"]


@pytest.mark.slow
def test_claims_hold_and_turn_with_the_rows_of_their_split(run, measure):
    assert verdicts(run, *EVERY)["verdict"].to_dict() == dict.fromkeys(EVERY, "supported")
    frame = rows(both=-0.5, small=-0.03)
    frame.loc[(frame["split"] == "objects") & (frame["sense"] == "touch"), "value"] += 0.9
    judged = verdicts(measure("transfer", frame), *EVERY)
    assert judged.loc["both_over_better_random", "verdict"] == "contradicted"
    assert judged.loc["both_over_better_objects", "verdict"] == "contradicted"
    assert judged.loc["eight_bits_touch_random", "verdict"] == "contradicted"  # one point may be lost, and no more
    assert judged.loc["eight_bits_touch_random", "effect"] == pytest.approx(-3 + 0.05 + 1, abs=1e-6)
    assert judged.loc["sight_over_touch_random", "verdict"] == "supported"
    assert judged.loc["sight_over_touch_objects", "verdict"] == "contradicted"


def test_what_loses_about_the_point_that_may_be_lost_is_open_and_says_what_nobody_measured(measure):
    row = verdicts(measure("transfer", rows(small=-0.01)), "eight_bits_touch_random").iloc[0]
    assert -3 < row["low"] < 0 < row["high"] < 3 and row["verdict"] == "open"
    assert "nobody measured whether the training was saturated" in row["tested_on"]


def test_a_file_is_as_much_smaller_as_in_print_or_more(run, measure):
    row = verdicts(run, "hybrid_smaller").iloc[0]
    assert row["verdict"] == "supported" and row["effect"] == pytest.approx(0.00161) and row["unit"] == "times"
    frame = rows()
    frame.loc[frame["metric"] == "size_ratio", "value"] -= 0.01
    assert verdicts(measure("transfer", frame), "hybrid_smaller").iloc[0]["verdict"] == "contradicted"


@pytest.fixture
def two_middles(measure):
    """Results of the hybrid network and of one with other shared layers, which is better by two points."""
    frame = rows(small=0.0)
    sizes = frame[(frame["metric"] == "accuracy") & frame["sense"].isin(LEVELS) & frame["perturbation"].isna()]
    frame = pd.concat([frame, sizes.assign(metric="size_bytes", value=1e6)])
    other = frame[frame["data"].eq("hybrid") & frame["repetition"].lt(2)].assign(mode="18:147")
    other["value"] += 0.02 * other["metric"].eq("accuracy")
    return measure("transfer", pd.concat([other, frame]))


@pytest.mark.slow
def test_other_shared_layers_stand_by_their_gain_on_the_same_items(two_middles):
    table = build_item(hybrid, "tables", "section_5_5", two_middles)
    gains = table.frame.groupby("shared_layers", sort=False)[["vision_gain", "touch_gain"]].agg(["min", "max"])
    assert list(gains.index) == [FIRST, "18:147"]  # the one with more repetitions first
    assert gains.to_numpy() == pytest.approx(np.array([[0.0] * 4, [2.0] * 4]), abs=1e-9)
    shown = table.shown.set_index("shared layers").filter(like="gain by sight")
    assert set(shown.loc[FIRST].stack()) == {"–"} and set(shown.loc["18:147"].stack()) == {"+2.0"}
    chart = build_item(hybrid, "tradeoff", "hybrid", two_middles)
    first = table.frame[(table.frame["shared_layers"] == FIRST) & (table.frame["network"] == "hybrid")]
    for axes, (_, row) in zip(chart.drawing.axes, first.iterrows(), strict=True):
        hollow = {round(line.get_xdata()[0], 6) for line in axes.lines if line.get_markerfacecolor() == "white"}
        assert hollow == {round(100 * row[sense] + 2, 6) for sense in LEVELS}
    assert "Hollow: layers 18:147 shared instead of 18:139" in chart.caption


OBJECTS = ("horse", "dog", "oldtimer", "urn", "dome_lamp", "lying_man", "long_sofa", "low_table")  # of seven classes


def test_new_objects_are_judged_by_object_and_class(measure):
    """A head that knows 30 % of eight new objects after one touch and 50 % after five, ten points over the others."""
    random, entries = np.random.default_rng(0), []
    for name, worse in (("hybrid_head", 0.0), ("imagenet_head", 0.1), ("hybrid_nearest", 0.1)):
        for count, share in ((1, 0.3), (2, 0.4), (5, 0.5), (10, 0.5)):
            about = {"data": "hybrid", "method": name, "split": "objects", "repetition": 0, "severity": count}
            about |= {"perturbation": "new_object", "metric": NEW_OBJECTS, "seconds": 0.1 * count}
            values = share - worse + 0.02 * random.normal(size=8)
            entries += [about | {"item": name, "value": value} for name, value in zip(OBJECTS, values, strict=True)]
    chance = {"data": "hybrid", "method": "chance", "metric": NEW_OBJECTS, "value": 1 / 8}
    results = measure("transfer", pd.concat([rows(), pd.DataFrame([*entries, chance])]), "furniture")
    judged = verdicts(results, "new_object_hybrid_over_imagenet", "new_object_over_guessing")
    assert judged.loc["new_object_hybrid_over_imagenet", "effect"] == pytest.approx(10, abs=3)
    assert judged.loc["new_object_over_guessing", "effect"] == pytest.approx(17.5, abs=3)
    assert judged.loc["new_object_over_guessing", ["pairs", "units"]].tolist() == [8, 7]

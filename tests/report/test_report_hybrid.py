"""The tables, figures, chart and claims of the hybrid network, on rows whose truth is known."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.report import hybrid, stability
from stages.report.hybrid.section_5_5 import JOINED, NEW_OBJECTS
from stages.report.topics import build_one
from tests.report import frames
from tests.report.frames import has_ink

FIRST, LONGER = "18:139", "18:147"
SIZES = {"hybrid": 11.9e6, "hybrid_float16": 5.9e6, "hybrid_int8": 3.4e6}
LEVELS = {"vision": 0.95, "touch": 0.6}

LOOKED = "20 touches an object at 80 px"


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
                for name in (sense, *SIZES):
                    gain = small + 0.0005 * number if name == "hybrid_int8" else 0.0
                    entries.append(base | {"method": name, "sense": sense, "metric": "accuracy", "value": value + gain})
                entries.append(base | {"method": sense, "sense": sense, "metric": "size_bytes", "value": 8.5e6})
                entries.append(base | {"method": "hybrid", "sense": sense, "metric": "max_difference", "value": 2e-6})
            for name, size in SIZES.items():
                entries.append(base | {"method": name, "metric": "size_bytes", "value": size})
                entries.append(base | {"method": name, "metric": "size_ratio", "value": 17e6 / size})
            for damage, severity, loss in (
                ("none", 0.0, 0.0),
                ("picture_darkness", 0.7, 0.2),
                ("picture_darkness", 0.95, 0.8),
            ):
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


def longer(frame, lost=0.1):
    """Rows of a network that shares more layers, trained once: a smaller file that is right less often."""
    part = frame[(frame["data"] == "hybrid") & (frame["repetition"] == 0)].assign(mode=LONGER)
    part.loc[part["metric"] == "accuracy", "value"] -= lost
    part.loc[part["metric"] == "size_ratio", "value"] *= 1.68 / (17 / 11.9)
    part.loc[part["method"].isin(SIZES) & (part["metric"] == "size_bytes"), "value"] *= 17 / 11.9 / 1.68
    return part


@pytest.fixture(scope="module")
def run(measure):
    """Results of a run that has stitched hybrid networks."""
    pairs = [(a, b) for a in ("car", "vase") for b in ("car", "vase")]
    counts = [
        {"data": "hybrid", "method": "hybrid", "mode": "18:139", "split": split, "sense": sense, "repetition": 0}
        | {"metric": "confusion", "group": a, "predicted": b, "value": 8 if a == b else 2}
        for split in ("random", "objects") for sense in LEVELS for a, b in pairs
    ]  # fmt: skip
    noisy = [
        {"data": "imprints128", "method": "mobilenet_v2", "weights": "imagenet", "mode": "frozen", "split": "random"}
        | {"metric": "disturbed_accuracy", "perturbation": "noise", "severity": s}
        | {"repetition": k, "value": 0.5 - s - 0.01 * k}
        for s in (0.1, 0.2) for k in range(3)
    ]  # fmt: skip
    return measure("transfer", pd.concat([rows(), pd.DataFrame(counts), pd.DataFrame(noisy)]), "furniture")


@pytest.fixture(scope="module")
def two_middles(run, measure):
    """Results of a run in which the network of the longer middle comes first in the file."""
    frame = run.rows("transfer")
    return measure("transfer", pd.concat([longer(frame), frame], ignore_index=True))


table = partial(build_one, hybrid, "tables")
verdicts = partial(frames.verdicts, hybrid.CLAIMS)


@pytest.fixture(scope="module")
def stitched(run):
    return table("section_5_5", run)


def test_the_hybrid_stands_beside_the_two_networks(stitched):
    frame = stitched.frame.set_index(["network", "split"])
    assert frame.loc[("hybrid", "random"), "touch"] == frame.loc[("apart", "random"), "touch"]
    assert frame.loc[("hybrid", "random"), "size_ratio"] == pytest.approx(17 / 11.9, rel=1e-4)
    assert frame.loc[("apart", "random"), "megabytes"] == pytest.approx(17)
    notes = " ".join(stitched.notes)
    assert "size ratio 1.4284" in notes and "by 2.00e-06 at most, accuracy by 0.00 points" in notes
    assert "Size ratio 1.4286; the thesis's is 1.4284." in notes and "aim" not in notes


@pytest.mark.slow
def test_networks_of_another_middle_change_no_claim_and_no_table_of_the_first(run, two_middles):
    pd.testing.assert_frame_equal(verdicts(two_middles, *EVERY), verdicts(run, *EVERY))
    pd.testing.assert_frame_equal(*(table("hybrid_senses", results).frame for results in (two_middles, run)))


def test_a_longer_middle_is_held_against_the_first_on_the_same_items(stitched, two_middles):
    made = table("section_5_5", two_middles)
    pd.testing.assert_frame_equal(made.frame[made.frame["shared_layers"] == FIRST], stitched.frame)
    frame = made.frame.set_index(["shared_layers", "network", "split"])
    row = frame.loc[(LONGER, "hybrid", "objects")]
    assert row["touch_gain"] == pytest.approx(-10) and row["size_ratio"] == pytest.approx(1.68, rel=1e-4)
    assert frame.loc[(FIRST, "hybrid", "objects"), "touch_gain"] == 0
    line = made.shown.set_index(["shared layers", "network"]).loc[(LONGER, "hybrid")]
    assert line["gain by touch, unseen objects, points"] == "-10.0" and "·" not in line["by touch, unseen objects, %"]
    assert "gain by touch, unseen objects, points" not in made.first
    assert "Size ratio 1.6800; the thesis's is 1.4284." in " ".join(made.notes)


def test_hybrids_on_the_thesis_s_classes_stand_beside_the_run_s(measure):
    ours = rows()
    without = ours[ours["data"] != "hybrid"].assign(dataset="test")  # the first set has none, and hides none
    theirs = rows(both=-0.5).assign(dataset="princeton_six")
    frame = table("section_5_5", measure("transfer", pd.concat([ours, without, theirs]))).frame
    assert list(frame["objects"].unique()) == [f"furniture, {LOOKED}", f"psb, the thesis's 6 classes, {LOOKED}"]
    ours, theirs = (
        frame[(frame["objects"] == name) & (frame["network"] == "hybrid") & (frame["split"] == "objects")].iloc[0]
        for name in frame["objects"].unique()
    )
    assert theirs["touch"] == ours["touch"]
    narrower = (theirs["touch_high"] - theirs["touch_low"]) / (ours["touch_high"] - ours["touch_low"])
    assert narrower == pytest.approx(np.sqrt((1 + 3 / 4) / (1 + 3 / 2)))  # one object of five, not of three


def test_damage_is_told_at_its_harshest(run):
    shown = table("hybrid_senses", run).shown.set_index("answers")
    assert list(shown) == ["mean of all columns, %", "both whole, %", "picture: darkness 0.95, %"]
    mean, *shares = (float(cell.split()[0]) for cell in shown.loc["sight alone"])
    assert mean == pytest.approx(sum(shares) / 2, abs=1)
    assert shown.loc["sight alone", "picture: darkness 0.95, %"].startswith("10")


@pytest.mark.slow
def test_confusions_of_each_split_and_sense_are_in_per_cent(run):
    made = build_one(hybrid, "figures", "figure_5_6", run)
    assert has_ink(made)
    assert "2 classes (car, vase)" in made.alt and "items at random, unseen objects in rows" in made.alt
    cells = [[text.get_text() for text in axes.texts] for axes in made.drawing.axes]
    assert cells == 4 * [["80", "20", "20", "80"]]


def test_a_network_breaks_where_half_of_its_lead_is_lost(run):
    made = build_one(stability, "tables", "transfer_stability", run)
    row = made.frame.set_index("perturbation").loc["noise"]
    assert row["breaking_point"] == pytest.approx(0.1775)  # 0.39 at 0.1, 0.29 at 0.2; half way from 0.5 to 0.125
    assert row["low"] < row["breaking_point"] < row["high"] or np.isnan(row["high"])
    assert made.shown["unit"].tolist() == ["sigma, share of full scale"]
    assert has_ink(build_one(stability, "figures", "transfer_stability", run))


KEYS = ("sight_over_touch", "both_over_better", "touch_in_the_dark", "eight_bits_sight", "eight_bits_touch")
EVERY = [f"{key}_{split}" for key in KEYS for split in ("random", "objects")] + ["apart_over_sum_random"]


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


def test_new_objects_stand_below_the_table_and_in_the_claims(measure):
    """A head that knows 30 % of eight new objects after one touch and 50 % after five, ten points over the others."""
    random, entries = np.random.default_rng(0), []
    for name, worse in (("hybrid_head", 0.0), ("imagenet_head", 0.1), ("hybrid_nearest", 0.1)):
        for count, share in ((1, 0.3), (2, 0.4), (5, 0.5), (10, 0.5)):
            about = {"data": "hybrid", "method": name, "split": "objects", "repetition": 0, "severity": count}
            about |= {"perturbation": "new_object", "metric": NEW_OBJECTS, "seconds": 0.1 * count}
            values = share - worse + 0.02 * random.normal(size=8)
            entries += [about | {"item": f"o{k}", "value": value} for k, value in enumerate(values)]
    chance = {"data": "hybrid", "method": "chance", "metric": NEW_OBJECTS, "value": 1 / 8}
    frame = rows()
    worse = (frame["method"] == "hybrid") & (frame["metric"] == "accuracy") & (frame["sense"] == "touch")
    frame.loc[worse, "value"] -= 0.03
    results = measure("transfer", pd.concat([frame, pd.DataFrame([*entries, chance])]), "furniture")
    notes = " ".join(table("section_5_5", results).notes)
    assert "a new head on the hybrid's features: " in notes and "0.10 to 1 s an object on one core" in notes
    assert "8 new objects, guessing 12.5 %" in notes and "accuracy by 3.00 points at most." in notes
    judged = verdicts(results, "new_object_hybrid_over_imagenet", "new_object_over_guessing")
    assert judged.loc["new_object_hybrid_over_imagenet", "effect"] == pytest.approx(10, abs=3)
    assert judged.loc["new_object_over_guessing", "effect"] == pytest.approx(17.5, abs=3)

"""Claims of chapter 5 on the thesis's own classes, on trainings whose truth is known."""

import re
from itertools import product

import numpy as np
import pandas as pd
import pytest

from haptic_glance.know.split import shared_by
from stages.report import networks as _transfer
from stages.report import transfer
from stages.report.results import NotRun
from stages.report.topics import build_one
from stages.report.transfer import figure_5_3
from stages.report.transfer import tables as chapter_5
from stages.report.verdict import judge

FINE, COARSE = "imprints128", "imprints16"
LEVELS = {  # (data, weights, mode) -> accuracy
    (FINE, "imagenet", "finetuned"): 0.8,
    (FINE, "imagenet", "frozen"): 0.5,
    (FINE, "imagenet", "18:139"): 0.8,
    (FINE, "imagenet", "1:134"): 0.7,
    (FINE, "random", "finetuned"): 0.4,
    (FINE, "random", "frozen"): 0.3,
    (COARSE, "imagenet", "finetuned"): 0.6,
    (COARSE, "imagenet", "frozen"): 0.2,
}
KEYS = {
    "tuned_over_frozen", "frozen_over_chance", "frozen_coarse_by_chance", "fine_over_coarse_frozen",
    "fine_over_coarse_tuned", "seen_over_random_frozen", "seen_over_random_tuned", "early_and_late", "middle_frozen",
    "early_decisive", "earlier_change",
}  # fmt: skip


def rows(dataset="princeton_six", turned=False, **levels):
    """Five trainings of each setting. levels: others for modes; turned: what was better by a margin is worse by it."""
    random, found = np.random.default_rng(0), []
    for (data, weights, mode), level in LEVELS.items():
        level = levels.get(mode, level)
        for split in ("random", "objects"):
            for number in range(5):
                one = {"dataset": dataset, "data": data, "method": "mobilenet_v2", "weights": weights, "mode": mode}
                one |= {"split": split, "repetition": number, "pretrained": "complete", "seconds": 1.0}
                value = (1 - level if turned else level) + 0.002 * random.normal()
                values = {"accuracy": value, "chance": 1 / 6, "train_accuracy": 1.0}
                found += [one | {"metric": metric, "value": value} for metric, value in values.items()]
    changed = {"dataset": dataset, "data": FINE, "method": "mobilenet_v2", "weights": "imagenet", "mode": "finetuned"}
    changed |= {"split": "random", "metric": "layer_weight_change"}
    for number, depth in product(range(5), range(3)):
        change = 0.1 ** (2 - depth if turned else depth)
        found.append(changed | {"repetition": number, "layer": f"conv{depth}", "part": f"conv{depth}", "value": change})
    return pd.DataFrame(found).assign(size=128, touches=28, seed=0, note=None, passes="printed")


@pytest.fixture
def both(bare, small):
    """Results of a run in which all is as the thesis says, and of trainings on its classes in which nothing is."""
    small.write(bare, "transfer", rows("furniture"))
    small.write(bare, "transfer", rows(turned=True))
    return small.results(bare)


def words(results):
    """{key: the judged row} of chapter 5."""
    return judge(chapter_5.CLAIMS, results).set_index("key")


@pytest.mark.slow
def test_sets_that_contradict_each_other_are_mixed_and_each_is_told(both):
    found = words(both)
    for split in ("random", "objects"):
        row = found.loc[f"tuned_over_frozen_{split}"]
        assert row["verdict"] == "contradicted" and row["carries"].startswith("mixed") and row["pairs"] == 5
        assert re.match(r"psb, the thesis's 6 classes -(29|30)\S* .*; furniture \+(29|30)", row["by_set"])
    assert both.rows("transfer")["dataset"].unique() == ["furniture"]


@pytest.mark.slow
def test_every_claim_has_rows_of_both_sets_and_says_where(both):
    found = words(both)
    keys = {key.removesuffix("_psb").rpartition("_")[0] for key in found.index}
    assert keys == KEYS and found["section"].str.startswith("T5.").all()
    early = found.index.str.endswith("_psb")
    assert (found["pairs"] == 5).all() and (found.loc[early, "carries"] == "").all()
    assert found["tested_on"].str.startswith("psb, the thesis's 6 classes").all()


@pytest.mark.slow
def test_all_that_the_thesis_says_can_be_supported_by_its_classes_alone(bare, small):
    small.write(bare, "transfer", rows())
    found = words(small.results(bare))
    changed = found.index == "earlier_change_more"  # equal differences show no spread
    assert set(found.loc[~changed, "verdict"]) == {"supported"}
    assert found.loc[changed, "effect"].item() == 1 and (found["by_set"] == "").all()


def test_networks_that_saw_other_sizes_are_not_compared(bare, small):
    frame = rows()
    frame.loc[(frame["data"] == COARSE) | (frame["mode"] == "18:139"), "size"] = 80
    small.write(bare, "transfer", frame)
    found = words(small.results(bare))["verdict"]
    assert found["fine_over_coarse_tuned_random"] == found["early_and_late_random"] == "open"
    assert found["tuned_over_frozen_random"] == "supported"


def test_early_layers_are_decisive_where_the_last_alone_learn_less(bare, small):
    small.write(bare, "transfer", rows(**{"1:134": 0.85}))
    found = words(small.results(bare))
    assert found.loc["early_decisive_random_psb", "effect"] == pytest.approx(-5, abs=0.5)
    assert found.loc["early_decisive_objects_psb", "verdict"] == "contradicted"


def test_without_trainings_on_them_the_claims_name_what_measures_them(bare, small):
    small.write(bare, "transfer", rows("furniture"))
    found = words(small.results(bare))
    assert found.loc["early_decisive_random_psb", "tested_on"].startswith(
        "not run: no measurements of transfer on princeton_six"
    )
    assert found.loc["tuned_over_frozen_random", "verdict"] == "supported"


def test_one_object_of_five_says_more_than_one_of_three():
    assert _transfer.shared("objects") == 1 / 2 and _transfer.shared("objects", "princeton_six") == 1 / 4
    assert _transfer.shared("random", "princeton_six") == shared_by("random")
    frames = (rows(source) for source in ("furniture", "princeton_six"))
    one = (frame[(frame["metric"] == "accuracy") & (frame["mode"] == "1:134")] for frame in frames)
    width = [cell["high"] - cell["low"] for cell in (_transfer.accuracy(frame, "objects") for frame in one)]
    assert width[1] / width[0] == pytest.approx(np.sqrt((1 + 5 / 4) / (1 + 5 / 2)))


@pytest.mark.slow
def test_claims_and_figure_widen_intervals_alike(bare, small):
    small.write(bare, "transfer", rows())
    results = small.results(bare)
    found = words(results).loc["tuned_over_frozen_objects"]
    own = _transfer.everywhere(results)["princeton_six"]
    drawn = figure_5_3.gains(own).set_index(["network", "split", "data"]).loc[("mobilenet_v2", "objects", FINE)]
    assert list(drawn[["mean", "low", "high"]]) == pytest.approx([found["effect"], found["low"], found["high"]])


def test_other_rows_are_not_run_where_they_are_absent(bare, small):
    with pytest.raises(NotRun, match="princeton"):
        _transfer.measured(small.results(bare), "princeton_six")


@pytest.mark.slow
def test_other_networks_on_their_classes_stand_beside_and_change_no_claim(both, small):
    before = words(both)
    other = rows(frozen=0.9).assign(method="resnet50")
    frame = pd.concat([both.rows("transfer", "princeton_six"), other[other["mode"] == "frozen"]], ignore_index=True)
    small.write(both.workspace.root, "transfer", frame)
    again = small.results(both.workspace.root)
    shown = build_one(transfer, "tables", "table_5_4", again).frame.set_index(
        ["objects", "network", "mode", "weights", "split"]
    )
    where = ("princeton_six", "resnet50", "frozen", "imagenet", "objects")
    assert shown.loc[where, "accuracy"] == pytest.approx(0.9, abs=0.01) and shown.loc[where, "values"] == 5
    assert words(again)["effect"].equals(before["effect"])

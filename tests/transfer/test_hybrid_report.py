"""The hybrid network: other shared layers, on rows whose truth is known."""

import numpy as np
import pandas as pd
import pytest

from stages.report.parts import build_item
from stages.transfer import report as hybrid
from stages.transfer.hybrid_report import JOINED

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

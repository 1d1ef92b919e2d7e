"""The tables, figures, chart and claims of the hybrid network, on rows whose truth is known."""

import numpy as np
import pandas as pd
import pytest

from stages.kit.files import write_table
from stages.report.claims import chapter_5_hybrid
from stages.report.figures import figure_5_6, transfer_stability
from stages.report.results import NotRun, Results
from stages.report.tables import hybrid_senses, section_5_5
from stages.report.tables._hybrid import BOTH
from stages.report.tradeoff import hybrid as chart
from stages.report.verdict import judge

SIZES = {"hybrid": 11.9e6, "hybrid_float16": 5.9e6, "hybrid_int8": 3.4e6}
LEVELS = {"vision": 0.95, "touch": 0.6}


def rows(repetitions=3, both=0.05):
    """Three hybrid networks a split: sight beats touch, both senses beat the better one by a margin."""
    random, found = np.random.default_rng(0), []
    for split in ("random", "objects"):
        for number in range(repetitions):
            base = {"object": "furniture", "data": "hybrid", "weights": "imagenet", "mode": "18:139", "split": split}
            base |= {"repetition": number, "had": "complete"}
            for sense, level in LEVELS.items():
                value = level + 0.003 * random.normal()
                for name in (sense, *SIZES):
                    found.append(base | {"method": name, "sense": sense, "metric": "accuracy", "value": value})
                found.append(base | {"method": sense, "sense": sense, "metric": "size_bytes", "value": 8.5e6})
                found.append(base | {"method": "hybrid", "sense": sense, "metric": "max_difference", "value": 2e-6})
            for name, size in SIZES.items():
                found.append(base | {"method": name, "metric": "size_bytes", "value": size})
                found.append(base | {"method": name, "metric": "size_ratio", "value": 17e6 / size})
            for damage, severity, loss in (
                ("none", 0.0, 0.0),
                ("picture_darkness", 0.7, 0.2),
                ("picture_darkness", 0.95, 0.8),
            ):
                for way in BOTH:
                    value = 0.6 if way in ("touch", "sum_mean") else 0.9 - loss
                    value = max(value, 0.6) + both if way == "fusion_entropy" else value
                    value += 0.003 * random.normal()
                    found.append(base | {"method": way, "sense": "both", "metric": "accuracy", "value": value}
                                 | {"perturbation": damage, "severity": severity})  # fmt: skip
    for number in range(repetitions):
        one = {"object": "furniture", "data": "imprints128", "method": "mobilenet_v2", "weights": "imagenet"}
        one |= {"mode": "frozen", "split": "random", "repetition": number}
        found += [one | {"metric": "accuracy", "value": 0.5}, one | {"metric": "chance", "value": 0.125}]
    return pd.DataFrame(found).assign(dataset="furniture", seed=0, note=None, seconds=10.0)


@pytest.fixture
def run(bare, small):
    """Results of a run that has stitched hybrid networks."""
    small.write(bare, "transfer", rows())
    pairs = [(a, b) for a in ("car", "vase") for b in ("car", "vase")]
    counts = [
        {"trial": f"hybrid.18-139.{split}.0", "sense": sense, "true": a, "predicted": b, "count": 8 if a == b else 2}
        for split in ("random", "objects") for sense in LEVELS for a, b in pairs
    ]  # fmt: skip
    write_table(bare / "data/transfer/hybrid/confusion.csv", pd.DataFrame(counts))
    noisy = [
        {"data": "imprints128", "method": "mobilenet_v2", "weights": "imagenet", "mode": "frozen", "split": "random"}
        | {"repetition": k, "perturbation": "noise", "severity": s, "metric": "accuracy", "value": 0.5 - s - 0.01 * k}
        for s in (0.1, 0.2) for k in range(3)
    ]  # fmt: skip
    write_table(bare / "data/transfer/stability.csv", pd.DataFrame(noisy))
    return Results(small.settings(), bare)


def test_the_hybrid_stands_beside_the_two_networks(run):
    table = section_5_5.build(run)
    frame = table.frame.set_index(["network", "split"])
    assert frame.loc[("hybrid", "random"), "touch"] == frame.loc[("apart", "random"), "touch"]
    assert frame.loc[("hybrid", "random"), "size_ratio"] == pytest.approx(17 / 11.9, rel=1e-4)
    assert frame.loc[("apart", "random"), "megabytes"] == pytest.approx(17)
    notes = " ".join(table.notes)
    assert "size ratio 1.428" in notes and "by 2.00e-06 at most; accuracy by 0.00 points" in notes


def test_a_hybrid_that_loses_accuracy_says_so(bare, small):
    frame = rows()
    worse = (frame["method"] == "hybrid") & (frame["metric"] == "accuracy") & (frame["sense"] == "touch")
    frame.loc[worse, "value"] -= 0.03
    small.write(bare, "transfer", frame)
    assert any("accuracy by 3.00 points" in note for note in section_5_5.build(Results(small.settings(), bare)).notes)


def test_damage_is_told_at_its_harshest(run):
    shown = hybrid_senses.build(run).shown.set_index("answers")
    assert list(shown) == ["both whole, %", "picture: darkness 0.95, %"]
    assert shown.loc["sight alone", "picture: darkness 0.95, %"].startswith("10")


@pytest.mark.parametrize("module", [figure_5_6, transfer_stability, chart])
def test_pictures_are_drawn(run, module):
    assert module.build(run).paths[0].stat().st_size > 10_000


VERDICTS = {
    "sight_over_touch": "supported",
    "both_over_better": "supported",
    "apart_over_sum": "supported",
    "touch_in_the_dark": "supported",
}


@pytest.mark.parametrize(("key", "word"), VERDICTS.items())
def test_claims_say_what_the_rows_hold(run, key, word):
    assert judge(chapter_5_hybrid.CLAIMS, run).set_index("key").loc[key, "verdict"] == word


def test_a_claim_turns_with_the_rows(bare, small):
    small.write(bare, "transfer", rows(both=-0.5))
    found = judge(chapter_5_hybrid.CLAIMS, Results(small.settings(), bare)).set_index("key")
    assert found.loc["both_over_better", "verdict"] == "contradicted"


def test_without_a_hybrid_nothing_is_made_up(bare, small):
    empty = Results(small.settings(), bare)
    for module in (section_5_5, hybrid_senses, figure_5_6, transfer_stability, chart):
        with pytest.raises(NotRun, match="transfer"):
            module.build(empty)

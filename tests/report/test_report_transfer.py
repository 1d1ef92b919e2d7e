"""The tables, figures, chart and claims of chapter 5, on trainings whose truth is known."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from stages.report import networks as _transfer
from stages.report import recorded as recorded_topic
from stages.report import transfer
from stages.report.effects import differences
from stages.report.results import NotRun
from stages.report.topics import KINDS, build_one
from stages.report.transfer import figure_5_3, tables
from stages.report.transfer import tables as chapter_5
from stages.report.verdict import judge

MEANS = {  # (data, weights, mode) -> accuracy
    ("imprints128", "imagenet", "finetuned"): 0.9,
    ("imprints128", "imagenet", "frozen"): 0.6,
    ("imprints128", "imagenet", "18:139"): 0.85,
    ("imprints128", "random", "finetuned"): 0.5,
    ("imprints128", "random", "frozen"): 0.3,
    ("imprints16", "imagenet", "finetuned"): 0.7,
    ("imprints16", "imagenet", "frozen"): 0.4,
}
TEN = "10, as printed"
LOOKED = "{} touches an object at {} px"
LAYERS = {"conv1": "Conv1", "b2": "block_2", "b9": "block_9", "b15": "block_15", "last": "Conv_1"}


def rows(dataset="furniture", unseen=-0.2, repetitions=4):
    """Trainings: unseen objects are harder by a margin, fine-tuning and ImageNet help by margins."""
    random, found = np.random.default_rng(0), []
    for (data, weights, mode), mean in MEANS.items():
        for split, loss in (("random", 0.0), ("objects", unseen)):
            for number in range(repetitions):
                common = {"dataset": dataset, "data": data, "method": "mobilenet_v2", "weights": weights, "mode": mode}
                common |= {
                    "pretrained": "complete" if weights == "imagenet" else None,
                    "split": split,
                    "repetition": number,
                }
                values = {"accuracy": mean + loss + 0.005 * random.normal(), "chance": 0.125}
                seconds = 10.0 if mode == "frozen" else 60.0
                found += [common | {"metric": key, "value": v, "seconds": seconds} for key, v in values.items()]
    return pd.DataFrame(found).assign(size=80, touches=20, seed=0, note=None, passes="printed")


def changes():
    """Changes that fall with depth, of two trainings."""
    found = []
    for number in range(2):
        about = {"data": "imprints128", "method": "mobilenet_v2", "weights": "imagenet", "mode": "finetuned"}
        about |= {"dataset": "furniture", "split": "random", "repetition": number, "metric": "layer_weight_change"}
        for depth, (layer, part) in enumerate(LAYERS.items()):
            found.append(about | {"layer": layer, "part": part, "value": 0.1 ** (depth + 0.1 * number)})
        found.append(about | {"metric": "weight_change", "value": 0.01 * (number + 1)})
    return pd.DataFrame(found).assign(passes="printed")


def converged(dataset="princeton_six", repetitions=3):
    """Trainings until nothing improves, at random: fine-tuning ends at 95 %, having learned all; frozen at 70 %."""
    found = []
    for mode, mean in (("finetuned", 0.95), ("frozen", 0.7)):
        for number in range(repetitions):
            about = {"data": "imprints128", "method": "mobilenet_v2", "weights": "imagenet", "mode": mode}
            about |= {"dataset": dataset, "split": "random", "repetition": number, "pretrained": "complete"}
            values = {"accuracy": mean + 0.01 * number, "train_accuracy": mean + 0.04, "epochs": 30 + number}
            found += [about | {"metric": key, "value": value, "seconds": 9.0} for key, value in values.items()]
            curves = {"curve_train_accuracy": mean, "curve_validation_accuracy": mean - 0.1}
            steps = [(metric, epoch, value) for metric, value in curves.items() for epoch in range(1, 31)]
            found += [about | {"metric": m, "epoch": k, "value": v * (1 - 0.5**k)} for m, k, v in steps]
    return pd.DataFrame(found).assign(size=80, touches=20, seed=0, note=None, passes="converged")


def taught(frame):
    """Rows of trainings and that each network learned its training part, without which no verdict is given."""
    return pd.concat([frame, frame[frame["metric"] == "accuracy"].assign(metric="train_accuracy", value=1.0)])


@pytest.fixture
def run(bare, small):
    """Results of a run that has trained MobileNetV2."""
    small.write(bare, "transfer", pd.concat([rows(), changes(), converged("furniture")]))
    return small.results(bare)


def only(frame, **where):
    """The one row of a frame."""
    for column, value in where.items():
        frame = frame[frame[column] == value]
    assert len(frame) == 1
    return frame.iloc[0]


def test_twin_of_table_5_4_stands_beside_the_thesis_s_figures(run):
    table = build_one(transfer, "tables", "table_5_4", run)
    found = only(table.frame, network="mobilenet_v2", weights="imagenet", mode="frozen", split="random")
    assert found["accuracy"] == pytest.approx(0.6, abs=0.01) and found["thesis"] == 0.4381
    assert found["above_chance"] == pytest.approx(found["accuracy"] - 0.125)
    line = only(table.shown, network="MobileNetV2", filters="frozen", passes=TEN, **{"starts from": "ImageNet"})
    assert line["furniture, touches at random, 80 px, 4 splits, %"].startswith("59.7 [") and line["thesis, %"] == "43.8"
    assert table.shown.loc[table.best_rows, "network"].tolist() == ["MobileNetV2"]


@pytest.mark.parametrize("table", ["table_5_4", "table_5_6"])
def test_a_note_says_what_the_networks_of_a_column_saw(bare, small, table):
    frame = rows().assign(precision="float32")
    later = frame["split"] == "random"
    frame.loc[later, ["size", "touches", "precision"]] = 128, 28, "float16"
    small.write(bare, "transfer", frame)
    made = build_one(transfer, "tables", table, small.results(bare))
    notes = " ".join(made.notes)
    assert f"furniture, touches at random: {LOOKED.format(28, 128)}; furniture, unseen obj" in notes
    assert f"furniture, unseen objects: {LOOKED.format(20, 80)}." in notes
    assert ("Guessing: furniture 12.5 %." in notes) == (table == "table_5_4")
    assert ("MobileNetV2 computed in float16." in made.notes) == (table == "table_5_4")


def test_the_coarse_table_holds_the_coarse_array_alone(run):
    frame = build_one(transfer, "tables", "table_5_3", run).frame
    found = only(frame, network="mobilenet_v2", weights="imagenet", mode="frozen", split="random")
    assert found["accuracy"] == pytest.approx(0.4, abs=0.01) and found["thesis"] == 0.2048


def test_networks_of_the_thesis_that_were_not_run_say_so(run):
    shown = build_one(transfer, "tables", "table_5_4", run).shown
    line = only(shown, network="ResNet50", filters="frozen", passes=TEN)
    assert line["furniture, unseen objects, 80 px, 4 folds, %"] == "not run" and line["thesis, %"] == "52.4"


def test_frozen_layers_go_by_the_thesis_s_numbers(run):
    frame = build_one(transfer, "tables", "table_5_6", run).frame
    assert only(frame, frozen_layers="18:139", split="random")["accuracy"] == pytest.approx(0.85, abs=0.01)
    assert only(frame, frozen_layers="none", split="random")["accuracy"] == pytest.approx(0.9, abs=0.01)
    assert np.isnan(only(frame, frozen_layers="1:150", split="random")["accuracy"])


def test_rows_on_the_thesis_s_classes_stand_beside_the_run_s(bare, run, small):
    small.write(bare, "transfer", rows("princeton_six"))
    shown = build_one(transfer, "tables", "table_5_4", small.results(bare)).shown
    assert "psb, the thesis's 6 classes, touches at random, 80 px, 4 splits, %" in shown


def test_trainings_until_nothing_improves_stand_below_those_of_the_printed_passes(bare, small):
    small.write(bare, "transfer", pd.concat([rows("princeton_six"), converged()]))
    made = build_one(transfer, "tables", "table_5_4", small.results(bare))
    found = only(made.frame, network="mobilenet_v2", weights="imagenet", mode="finetuned", split="random")
    assert found["accuracy"] == pytest.approx(0.9, abs=0.01) and found["converged"] == pytest.approx(0.96)
    assert found["converged_training"] == pytest.approx(0.99) and found["converged_epochs"] == 31
    assert np.isnan(found["training"]) and found["converged_values"] == 3
    head = "psb, the thesis's 6 classes, touches at random, 80 px, 4 splits, %"
    mine = made.shown[made.shown["network"] == "MobileNetV2"]
    mine = mine[(mine["starts from"] == "ImageNet") & (mine["filters"] == "fine-tuned")].set_index("passes")
    assert list(mine.index) == [TEN, "until nothing improves"]
    assert [cell[:2] for cell in mine[head]] == ["90", "96"]
    assert list(mine["training touches, %"]) == ["–", "99.0"]
    counts = made.shown["network"].value_counts()
    assert counts["VGG16"] == 2 and counts["MobileNetV2"] == 6  # a network without any training is named one time
    shown = build_one(transfer, "tables", "table_5_6", small.results(bare)).shown.set_index(["frozen layers", "passes"])
    late = shown.xs("until nothing improves", level="passes")[head]
    assert late["none"].startswith("96.0") and late["18:139"] == "not run" and "1:150" not in late


def test_passes_are_not_mixed(bare, small):
    small.write(bare, "transfer", pd.concat([rows("princeton_six"), converged()]))
    results = small.results(bare)
    gains = figure_5_3.gains(_transfer.everywhere(results, *_transfer.PASSES)["princeton_six"])
    assert only(gains, split="random", data="imprints128", passes="printed")["mean"] == pytest.approx(30, abs=1)
    assert only(gains, split="random", data="imprints128", passes="converged")["mean"] == pytest.approx(25)
    claim = next(one for one in chapter_5.CLAIMS if one.key == "tuned_over_frozen_random")
    claim = replace(claim, checked=False)
    assert differences(results, claim).mean() == pytest.approx(30, abs=1)
    late = {**claim.where, "passes": "converged"}
    assert differences(results, replace(claim, where=late)).mean() == pytest.approx(25)


@pytest.mark.slow
@pytest.mark.parametrize("figure", transfer.FIGURES)
def test_figures_are_drawn(run, figure):
    made = build_one(transfer, "figures", figure, run)
    assert made.paths[0].stat().st_size > 10_000


@pytest.mark.slow
def test_a_figure_tells_the_mean_change_of_each_network(run):
    assert (
        "Mean over the convolutions of a network: MobileNetV2 0.015 (furniture, 128 x 128, from ImageNet, 2 trainings)."
        in build_one(transfer, "figures", "figure_5_4", run).caption
    )


def test_gain_of_fine_tuning_is_paired(run):
    measured = _transfer.everywhere(run)["furniture"]
    gain = only(figure_5_3.gains(measured), network="mobilenet_v2", split="random", data="imprints128")
    assert gain["mean"] == pytest.approx(30, abs=1) and gain["low"] < gain["mean"] < gain["high"]


@pytest.mark.slow
def test_chart_costs_are_seconds_of_training(run):
    build_one(transfer, "tradeoff", "networks", run)
    frame = pd.read_csv(run.out / "tradeoff/networks.csv").set_index("name")
    assert frame.loc["MobileNetV2, ImageNet, fine-tuned", "cost_ratio"] == pytest.approx(6)


VERDICTS = {
    "tuned_over_frozen_random": "supported",
    "tuned_over_frozen_objects": "supported",
    "frozen_over_chance_random": "supported",
    "seen_over_random_tuned_random": "supported",
    "fine_over_coarse_frozen_random": "supported",
    "early_and_late_random": "supported",
    "frozen_coarse_by_chance_random": "contradicted",
}


@pytest.mark.slow
def test_claims_say_what_the_rows_hold(bare, small):
    small.write(bare, "transfer", taught(pd.concat([rows(), changes()])))
    judged = judge(chapter_5.CLAIMS, small.results(bare)).set_index("key")
    assert judged.loc[list(VERDICTS), "verdict"].to_dict() == VERDICTS
    small.write(bare, "transfer", pd.concat([rows(), changes()]))
    judged = judge(chapter_5.CLAIMS, small.results(bare)).set_index("key")
    assert judged.loc["tuned_over_frozen_random", "verdict"] == "not testable"  # nobody knows how far they were trained


def test_a_claim_turns_with_the_rows(bare, small):
    frame = rows()
    frame["mode"] = frame["mode"].map({"frozen": "finetuned", "finetuned": "frozen"}).fillna(frame["mode"])
    small.write(bare, "transfer", taught(frame))
    judged = judge(chapter_5.CLAIMS, small.results(bare)).set_index("key")
    assert judged.loc["tuned_over_frozen_random", "verdict"] == "contradicted"


def test_depth_is_compared_with_change(run):
    depth = next(one for one in chapter_5.CLAIMS if one.key == "earlier_change_more")
    assert differences(run, depth.on(None)).to_numpy() == pytest.approx([1, 1])


def test_without_trainings_nothing_is_made_up(bare, small):
    empty = small.results(bare)
    for kind, builders in KINDS.items():
        for name in set(getattr(transfer, builders)) - {"coarse_imprints"}:
            with pytest.raises(NotRun, match="transfer"):
                build_one(transfer, kind, name, empty)


def recorded():
    """Recorded touches: a frozen network and the classical features, and a data set that is not at hand."""
    one = {"dataset": "pressure_images", "data": "pressure", "item": None, "split": "random", "metric": "accuracy"}
    seen = {"method": "mobilenet_v2", "weights": "imagenet", "pretrained": "complete", "mode": "frozen", "size": 96}
    found = [one | seen | {"repetition": k, "value": 0.9 + 0.01 * k} for k in range(3)]
    found.append(one | {"method": "features_knn", "repetition": 0, "value": 0.6})
    missing = {
        "dataset": "vt60",
        "data": "vt60",
        "method": "alexnet",
        "weights": "imagenet",
        "mode": "frozen",
        "metric": "accuracy",
    }
    return pd.DataFrame([*found, missing | {"note": "not run: data set not at hand"}])


@pytest.mark.parametrize(("table", "figure"), [("table_5_1", "83.0"), ("table_5_5", "85.2")])
def test_a_data_set_that_is_not_at_hand_is_named(bare, small, table, figure):
    small.write(bare, "recorded_networks", recorded())
    made = build_one(recorded_topic, "tables", table, small.results(bare))
    line = only(made.shown, network="AlexNet")
    assert line["fine-tuned: ours, %"] == "not run" and line["fine-tuned: thesis, %"] == figure
    assert "Not run" in made.notes[0]


def test_the_coarse_array_is_told_one_change_at_a_time(bare, small):
    base = {"cells": 16, "weights": "imagenet", "size": 80, "chance": 0.125, "metric": "accuracy"}
    levels = {"rate_of_table_5_3": 0.2, "plain": 0.6}
    found = [base | {"setting": s, "repetition": k, "value": v + 0.01 * k} for s, v in levels.items() for k in range(3)]
    small.write(bare, "coarse_imprints", pd.DataFrame(found), "furniture")
    shown = build_one(transfer, "tables", "coarse_imprints", small.results(bare)).shown
    assert list(shown["what differs"]) == [tables.SETTINGS[name] for name in ("plain", "rate_of_table_5_3")]
    assert shown["accuracy, %"][0].startswith("61.0 [")


@pytest.mark.slow
def test_the_smallest_network_that_is_enough_is_named(bare, small):
    found = [
        {"data": "pressure", "item": None, "method": name, "weights": "imagenet", "mode": "frozen", "split": "blocks"}
        | {"pretrained": "complete", "size": 96, "repetition": k, "metric": "accuracy", "value": level + 0.001 * k}
        for name, level in (("mobilenet_v2", 0.9), ("vgg16", 0.91), ("alexnet", 0.7)) for k in range(3)
    ]  # fmt: skip
    sizes = {"mobilenet_v2": 2e6, "vgg16": 15e6, "alexnet": 1e6}
    costs = [
        {"network": n, "size": 96, "parameters": s, "operations": s, "milliseconds": 1.0} for n, s in sizes.items()
    ]
    small.write(bare, "recorded_networks", pd.DataFrame(found), "pressure_images")
    write_table(bare / "reports/bench/networks.csv", pd.DataFrame(costs))
    made = build_one(recorded_topic, "tradeoff", "network_sizes", small.results(bare))
    assert "best on average is MobileNetV2." in made.caption

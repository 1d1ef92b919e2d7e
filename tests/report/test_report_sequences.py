"""Table 4.9, figure 4.19, the layers, the chart and the claims of whole contours."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.report import sequences
from stages.report.sequences.contours import SHOWN
from stages.report.sequences.tables import MORE, PRINTED_SET, SAID, SPLITS
from stages.report.topics import build_one
from tests.report.frames import only, verdicts

CLASSES = ("car", "chair", "vase")
MEANS = {"cnn": 0.9, "cnn_images": 0.8, "cnn_normals": 0.4, "knn": 0.6, "svm": 0.7, "knn_no_som": 0.65,
         "svm_no_som": 0.75}  # fmt: skip
SECONDS = {"cnn": 60.0, "cnn_images": 58.0, "cnn_normals": 2.0}


def rows(guided=0.08, unseen=-0.2, folds=3, splits=("random", "objects"), dataset="furniture", known=True):
    """Rows whose truth is known: guided is better by a margin, unseen objects are harder, smaller films are worse.

    known: whether rows say that the networks know their training part.
    """
    random, entries = np.random.default_rng(0), []
    films = [(25, 32, 0.0), (13, 32, -0.05), (25, 16, -0.01)]
    for method, gain in (("random", 0.0), ("thesis_ssim", guided), ("glance", guided)):
        for frames, cells, loss in films if method == "thesis_ssim" else films[:1]:
            for split in splits if loss == 0 else splits[-1:]:
                for name, mean in MEANS.items():
                    common = {"dataset": dataset, "method": method, "split": split, "classifier": name}
                    common |= {"frames": frames, "cells": cells, "classes": len(CLASSES), "sequences": 900}
                    level = mean + gain + loss + (unseen if split == "objects" else 0.0)
                    for number in range(folds):
                        by_class = level + 0.005 * random.normal(size=len(CLASSES))
                        seconds = SECONDS.get(name, 5.0) * frames / 25
                        entry = common | {"repetition": number, "training": 0, "metric": "accuracy", "group": None}
                        entries.append(entry | {"value": by_class.mean(), "seconds": seconds})
                        if known and name.startswith("cnn_"):
                            entries += [entry | {"metric": "train_accuracy", "value": 1.0}]
                            entries += [entry | {"metric": "passes", "value": 10}]
                        if split == "objects":
                            entries += [entry | {"metric": "accuracy_object", "group": label, "value": value}
                                      for label, value in zip(CLASSES, by_class, strict=True)]  # fmt: skip
    return pd.DataFrame(entries).assign(seed=0, note=None)


@pytest.fixture(scope="module")
def run(measure):
    """Results of a run that has measured the sequences."""
    return measure("sequences", rows())


table_4_9 = partial(build_one, sequences, "tables", "table_4_9")


def test_twin_stands_beside_the_thesis_s_figures(run):
    table = table_4_9(run)
    row = only(table.frame, split="random", classifier="cnn", strategy="thesis_ssim")
    assert row["accuracy"] == pytest.approx(0.98, abs=0.01) and row["thesis"] == 0.9897
    assert only(table.frame, split="random", classifier="svm", strategy="random")["thesis"] == 0.7721
    assert np.isnan(only(table.frame, split="objects", classifier="cnn", strategy="thesis_ssim")["thesis"])
    assert np.isnan(only(table.frame, split="random", classifier="cnn", strategy="glance")["thesis"])
    line = only(table.shown, objects="the thesis", split="sequences drawn at random", classifier="CNNs")
    assert line["thesis, SSIM, %"] == "99.0" and line["glance, %"] == "–"
    assert "Guessing: furniture 33.3 %." in " ".join(table.notes)
    counts = [only(table.frame, split=split, classifier="cnn", strategy="random")["values"] for split in SPLITS]
    assert dict(zip(SPLITS, counts, strict=True)) == {"random": 3, "objects": 9}  # of unseen objects over these
    assert len(table.frame) == 2 * 3 * len(MEANS)  # without smaller films


def test_larger_run_stands_below_where_there_is_one(measure):
    note = {"dataset": "furniture", "metric": "accuracy", "note": "class far: no sequences of away"}
    frame = pd.concat([rows(splits=("random",)), pd.DataFrame([note])], ignore_index=True)
    results = measure("sequences", frame)
    table = table_4_9(results)
    assert set(table.frame["split"]) == {"random"}  # one half, without objects left out
    assert "Not run: class far: no sequences of away." in table.notes
    table = table_4_9(measure("sequences", rows(dataset="princeton_eight"), results=results))
    assert list(dict.fromkeys(table.frame["objects"])) == ["furniture", "princeton_eight"]
    assert list(dict.fromkeys(table.shown["objects"])) == ["furniture", "psb, the thesis's 8 classes", "the thesis"]


def test_passes_and_known_training_sequences_are_said_of_the_sets_that_measured_them(measure):
    trained = [
        {"classifier": name, "metric": metric, "value": value, "frames": 25, "cells": 32, "method": "random"}
        for name, passes, known in (("cnn_images", 50, 0.999), ("cnn_normals", 85, 0.96), ("cnn_normals", 91, 0.97))
        for metric, value in (("passes", passes), ("train_accuracy", known))
    ]
    trained += [row | {"frames": 13, "value": 7} for row in trained]  # nothing is said of the smaller sequences
    frame = pd.concat([rows(known=False), pd.DataFrame(trained).assign(dataset="furniture")])
    results = measure("sequences", frame)
    notes = " ".join(table_4_9(results).notes)
    assert "furniture 50 of the 3D network (100 %), 88 of the 1D network (96 %)" in notes


@pytest.mark.slow
def test_chart_charges_each_choice_its_seconds(run):
    figure = build_one(sequences, "tradeoff", "sequences", run)
    frame = pd.read_csv(figure.paths[1]).set_index("name")
    assert len(frame) == 3 * len(SHOWN) - 1  # the normals do not change with the cells
    assert frame.loc["kNN, 25 x 32 x 32", "cost_ratio"] == 1
    assert frame.loc["CNNs, 25 x 32 x 32", "cost_ratio"] == pytest.approx(12)
    assert frame.loc["CNNs, 25 x 32 x 32", "mean"] == pytest.approx(0.78, abs=0.01)


def test_layers_stand_beside_the_printed_ones(measure):
    layers = [
        {"classifier": network, "layer": layer, "kind": "Conv3d", "output": "8x5", "metric": "parameters", "value": 7}
        for network, layer in SAID
    ]
    results = measure("sequences", pd.DataFrame(layers), "furniture")
    table = build_one(sequences, "tables", "table_4_7", results)
    assert (table.frame["thesis"] != "").all() and "3D 42; 1D 42" in table.notes[-1]


def everywhere(measure, frame):
    """The results with these rows as printed and on the other data sets."""
    return measure("sequences", pd.concat(frame.assign(dataset=name) for name in (PRINTED_SET, *MORE)))


judged = partial(verdicts, sequences.CLAIMS)


@pytest.mark.slow
def test_claims_that_hold_are_supported(measure):
    table = judged(everywhere(measure, rows()))
    words = table["verdict"].to_dict()
    for key in ("contours_map_helps_random", "contours_map_helps_unseen"):
        assert words.pop(key) == words.pop(f"{key}_more") == "contradicted"
    assert set(words.values()) == {"supported"}
    assert table.loc["contours_guided_unseen", ["pairs", "units"]].tolist() == [9, 3]  # as printed
    assert table.loc["contours_guided_unseen_more", ["pairs", "units"]].tolist() == [18, 6]  # of two sets
    assert table.loc["contours_cnn_best_unseen", "effect"] == pytest.approx(20, abs=1)  # over those with the map
    assert "without the map, too: supported +14" in table.loc["contours_cnn_best_unseen", "readings"]
    assert table.loc["contours_random_flatters", "effect"] == pytest.approx(20, abs=1)


def test_claims_that_do_not_hold_are_contradicted_and_a_rival_without_the_map_is_another_reading(measure):
    frame = rows(guided=-0.05, unseen=0.05)
    frame.loc[frame["classifier"] == "knn_no_som", "value"] = 1.2
    wanted = dict.fromkeys(("contours_guided_random", "contours_guided_unseen", "contours_random_flatters"),
                           "contradicted")  # fmt: skip
    wanted["contours_cnn_best_unseen"] = "depends on the reading"
    assert judged(everywhere(measure, frame), *wanted)["verdict"].to_dict() == wanted


def test_an_untrained_network_spoils_no_other_training_of_its_objects(measure):
    frame = pd.concat([rows(known=False).assign(training=number) for number in range(2)])
    networks = frame[frame["classifier"].isin(["cnn_images", "cnn_normals"]) & (frame["metric"] == "accuracy")]
    known = networks.assign(metric="train_accuracy", value=1.0)
    known.loc[(known["training"] == 0) & (known["repetition"] == 0) & (known["split"] == "objects"), "value"] = 0.5
    results = everywhere(measure, pd.concat([frame, known]))
    row = judged(results, "contours_guided_unseen_more").iloc[0]
    assert row["pairs"] == 18 and row["verdict"] == "supported"
    assert row["validity"].startswith("psb, 8 classes of 6 objects: 3 of 18 pairs invalid: training stopped before")

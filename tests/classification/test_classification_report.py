"""Tables and figures of one touch and several that the published rows do not have."""

import re
from functools import partial
from itertools import combinations

import numpy as np
import pandas as pd
import pytest

from stages.charts.datasets import SETS_4_2
from stages.charts.results import NotRun
from stages.charts.tables import THESIS, WHOSE
from stages.classification import report as touch
from stages.classification.recognition_tables import (
    COMMON,
    METHODS,
    PRINTED,
    SSIM,
    accuracies,
    recognition,
    shared_objects,
)
from stages.report.parts import build_item, build_part

GLANCE = {
    "plain": 0.6, "first_15": 0.5, "locations": 0.8, "first_15_locations": 0.7, "locations_turned": 0.4,
    "selected": 0.7, "selected_train": 0.5, "first_15_selected": 0.6, "first_15_selected_train": 0.4,
    "touches_1": 0.6, "touches_2": 0.7, "touches_3": 0.8, "touches_5": 0.99, "touches_5_mixed": 1.0,
    "touches_3_disjoint": 0.6, "touches_5_disjoint": 0.3, "first_15_touches_2_mixed": 0.9,
    "image_features": 0.4, "pixels": 0.55, "wavelet_features": 0.5,
}  # fmt: skip
SHARES = {"random": 0.6, "itti": 0.5}


def rows(best="VisAttAll", dataset=PRINTED):
    """Accuracies as in GLANCE at every sampling, with the least noise; shares as in SHARES, 0.3 at the best."""
    random, entries = np.random.default_rng(0), []
    for objects in ("six", "four"):
        for method, share in (SHARES | {best: 0.3}).items():
            common = {"group": objects, "method": method, "note": None}
            for variant, accuracy in GLANCE.items():
                for classifier in ("knn", "deep_learning", "naive_bayes"):
                    for repetition in range(6):
                        row = common | {"variant": variant, "classifier": classifier, "repetition": repetition}
                        row |= {"imprints": 360, "seconds": 0.01, "scaling": "training"}
                        value = min(accuracy + 0.002 * random.normal(), 1.0)
                        right = row | {"metric": "accuracy"}
                        entries += [right | {"split": "random", "value": value}]
                        regions = right | {"split": "regions"}
                        entries += [regions | {"value": value - (0.2 if variant in ("plain", "selected") else 0.1)}]
                        if variant == "plain":
                            entries += [regions | {"variant": "plain_side", "value": value - 0.1}]
            for variant in ("plain", "first_15"):
                for k, of in enumerate((None, "cup", "duck", "hand")):
                    about = common | {"variant": variant, "item": of, "metric": "similar_share", "imprints": 60}
                    entries.append(about | {"value": share + 0.1 * k * share + (0 if variant == "plain" else 0.1)})
            for variant in ("plain", "image_features", "wavelet_features"):
                entries.append(common | {"variant": variant, "metric": "features", "value": 41, "seconds": 0.02})
    return pd.DataFrame(entries).assign(dataset=dataset, seed=0)


def drawn(dataset):
    """The same rows as if each repetition were a random set of objects, with the shares of each."""
    frame, numbers = rows(dataset=dataset), range(1, 7)
    shares = frame[frame["repetition"].isna()]
    sets = [shares.assign(set=number, value=shares["value"] * (1 + 0.01 * number)) for number in numbers]
    return pd.concat([frame.dropna(subset=["repetition"]).assign(set=lambda row: row["repetition"] + 1), *sets])


table = partial(build_item, touch, "tables")


@pytest.mark.slow
def test_a_run_of_random_sets_alone_has_the_tables_of_sets_and_says_that_the_others_are_not_run(measure):
    results = measure("classification", drawn(SETS_4_2[0]).replace({"method": {"VisAttAll": "glance"}}))
    assert table("table_4_1", results).shown["protocol"].iloc[0] == "as printed, 6 random sets, 15 imprints"
    for name in ("table_4_3", "section_4_2_4"):
        with pytest.raises(NotRun):
            table(name, results)


def test_a_folder_of_ones_own_has_recognition_of_its_groups_with_intervals_and_no_other_run_has(root, small):
    frame = small.classification().query("group == 'six'").assign(group="mine")
    regions = frame[frame["method"] == "glance"].assign(split="regions", value=frame["value"] - 0.3)
    noted = pd.DataFrame([{"dataset": "test", "group": "four", "metric": "accuracy", "note": "set four left out"}])
    small.write_measurements(
        root, "classification", pd.concat([frame, regions, frame.assign(variant="touches_2"), noted])
    )
    small.write_set(root, "mine", 3)
    with pytest.raises(NotRun, match="groups of the thesis"):
        recognition(small.read_results(root))
    built = table("recognition", small.own_results(root))
    cells = built.frame.set_index(["group", "split", "sampling", "classifier"]).loc["mine"]
    assert len(cells) == 10 and (cells["repetitions"] == 6).all()
    assert cells.loc[("random", "glance", "knn"), "accuracy"] == pytest.approx(0.8, abs=0.02)
    unseen = cells.loc[("regions", "glance", "knn")]
    assert unseen["low"] < unseen["accuracy"] == pytest.approx(0.5, abs=0.02) and unseen["high"] > unseen["accuracy"]
    shown = built.shown.set_index(["group", "tested on", "places"])["kNN, %"]
    place = "3 objects (group mine)", "regions that no training touch overlaps", "glance"
    assert re.match(r"(49|50|51) \[", shown[place]) and "Not run: set four left out." in built.notes


def test_random_sets_count_the_objects_that_they_share():
    for name, common in COMMON.items():
        columns = ["set", "group", "metric", "item"]
        shares = pd.read_csv(f"reports/measurements/{name}/classification.csv.gz", usecols=columns, low_memory=False)
        shares = shares[(shares["metric"] == "similar_share") & (shares["group"] == "six")].dropna(subset=["item"])
        hands = shares.groupby("set")["item"].agg(set)
        overlaps = [len(first & second) / 6 for first, second in combinations(hands, 2)]
        assert np.mean(overlaps) == pytest.approx(common, abs=5e-5)
        assert shared_objects(name) == pytest.approx(common / (1 - common))
    first = next(iter(COMMON))
    assert shared_objects(first, "another") == 0 < shared_objects(first, first, "another") < shared_objects(first)


def test_a_split_that_no_random_set_was_measured_by_has_no_accuracy():
    rows = pd.DataFrame({"dataset": "a", "set": [1, 2], "split": "random", "metric": "accuracy", "value": [0.4, 0.6]})
    rows = pd.concat([rows, rows.assign(set=None, split="folds", value=[0.7, 0.9])])
    assert accuracies(rows)["accuracy"] == 0.5 and accuracies(rows)["accuracy_folds"] == pytest.approx(0.8)
    assert np.isnan(accuracies(rows, "regions")["accuracy"])


def test_table_holds_every_cell_of_the_thesis(results):
    built = table("table_4_1", results)
    assert built.sets == ["test"]
    frame = built.frame
    methods = METHODS | {"enhanced_visual_attention": SSIM}  # in our protocol
    thesis = results.thesis("table_4_1_six_virtual_objects").set_index("sampling").rename(index=methods)
    theirs = frame[frame["sampling"].isin(thesis.index)]
    means = theirs[theirs["classifier"].str.startswith("mean")]
    theirs = theirs.drop(means.index)
    assert len(theirs) == thesis.size and means["accuracy"].isna().all()  # two of five classifiers were run
    assert means["thesis"].iloc[1] == pytest.approx(thesis.iloc[0].drop("svm").mean())
    assert frame.loc[~frame["sampling"].isin(thesis.index), "sampling"].unique().tolist() == ["glance"]  # ours, below
    for row in theirs.itertuples():
        assert row.thesis == thesis.loc[row.sampling, row.classifier]


def test_table_maps_the_methods_and_says_what_was_not_run(root, results, small):
    built = table("table_4_1", results)
    cell = built.frame.set_index(["sampling", "classifier"])
    assert cell.loc[("thesis_ssim", "knn"), "accuracy"] == pytest.approx(0.8, abs=0.02)
    assert cell.loc[("itti", "knn"), "accuracy"] == pytest.approx(0.5, abs=0.02)
    assert np.isnan(cell.loc[("glance", "knn"), "thesis"])
    assert np.isnan(cell.loc[("heat_kernel", "knn"), "accuracy"])
    shown = built.shown.set_index("touched at")
    ours, printed = (cells for _, cells in shown.loc["heat kernel signature"].iterrows())
    assert (ours.drop(["protocol", WHOSE]) == "not run").all()
    assert printed[WHOSE] == THESIS and printed["kNN, %"] == "59"
    assert built.title.startswith("Table 4.1: recognising six objects by")
    small.write_set(root, "six", 4)
    assert table("table_4_1", results).title.startswith("Table 4.1: recognising 4 objects (group six) by")


def test_left_out_sampling_is_a_note_of_its_table(root, small):
    frame = small.left_out(small.classification(), "too few touches", group="six", method="itti")
    small.write_measurements(root, "classification", small.left_out(frame, "no cup", group="four"))
    built = build_part(touch, small.read_results(root), ["tables"])
    made = next(item for item in built.items if item.name == "table_4_1")
    assert "Not run: too few touches." in made.notes
    assert np.isnan(made.frame.set_index(["sampling", "classifier"]).loc[("itti", "knn"), "accuracy"])
    assert built.not_run["tables/table_4_2"] == "no cup"

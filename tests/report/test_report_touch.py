"""The report on one touch and several: tables 4.3, 4.5, 4.6, the shares, figure 4.4, claims and the chart."""

import re
from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.report import touch
from stages.report.results import SETS_4_2, NotRun
from stages.report.tables import CLASSIFIERS
from stages.report.topics import build_one
from stages.report.touch import claims, pictures, touches
from stages.report.touch.rows import PRINTED
from tests.report.frames import verdicts

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
                        if variant in ("plain", "selected"):
                            entries += [regions | {"value": value - 0.2}]
                            entries += [row | {"metric": "recall", "split": "random", "value": value - 0.01}]
                        else:
                            entries += [regions | {"value": value - 0.1}]
                        if variant == "plain":
                            entries += [regions | {"variant": "plain_side", "value": value - 0.1}]
            for variant in ("plain", "first_15"):
                for k, of in enumerate((None, "cup", "duck", "hand")):
                    entries.append(common | {"variant": variant, "item": of, "metric": "similar_share", "imprints": 60})
                    entries[-1]["value"] = share + 0.1 * k * share + (0 if variant == "plain" else 0.1)
            for variant in ("plain", "image_features", "wavelet_features"):
                entries.append(common | {"variant": variant, "metric": "features", "value": 41, "seconds": 0.02})
    return pd.DataFrame(entries).assign(dataset=dataset, seed=0)


def drawn(dataset):
    """The same rows as if each repetition were a random set of objects, with the shares of each."""
    frame, numbers = rows(dataset=dataset), range(1, 7)
    shares = frame[frame["repetition"].isna()]
    sets = [shares.assign(set=number, value=shares["value"] * (1 + 0.01 * number)) for number in numbers]
    return pd.concat([frame.dropna(subset=["repetition"]).assign(set=lambda row: row["repetition"] + 1), *sets])


@pytest.fixture(scope="module")
def glance(measure):
    """Results with all variants."""
    return measure("classification", pd.concat([rows(), *map(drawn, SETS_4_2), rows("glance", "test")]))


def scaled(scaling, gain):
    """The same rows by another scaling, with all five classifiers, the SVM dead where the gain is 0."""
    frame = drawn(SETS_4_2[0]).dropna(subset=["classifier"])
    knn = frame[frame["classifier"] == "knn"]
    others = [knn.assign(classifier=name, value=knn["value"] * (name != "svm" or gain > 0))
              for name in ("svm", "decision_tree")]  # fmt: skip
    return pd.concat([frame, *others]).assign(scaling=scaling)


table = partial(build_one, touch, "tables")


@pytest.mark.slow
def test_a_run_of_random_sets_alone_has_the_tables_of_sets_and_says_that_the_others_are_not_run(measure):
    results = measure("classification", drawn(SETS_4_2[0]).replace({"method": {"VisAttAll": "glance"}}))
    assert claims.by_features(results).frame["seconds"].max() == pytest.approx(0.01 + 0.02)  # the mean of the sets
    assert table("table_4_1", results).shown["protocol"].iloc[0] == "as printed, 6 random sets"
    for name in ("table_4_3", "section_4_2_4"):
        with pytest.raises(NotRun):
            table(name, results)


@pytest.mark.slow
def test_twin_shows_the_regions_and_the_first_fifteen(glance):
    shown = table("table_4_1", glance).shown
    protocols = ["as printed", "as printed, 18 random sets", "ours"]
    below = [f"{name}, unseen regions" for name in protocols]
    assert shown["protocol"].unique().tolist() == [*protocols, *below, "the thesis"]
    knn = shown.set_index(["protocol", "sampling"])["kNN, %"]
    attention = [knn[protocol, "thesis, equal weights"] for protocol in (protocols[0], below[0], "the thesis")]
    assert attention[0].startswith("60 [") and attention[1:] == ["40", "73"]
    assert knn["as printed", "blind touch, 15 imprints"].startswith("50 [")
    assert ("the thesis", "blind touch, 15 imprints") not in knn and knn.index.is_unique


@pytest.mark.slow
def test_positions_stand_beside_the_thesis_with_the_side_held_out(glance):
    built = table("table_4_5", glance)
    cells = built.frame.set_index(["protocol", "sampling", "classifier"])
    cell = cells.loc["as printed", "VisAttAll", "knn"]
    assert cell["accuracy"] == pytest.approx(0.8, abs=0.01) and cell["thesis"] == 0.85
    assert cell["accuracy_regions"] == pytest.approx(0.7, abs=0.01) and "one side" in built.notes[1]


@pytest.mark.slow
def test_selection_has_a_column_for_each_group_and_way(glance):
    built = table("table_4_3", glance)
    cells = built.frame.set_index(["protocol", "classifier", "objects", "selection"]).loc["as printed"]
    assert cells.loc[("knn", "six", "selected"), "thesis"] == 0.76
    assert cells.loc[("knn", "four", "plain"), "thesis"] == 0.78
    assert np.isnan(cells.loc[("knn", "six", "selected_train"), "thesis"])
    assert cells.loc[("knn", "six", "selected"), "recall"] == pytest.approx(0.69, abs=0.01)
    assert cells.loc[("knn, 15 imprints", "six", "selected"), "accuracy"] == pytest.approx(0.6, abs=0.01)
    assert built.shown.shape[1] == 10 and "kNN, 15 imprints" in set(built.shown["classifier"])
    printed = built.shown.set_index(["protocol", "classifier"]).loc[("the thesis", "kNN")]
    assert printed["six, selection, %"] == "76" and printed["six, selection in training alone, %"] == "–"


def test_selection_that_was_not_run_says_why(measure):
    frame = rows()[lambda row: row["variant"] != "selected"]
    note = {"group": "six", "method": "VisAttAll", "variant": "selected", "note": "an object keeps too few"}
    with pytest.raises(NotRun, match="an object keeps too few"):
        table("table_4_3", measure("classification", pd.concat([frame, pd.DataFrame([note])]), PRINTED))


def test_shares_stand_beside_those_of_the_thesis_by_sampling_and_by_object(glance):
    frame = table("section_4_2_4", glance).frame.set_index(["protocol", "name"]).loc["as printed"]
    assert frame.loc["random", ["all", "thesis"]].tolist() == pytest.approx([0.6, 0.5889])
    assert frame.loc["VisAttAll", "first_15"] == pytest.approx(0.4)
    assert frame.loc["duck", "thesis"] == 0.4 and frame.loc["duck", "all"] == pytest.approx(0.36)


@pytest.mark.slow
def test_table_of_touches_holds_the_thesis_and_the_other_ways(glance):
    built = table("table_4_6", glance)
    cells = built.frame.set_index(["protocol", "sampling", "way", "classifier", "touches"]).loc["as printed"]
    assert cells.loc[("VisAttAll", "", "knn", 2), "thesis"] == 0.96
    assert np.isnan(cells.loc[("random", "", "knn", 2), "thesis"])
    assert cells.loc[("VisAttAll", "first_15_mixed", "knn", 2), "accuracy"] == pytest.approx(0.9, abs=0.01)
    thesis = built.shown.set_index(["protocol", "classifier"]).loc[("the thesis", "deep learning")]
    assert thesis["5 touches, %"] == "46"
    shown = built.shown[built.shown["protocol"] == "as printed"].set_index("classifier")
    assert "kNN, combinations drawn before the split" in shown.index
    assert "kNN, combinations drawn before the split, blind touch" in shown.index


@pytest.mark.slow
def test_readings_stand_below_with_means_that_leave_out_the_svm(measure):
    rows_by = [scaled("training", 0.0), scaled("min_max", 0.1)]
    frame = pd.concat([drawn(SETS_4_2[0]), *rows_by]).drop_duplicates()
    results = measure("classification", frame[frame["variant"].str.contains("plain|touches")])
    shown = table("table_4_1", results).shown
    protocols = ["as printed, 6 random sets", "as printed, 6 random sets: all data from 0 to 1"]
    assert [name for name in shown["protocol"].unique() if "6 random" in name and "unseen" not in name] == protocols
    cells = shown.set_index(["protocol", "sampling"])
    dead, alive = (cells.loc[(name, "thesis, equal weights")] for name in protocols)
    assert dead["SVM, %"].startswith("0") and alive["SVM, %"].startswith("60 [")
    assert dead["mean of all, %"].startswith("48 [") and alive["mean of all, %"].startswith("60 [")
    assert dead["mean without the SVM, %"][:4] == alive["mean without the SVM, %"][:4] == "60 ["
    joined = table("table_4_6", results).shown.set_index(["protocol", "classifier"])
    assert joined.loc[(protocols[0], "mean of all"), "5 touches, %"].startswith("79 [")
    assert joined.loc[(protocols[1], "mean of all"), "5 touches, %"].startswith("99 [")
    assert joined.loc[(protocols[0], "SVM, combinations drawn before the split"), "5 touches, %"].startswith("0")
    assert joined.loc[("the thesis", "mean without the SVM"), "5 touches, %"] == "85"


VERDICTS = {
    "selection_helps": "supported", "locations_help": "supported", "more_touches": "supported",
    "certain_at_five": "supported", "network_dips_disjoint": "depends on the reading", "dissimilar_random": "supported",
    "dissimilar_itti_first_15": "supported", "selection_helps_train": "contradicted",
    "locations_help_turned": "contradicted", "network_dips": "contradicted",
}  # fmt: skip


@pytest.mark.slow
def test_claims_follow_the_measurements(glance):
    judged = verdicts(claims.CLAIMS, glance, *VERDICTS)
    assert judged["verdict"].to_dict() == VERDICTS
    assert judged.loc["more_touches", "effect"] == pytest.approx(39, abs=1)


@pytest.mark.slow
def test_chart_counts_the_making_of_the_features(glance):
    frame = pd.read_csv(build_one(touch, "tradeoff", "touches", glance).paths[1]).set_index("name")
    assert frame.loc["kNN, 41 features", "seconds"] == pytest.approx(0.03)
    assert frame.loc["kNN, pixels", "seconds"] == pytest.approx(0.01)
    assert frame.loc["kNN, 5 touches, map and position", "cost_ratio"] == pytest.approx(1)


@pytest.mark.slow
def test_a_classifier_that_the_thesis_does_not_have_stands_in_tables_and_figure(root, small, monkeypatch):
    ours = rows("glance", "test")
    added = ours[ours["classifier"] == "knn"].assign(classifier="centroid")
    small.write(root, "classification", pd.concat([ours, added]))
    results, bars = small.results(root), []
    monkeypatch.setattr(touches, "draw_bars", lambda axes, frame, classifiers, **_: bars.append(classifiers))
    monkeypatch.setattr(touches.plt.Axes, "legend", lambda *_, **__: None)
    for name in ("table_4_1", "table_4_6"):
        frame = table(name, results).frame
        cells = frame[(frame["classifier"] == "centroid") & (frame["sampling"] == "glance")]
        assert cells["accuracy"].notna().any() and cells["thesis"].isna().all()
    build_one(touch, "figures", "table_4_1", results)
    assert bars == [[*CLASSIFIERS, "centroid"]]


def test_bars_are_of_the_samplings_that_ran_with_chance_by_the_objects_of_the_group(root, small, monkeypatch):
    rows, drawn, draw = small.classification(), {}, touches.draw_bars

    def noted(axes, *rest, chance, **other):
        drawn.update(axes=axes, chance=chance, places=draw(axes, *rest, chance=chance, **other))
        return drawn["places"]

    monkeypatch.setattr(touches, "draw_bars", noted)
    small.write(root, "classification", rows[rows["method"] != "thesis_ssim"])
    small.write_set(root, "six", 4)
    build_one(touch, "figures", "table_4_1", small.results(root))
    assert drawn["chance"] == 1 / 4 and list(drawn["places"]) == ["random", "itti", "glance"]
    assert sum(drawn["places"].values()) == pytest.approx(0) and set(pictures.NEEDED) <= set(drawn["places"])
    title = drawn["axes"].get_title(loc="left") + drawn["axes"].get_title()
    assert title == "Recognising 4 objects (group six) by one touch, ours"


def test_a_folder_of_ones_own_has_recognition_of_its_groups_with_intervals_and_no_other_run_has(root, small):
    frame = small.classification().query("group == 'six'").assign(group="mine")
    regions = frame[frame["method"] == "glance"].assign(split="regions", value=frame["value"] - 0.3)
    noted = pd.DataFrame([{"dataset": "test", "group": "four", "metric": "accuracy", "note": "set four left out"}])
    small.write(root, "classification", pd.concat([frame, regions, frame.assign(variant="touches_2"), noted]))
    small.write_set(root, "mine", 3)
    with pytest.raises(NotRun, match="groups of the thesis"):
        touches.recognition(small.results(root))
    built = table("recognition", small.own(root))
    cells = built.frame.set_index(["group", "split", "sampling", "classifier"]).loc["mine"]
    assert len(cells) == 10 and (cells["repetitions"] == 6).all()
    assert cells.loc[("random", "glance", "knn"), "accuracy"] == pytest.approx(0.8, abs=0.02)
    unseen = cells.loc[("regions", "glance", "knn")]
    assert unseen["low"] < unseen["accuracy"] == pytest.approx(0.5, abs=0.02) and unseen["high"] > unseen["accuracy"]
    shown = built.shown.set_index(["group", "tested on", "places"])["kNN, %"]
    place = "3 objects (group mine)", "regions that no training touch overlaps", "glance"
    assert re.match(r"(49|50|51) \[", shown[place]) and "Not run: set four left out." in built.notes

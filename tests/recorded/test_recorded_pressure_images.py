"""Recognition of real touches: what is held out, what is selected, and what neighbours have in common."""

import numpy as np
import pandas as pd
import pytest

from stages.recorded import pressure_images
from stages.recorded.pressure_images import class_sets, describe, process
from stages.recorded.splits import block_split, split_number


@pytest.fixture
def recognised(monkeypatch, tmp_path):
    """A function from images and names of sets, none for all, to their rows, two repetitions of one classifier."""
    monkeypatch.setattr(pressure_images, "CLASSIFIERS", ["knn"])

    def rows(images, *names):
        touches = describe(images)
        sets = class_sets(touches, repetitions=2, seed=0)
        return pd.DataFrame([row for name in names or sets for row in process(sets[name], tmp_path, touches, seed=0)])

    return rows


@pytest.mark.slow
def test_bars_at_places_of_their_own_are_recognised_and_none_is_left_out(recognised, recordings):
    rows = recognised(recordings.touches(noise=0.01))
    accuracy = rows[rows["metric"] == "accuracy"]
    assert accuracy.loc[accuracy["split"] == "random", "value"].min() > 0.5  # chance is a quarter at most
    assert (rows.loc[rows["metric"] == "share_similar", "value"] == 0).all()
    assert set(rows["group"]) == {"all", *(f"{n}{end}" for n in ("six", "four") for end in ("", "_alike", "_drawn"))}
    assert rows.loc[rows["group"] == "four", "chosen"].dropna().tolist() == ["a b c d"]
    assert set(accuracy["split"]) == {"random", "blocks", "folds"}
    scalings = accuracy.groupby(["group", "method", "split"])["scaling"].unique().map(list)
    assert scalings["six_alike", "all", "random"] == ["training", "beforehand", "components", "min_max"]
    assert scalings["six_drawn", "selected_control", "random"] == ["training", "beforehand", "min_max"]
    assert scalings["six", "all", "random"] == scalings["six", "all", "blocks"] == ["training"]
    assert scalings["all", "all", "blocks"] == scalings["six_alike", "all", "random"]
    assert scalings["all", "unreduced", "blocks"] == ["training", "beforehand", "min_max"]
    dead = rows[rows["metric"].isin(["train_accuracy", "commonest_share"])]
    assert set(dead["split"]) == {"random"} and set(dead["method"]) == {"all"}
    assert dead["value"].between(1 / 7, 1).all()  # of seven classes
    assert set(accuracy.loc[accuracy["group"] == "six_drawn", "split"]) == {"random", "blocks"}


@pytest.mark.slow
def test_touches_that_resemble_another_class_leave_training_or_the_whole_set(recognised, recordings):
    images = recordings.touches(noise=0.1, count=24)
    images["a"][::2], images["b"][::2] = images["a"][::2].transpose(0, 2, 1), images["a"][1::2].transpose(0, 2, 1)
    rows = recognised(images, "all", "four_alike")
    whole = rows[(rows["group"] == "all") & (rows["metric"] == "accuracy") & (rows["split"] == "random")]
    whole = whole.set_index("method")
    assert whole.loc["selected", "test"].max() < whole.loc["all", "test"].min()  # the test part shrinks as well
    assert set(whole.loc["selected_control", "test"]) == set(whole.loc["selected", "test"])
    assert set(whole.loc["selected_training", "test"]) == set(whole.loc["all", "test"])
    assert whole.loc["selected_training", "train"].max() < whole.loc["all", "train"].min()
    right = rows[(rows["group"] == "all") & (rows["method"] == "all") & (rows["metric"] == "accuracy")]
    assert right[right["split"] == "random"].groupby("scaling")["value"].mean().nunique() > 1
    similar = rows[(rows["group"] == "four_alike") & (rows["metric"] == "share_similar")]
    assert similar["chosen"].str.startswith("a b").all() and similar["value"].item() > 0.2


@pytest.mark.slow
def test_a_set_of_which_too_little_is_left_says_so(recognised, recordings):
    images = recordings.touches()
    images["b"] = images["a"]
    rows = recognised(images, "all")
    selected = rows[(rows["group"] == "all") & (rows["method"] == "selected")]
    assert selected["value"].isna().all() and selected["note"].tolist() == ["a keeps 0 touches, 10 are needed"]


@pytest.mark.slow
def test_a_selection_that_leaves_too_little_to_train_on_says_so(recognised, recordings):
    touches = recordings.touches()["a"]
    rows = recognised({"a": touches, "b": touches}, "all")
    selected = rows[rows["method"] == "selected_training"]
    assert set(selected["note"]) == {"0 touches to train on, 12 of two classes are needed"}
    assert set(selected["split"]) == {"random", "blocks"} and selected["value"].isna().all()


def test_a_block_holds_out_neighbours_of_each_class_and_each_repetition_has_a_split_of_its_own():
    labels = np.repeat(["a", "b"], [20, 12])
    train, test = block_split(labels, 3)
    assert sorted([*train, *test]) == list(range(32))
    for label, count in (("a", 5), ("b", 3)):
        held_out = np.sort(test[labels[test] == label])
        assert len(held_out) == count and (np.diff(held_out) == 1).all()
    assert len({tuple(block_split(labels, number)[1]) for number in range(9)}) > 3
    assert len({split_number(seed, repetition) for seed in (0, 1) for repetition in range(9)}) == 18

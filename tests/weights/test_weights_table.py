"""The weights that come with the package, and the table that later stages read."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.glance import FEATURES
from haptic_glance.look.weights import METHODS, LearnedWeights, read_learned_weights, weights
from haptic_glance.look.weights.weights import DEEP, GLANCES, learned_weight_rows
from stages.weights.training import weight_table

THESIS = Path(__file__).parents[2] / "data/reference/thesis/table_3_1_channel_weights.csv"


def arrays(best, seed):
    """One object in whose views the channel `best` stands on the points, and whose looks follow what is seen."""
    random = np.random.default_rng(seed)
    glance = random.normal(size=(400, len(FEATURES)))
    return {
        "channels": np.array(["edge", "color"]),
        "distances": np.array([[1.0, 9.0], [np.nan, np.nan]] if best == "edge" else [[9.0, 1.0], [8.0, 2.0]]),
        "similarities": np.array([[0.9, 0.2], [np.nan, np.nan]] if best == "edge" else [[0.2, 0.9], [0.1, 0.8]]),
        "on_object": np.array([[0.5, -0.2], [np.nan, np.nan]] if best == "edge" else [[-0.2, 0.5], [0.0, 0.4]]),
        "glance": glance,
        "glance_names": np.array(list(FEATURES)),
        "glance_amounts": np.exp(glance[:, list(FEATURES).index("seen")]),
        "glance_areas": np.ones(len(glance)),
    }


TRAINING_DATA = {"cup": arrays("edge", 0), "duck": arrays("edge", 1), "hand": arrays("color", 2)}


@pytest.fixture
def table(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table(TRAINING_DATA, "fixations"))
    return tmp_path


@pytest.mark.parametrize(("method", "column"), [("thesis_ssim", "ssim"), ("thesis_ed", "one_minus_ed")])
def test_weights_are_those_of_thesis_table_3_1(method, column):
    table = pd.read_csv(THESIS)
    assert weights(method) == dict(zip(table.channel, table[column], strict=True))


def test_equal_weights_are_equal():
    assert set(weights("equal").values()) == {1.0}


@pytest.mark.parametrize("method", METHODS)
def test_every_method_weighs_every_channel_in_their_order(method):
    assert list(weights(method)) == list(GLANCES.get(method, CHANNELS))


def test_a_changed_copy_leaves_the_weights_alone():
    weights("equal")["color"] = 7.0
    assert weights("equal")["color"] == 1.0


def test_unknown_method_is_named_with_the_known_ones():
    with pytest.raises(ValueError, match="'ssim'.*thesis_ssim"):
        weights("ssim")


def test_without_ground_truth_only_what_is_published_is_there(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table({}, "gaze"))
    found = read_learned_weights(tmp_path, "cup", None)
    assert set(found.weights) == {*METHODS, *DEEP} and found.svms == {}
    assert LearnedWeights().weights["thesis_ed"] == found.weights["thesis_ed"]


def test_an_object_with_ground_truth_has_no_weights_of_the_deep_glance(table):
    (table / "ground_truth").mkdir()
    (table / "ground_truth/hand.npz").touch()
    assert "glance_deep" not in read_learned_weights(table, "hand", None).weights
    assert read_learned_weights(table, "cup", None).weights["glance_deep"] == DEEP["glance_deep"]


def test_an_object_with_ground_truth_takes_weights_that_have_not_seen_it(table):
    own, seen = (
        read_learned_weights(table, "hand", None).weights[name] for name in ("guided_ssim", "guided_ssim_seen")
    )
    assert own == pytest.approx({"edge": 0.9, "color": 0.2})  # of the cup and the duck
    assert seen["color"] > 0.3  # the hand itself says 0.85
    assert read_learned_weights(table, "elephant", None).weights["guided_ssim"] == seen


def test_the_nearer_channel_and_the_likelier_feature_win(table):
    found = read_learned_weights(table, "hand", None).weights
    assert found["guided_ed"] == pytest.approx({"edge": 1, "color": 0})
    assert found["guided_ssim_object"] == pytest.approx({"edge": 0.5, "color": 0})  # what is unlike gets no say
    for method, others in GLANCES.items():
        assert list(found[method]) == list(others)
        assert found[method].pop("seen") == pytest.approx(1, abs=0.3)
        assert np.abs(list(found[method].values())).max() < 0.3


def test_the_glance_keeps_its_published_weights_where_the_ground_truth_is_no_gaze(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table(TRAINING_DATA, "gaze"))
    found = read_learned_weights(tmp_path, "hand", None).weights
    for method, published in GLANCES.items():
        assert found[method] == pytest.approx(published)


def test_one_object_alone_teaches_others_but_not_itself():
    assert {row["left_out"] for row in learned_weight_rows({"cup": TRAINING_DATA["cup"]})} == {""}


def test_the_only_object_with_ground_truth_takes_nothing_that_was_learned_from_it(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table({"cup": TRAINING_DATA["cup"]}, "fixations"))
    (tmp_path / "ground_truth").mkdir()
    (tmp_path / "ground_truth/cup.npz").touch()
    found = read_learned_weights(tmp_path, "cup", None).weights
    assert not {"guided_ed", *GLANCES} & set(found)
    assert {"guided_ed_seen", "equal"} <= set(found)
    assert {*GLANCES} <= set(read_learned_weights(tmp_path, "duck", None).weights)


def test_published_weights_have_not_seen_the_only_object_with_ground_truth(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table({"cup": TRAINING_DATA["cup"]}, "gaze"))
    (tmp_path / "ground_truth").mkdir()
    (tmp_path / "ground_truth/cup.npz").touch()
    assert {*GLANCES} <= set(read_learned_weights(tmp_path, "cup", None).weights)


@pytest.mark.parametrize("choice", ["equal", "guided_ssim"])
def test_weights_of_channels_are_no_choice_for_the_model_of_features(choice):
    with pytest.raises(ValueError, match="choose gaze, fixations"):
        weight_table(TRAINING_DATA, choice)


def test_a_choice_that_is_not_there_is_an_error_that_lists_those_that_are():
    with pytest.raises(ValueError, match="'fixations' is not available.*gaze.*no object has ground truth"):
        weight_table({}, "fixations")

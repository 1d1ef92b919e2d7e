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


@pytest.fixture
def only_cup(tmp_path):
    """A function: the weights of an object where the cup alone has ground truth and taught the table."""

    def read(name, choice):
        write_table(tmp_path / "weights.csv", weight_table({"cup": TRAINING_DATA["cup"]}, choice))
        (tmp_path / "ground_truth").mkdir(exist_ok=True)
        (tmp_path / "ground_truth/cup.npz").touch()
        return read_learned_weights(tmp_path, name, None).weights

    return read


def test_published_weights_are_those_of_thesis_table_3_1_for_every_channel_in_their_order():
    printed = pd.read_csv(THESIS)
    for method, column in (("thesis_ssim", "ssim"), ("thesis_ed", "one_minus_ed")):
        assert weights(method) == dict(zip(printed.channel, printed[column], strict=True))
    assert set(weights("equal").values()) == {1.0}
    for method in METHODS:
        assert list(weights(method)) == list(GLANCES.get(method, CHANNELS))
    weights("equal")["color"] = 7.0  # a changed copy leaves the weights alone
    assert weights("equal")["color"] == 1.0


def test_without_ground_truth_only_what_is_published_is_there(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table({}, "gaze"))
    learned = read_learned_weights(tmp_path, "cup", None)
    assert set(learned.weights) == {*METHODS, *DEEP} and learned.svms == {}
    assert LearnedWeights().weights["thesis_ed"] == learned.weights["thesis_ed"]


def test_an_object_with_ground_truth_takes_weights_that_have_not_seen_it(table):
    (table / "ground_truth").mkdir()
    (table / "ground_truth/hand.npz").touch()
    hand, elephant = (read_learned_weights(table, name, None).weights for name in ("hand", "elephant"))
    assert hand["guided_ssim"] == pytest.approx({"edge": 0.9, "color": 0.2})  # of the cup and the duck
    assert hand["guided_ssim+seen"]["color"] > 0.3  # the hand itself says 0.85
    assert elephant["guided_ssim"] == hand["guided_ssim+seen"]
    assert "glance_deep" not in hand and elephant["glance_deep"] == DEEP["glance_deep"]


def test_the_nearer_channel_and_the_likelier_feature_win(table):
    learned = read_learned_weights(table, "hand", None).weights
    assert learned["guided_ed"] == pytest.approx({"edge": 1, "color": 0})
    assert learned["guided_ssim+object"] == pytest.approx({"edge": 0.5, "color": 0})  # what is unlike gets no say
    for method, features in GLANCES.items():
        assert list(learned[method]) == list(features)
        assert learned[method].pop("seen") == pytest.approx(1, abs=0.3)
        assert np.abs(list(learned[method].values())).max() < 0.3


def test_the_glance_keeps_its_published_weights_where_the_ground_truth_is_no_gaze(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table(TRAINING_DATA, "gaze"))
    learned = read_learned_weights(tmp_path, "hand", None).weights
    for method, published in GLANCES.items():
        assert learned[method] == pytest.approx(published)


def test_the_only_object_with_ground_truth_takes_nothing_that_was_learned_from_it(only_cup):
    assert {row["left_out"] for row in learned_weight_rows({"cup": TRAINING_DATA["cup"]})} == {""}
    cup = only_cup("cup", "fixations")
    assert not {"guided_ed", *GLANCES} & set(cup) and {"guided_ed+seen", "equal"} <= set(cup)
    assert {*GLANCES} <= set(only_cup("duck", "fixations"))
    assert {*GLANCES} <= set(only_cup("cup", "gaze"))  # published weights have not seen it

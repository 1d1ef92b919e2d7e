"""The weights that need no learning, and their file."""

from pathlib import Path

import pandas as pd
import pytest

from stages.kit.files import write_table
from stages.weights import METHODS, chosen_weights, read_weights, weight_table, weights

THESIS = Path(__file__).parents[2] / "data/reference/thesis/table_3_1_channel_weights.csv"


@pytest.mark.parametrize(("method", "column"), [("thesis_ssim", "ssim"), ("thesis_ed", "one_minus_ed")])
def test_weights_are_those_of_thesis_table_3_1(method, column):
    table = pd.read_csv(THESIS)
    assert weights(method) == dict(zip(table.channel, table[column], strict=True))


def test_equal_weights_are_equal():
    assert set(weights("equal").values()) == {1.0}


@pytest.mark.parametrize("method", METHODS)
def test_every_method_weighs_every_channel_in_their_order(method):
    conspicuity = pytest.importorskip("stages.conspicuity")
    assert list(weights(method)) == list(conspicuity.CHANNELS)


def test_a_changed_copy_leaves_the_weights_alone():
    weights("equal")["color"] = 7.0
    assert weights("equal")["color"] == 1.0


def test_unknown_method_is_named_with_the_known_ones():
    with pytest.raises(ValueError, match="'ssim'.*thesis_ssim"):
        weights("ssim")


def test_table_round_trip_keeps_weights_and_choice(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table(list(METHODS), "thesis_ed"))
    assert read_weights(tmp_path / "weights.csv", "thesis_ssim") == weights("thesis_ssim")
    assert chosen_weights(tmp_path / "weights.csv") == weights("thesis_ed")


def test_reading_an_absent_method_is_an_error(tmp_path):
    write_table(tmp_path / "weights.csv", weight_table(["equal"], "equal"))
    with pytest.raises(ValueError, match="no weights 'svm', only equal"):
        read_weights(tmp_path / "weights.csv", "svm")


def test_choosing_an_unlisted_method_is_an_error():
    with pytest.raises(ValueError, match="thesis_ed.*not in weights.methods"):
        weight_table(["equal"], "thesis_ed")

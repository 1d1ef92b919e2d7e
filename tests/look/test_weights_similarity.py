"""Weights from the likeness to the ground truth's saliency map."""

import numpy as np
import pytest
from skimage.metrics import structural_similarity

from haptic_glance.look.weights.attention import similarity_weights, view_similarities

SHAPE = (60, 80)
R, C = np.mgrid[: SHAPE[0], : SHAPE[1]]
MASK = (R - 30) ** 2 + (C - 40) ** 2 < 20**2


def blob(row, column, sigma=3.0):
    return np.exp(-((R - row) ** 2 + (C - column) ** 2) / (2 * sigma**2)) * MASK


GTS = np.maximum(blob(25, 35), blob(38, 44))
NOISE = np.random.default_rng(0).random(SHAPE) * MASK


def test_likeness_to_itself_is_one():
    assert view_similarities({"edge": GTS}, GTS) == {"edge": pytest.approx(1)}
    assert view_similarities({"edge": GTS}, GTS, MASK) == {"edge": pytest.approx(1)}


def test_likeness_is_that_of_a_library():
    settings = {"data_range": 1.0, "gaussian_weights": True, "sigma": 1.5, "use_sample_covariance": False}
    mean, found = structural_similarity(NOISE, GTS, full=True, **settings)
    assert view_similarities({"noise": NOISE}, GTS) == {"noise": pytest.approx(mean, rel=1e-9)}
    assert view_similarities({"noise": NOISE}, GTS, MASK) == {"noise": pytest.approx(found[MASK].mean(), rel=1e-9)}


@pytest.mark.parametrize("mask", [None, MASK])
def test_the_channel_that_shows_the_ground_truth_gets_the_highest_weight(mask):
    maps = {"right": 0.7 * GTS, "elsewhere": blob(25, 45), "noise": NOISE}
    weights = similarity_weights([view_similarities(maps, GTS, mask)])
    assert max(weights, key=weights.get) == "right"


def test_likeness_does_not_depend_on_the_side_the_object_shows():
    one = view_similarities({"noise": NOISE}, GTS, MASK)["noise"]
    mirrored = view_similarities({"noise": NOISE[:, ::-1]}, GTS[:, ::-1], MASK[:, ::-1])["noise"]
    assert one == pytest.approx(mirrored)


def test_over_the_whole_image_the_background_passes_for_likeness():
    whole = view_similarities({"noise": NOISE}, GTS)["noise"]
    assert whole > 0.4 > 0.1 > view_similarities({"noise": NOISE}, GTS, MASK)["noise"]


def test_a_nearly_empty_map_passes_for_more_alike_than_one_that_sees_the_points_broadly():
    nearly_empty = np.zeros(SHAPE)
    nearly_empty[30, 40] = 0.01
    broad = np.maximum(blob(25, 35, 8.0), blob(38, 44, 8.0))
    found = view_similarities({"nearly empty": nearly_empty, "broad": broad}, GTS)
    assert found["nearly empty"] > found["broad"]


@pytest.mark.parametrize("mask", [None, MASK])
def test_a_flat_map_gets_nothing(mask):
    assert view_similarities({"color": np.zeros(SHAPE)}, GTS, mask) == {"color": 0.0}


def test_a_view_without_ground_truth_has_no_likeness():
    assert view_similarities({"noise": NOISE}, np.zeros(SHAPE)) == {}


def test_weights_are_averaged_over_the_views_with_ground_truth():
    assert similarity_weights([{"a": 0.5, "b": 0.2}, {}, {"a": 0.9, "b": 0.4}]) == pytest.approx({"a": 0.7, "b": 0.3})


def test_the_opposite_of_the_ground_truth_gets_no_weight():
    opposite = view_similarities({"opposite": (1 - GTS) * MASK}, GTS, MASK)
    assert opposite["opposite"] < 0
    assert similarity_weights([opposite]) == {"opposite": 0.0}


def test_no_ground_truth_in_any_view_is_an_error():
    with pytest.raises(ValueError, match="no view shows a ground truth point"):
        similarity_weights([{}])


@pytest.mark.parametrize(
    ("maps", "gts", "mask", "message"),
    [
        ({"edge": NOISE}, GTS[:9], None, "must agree"),
        ({"edge": NOISE}, GTS, MASK[:9], "must agree"),
        ({"edge": NOISE}, GTS, np.zeros(SHAPE, dtype=bool), "no pixel of the object"),
        ({"edge": NOISE * 255}, GTS, None, "maps must lie in 0..1"),
        ({"edge": NOISE}, GTS * 255, None, "ground truth must lie in 0..1"),
        ({"edge": NOISE}, np.full(SHAPE, np.nan), None, "ground truth must lie in 0..1"),
        ({"edge": NOISE[:5, :5]}, GTS[:5, :5], None, "smaller than SSIM's window"),
    ],
)
def test_bad_input_is_named(maps, gts, mask, message):
    with pytest.raises(ValueError, match=message):
        view_similarities(maps, gts, mask)

"""Weights from the distance of the brightest pixels to the ground truth points, and from the likeness to its map."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist
from skimage.metrics import structural_similarity

from haptic_glance.look.weights.attention import (
    average,
    euclidean_weights,
    similarity_weights,
    view_distances,
    view_similarities,
)

SHAPE = (30, 40)
R, C = np.mgrid[:60, :80]
MASK = (R - 30) ** 2 + (C - 40) ** 2 < 20**2


def blob(row, column):
    return np.exp(-((R - row) ** 2 + (C - column) ** 2) / 18) * MASK


GTS = np.maximum(blob(25, 35), blob(38, 44))
NOISE = np.random.default_rng(0).random(MASK.shape) * MASK


def test_distance_is_that_of_the_brightest_pixels_of_which_there_may_be_few():
    spot = np.zeros(SHAPE)
    spot[4, 5] = 1
    assert view_distances({"edge": spot}, [7], [9]) == {"edge": 5.0}
    maps = {"edge": np.array([[1.0, 0.0]])}
    assert view_distances(maps, [0, 0, 0], [0, 0, 0]) == {"edge": 0.5}  # more points than pixels take every pixel
    assert view_distances(maps, [], []) == {}


def test_equally_bright_pixels_count_alike_wherever_they_stand():
    flat = view_distances({"flat": np.zeros(SHAPE)}, [2.0, 20.0], [3.0, 9.0])["flat"]
    assert flat == pytest.approx(cdist(np.argwhere(np.ones(SHAPE)), [[2, 3], [20, 9]]).mean())
    values = np.round(np.random.default_rng(2).random(SHAPE), 1)
    distance = view_distances({"edge": values}, [4, 20], [7, 30])["edge"]
    assert distance == pytest.approx(view_distances({"edge": values[::-1, ::-1]}, [25, 9], [32, 9])["edge"])


@pytest.mark.parametrize(
    ("views", "weights"),
    [
        ([{"a": 10.0, "b": 30.0, "c": 20.0}], {"a": 1.0, "b": 0.0, "c": 0.5}),
        ([{"a": 20.0, "b": 60.0, "c": 40.0}], {"a": 1.0, "b": 0.0, "c": 0.5}),  # of an image of another size
        ([{"a": 1.0, "b": 2.0}, {}, {"a": 5.0, "b": 3.0}, {"a": 1.0, "b": 9.0}], {"a": 2 / 3, "b": 1 / 3}),
        ([{"a": 3.0, "b": 3.0}], {"a": 1.0, "b": 1.0}),
    ],
)
def test_weights_of_distances_are_scaled_in_each_view_with_points_and_averaged(views, weights):
    assert euclidean_weights(views) == pytest.approx(weights)


def test_likeness_is_that_of_a_library_over_the_image_or_the_object():
    settings = {"data_range": 1.0, "gaussian_weights": True, "sigma": 1.5, "use_sample_covariance": False}
    mean, pixels = structural_similarity(NOISE, GTS, full=True, **settings)
    whole, masked = view_similarities({"noise": NOISE}, GTS), view_similarities({"noise": NOISE}, GTS, MASK)
    assert whole == {"noise": pytest.approx(mean, rel=1e-9)}
    assert masked == {"noise": pytest.approx(pixels[MASK].mean(), rel=1e-9)}
    assert whole["noise"] > 0.4 > 0.1 > masked["noise"]  # the background passes for likeness
    mirrored = view_similarities({"noise": NOISE[:, ::-1]}, GTS[:, ::-1], MASK[:, ::-1])
    assert mirrored["noise"] == pytest.approx(masked["noise"])
    assert view_similarities({"noise": NOISE}, np.zeros(MASK.shape)) == {}


@pytest.mark.parametrize("mask", [None, MASK])
def test_the_channel_that_shows_the_ground_truth_gets_the_highest_weight_and_a_flat_map_none(mask):
    maps = {"right": 0.7 * GTS, "elsewhere": blob(25, 45), "noise": NOISE, "flat": np.zeros(MASK.shape), "same": GTS}
    weights = similarity_weights([view_similarities(maps, GTS, mask)])
    assert weights.pop("same") == pytest.approx(1) and weights.pop("flat") == 0
    assert max(weights, key=weights.get) == "right"


def test_weights_of_likeness_are_averaged_over_views_and_the_opposite_of_the_ground_truth_gets_none():
    assert similarity_weights([{"a": 0.5, "b": 0.2}, {}, {"a": 0.9, "b": 0.4}]) == pytest.approx({"a": 0.7, "b": 0.3})
    opposite = view_similarities({"opposite": (1 - GTS) * MASK}, GTS, MASK)
    assert opposite["opposite"] < 0 and similarity_weights([opposite]) == {"opposite": 0.0}


FLAT = np.zeros(SHAPE)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: euclidean_weights([{}, {}]), "no view shows a ground truth point"),
        (lambda: average([{"a": 1.0}, {"b": 1.0}]), "different channels: a and b"),
        (lambda: euclidean_weights([{"a": 1.0, "b": float("nan")}]), "finite"),
        (lambda: view_distances({}, [1], [1]), "no conspicuity maps"),
        (lambda: view_distances({"edge": np.full(SHAPE, np.nan)}, [1], [1]), "NaN.*edge"),
        (lambda: view_distances({"edge": FLAT, "dkl": np.zeros((3, 3))}, [1], [1]), "one shape"),
        (lambda: view_distances({"edge": np.zeros(9)}, [1], [1]), "one shape"),
        (lambda: view_distances({"edge": FLAT}, [1, 30], [1, 1]), r"points off the map of 30 x 40 pixels: \[\[30.0, 1"),
        (lambda: view_distances({"edge": FLAT}, [np.nan], [1]), "points off the map"),
        (lambda: view_distances({"edge": FLAT}, [1, 2], [1]), "two arrays"),
        (lambda: view_similarities({"edge": NOISE}, GTS[:9]), "must agree"),
        (lambda: view_similarities({"edge": NOISE}, GTS, MASK[:9]), "must agree"),
        (lambda: view_similarities({"edge": NOISE}, GTS, np.zeros_like(MASK)), "no pixel of the object"),
        (lambda: view_similarities({"edge": NOISE * 255}, GTS), "maps must lie in 0..1"),
        (lambda: view_similarities({"edge": NOISE}, np.full(MASK.shape, np.nan)), "ground truth must lie in 0..1"),
        (lambda: view_similarities({"edge": NOISE[:5, :5]}, GTS[:5, :5]), "smaller than SSIM's window"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()

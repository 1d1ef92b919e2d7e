"""Weights from the distance of the brightest pixels to the ground truth points."""

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from haptic_glance.look.weights.attention import average, euclidean_weights, view_distances

SHAPE = (30, 40)


def peaks(*pixels):
    """A map that falls off around each pixel, the first one brightest."""
    r, c = np.mgrid[: SHAPE[0], : SHAPE[1]]
    return np.max([(1 - k / 100) * np.exp(-((r - a) ** 2 + (c - b) ** 2) / 8) for k, (a, b) in enumerate(pixels)], 0)


def test_one_point_and_one_peak_give_their_distance():
    assert view_distances({"edge": peaks((4, 5))}, [7], [9]) == {"edge": 5.0}


def test_distance_is_the_mean_over_all_pairs():
    points = np.array([[3.0, 3.0], [10.0, 30.5], [20.0, 8.0]])
    values = np.random.default_rng(0).random(SHAPE)
    brightest = np.argwhere(values >= np.sort(values, axis=None)[-3])
    found = view_distances({"edge": values}, points[:, 0], points[:, 1])["edge"]
    assert found == pytest.approx(cdist(brightest, points).mean())


def test_the_channel_that_peaks_on_the_points_gets_the_highest_weight():
    rows, columns = [10, 11, 10], [20, 20, 21]
    maps = {"near": peaks((10, 20)), "far": peaks((28, 2)), "between": peaks((18, 12))}
    weights = euclidean_weights([view_distances(maps, rows, columns)])
    assert weights["near"] == 1 and weights["far"] == 0 and 0 < weights["between"] < 1


def test_all_pairs_reward_the_middle_of_the_points_over_the_points():
    rows, columns = [5, 5, 25, 25], [10, 30, 10, 30]
    found = view_distances({"right": peaks(*zip(rows, columns, strict=True)), "middle": peaks((15, 20))}, rows, columns)
    assert found["middle"] < found["right"]


def test_brightness_matters_by_its_order_alone():
    values = np.random.default_rng(1).random(SHAPE)
    found = view_distances({"a": values, "b": values**3 / 9}, [4, 20], [7, 30])
    assert found["a"] == found["b"]


def test_a_flat_map_is_as_far_as_a_pixel_drawn_blindly():
    found = view_distances({"flat": np.zeros(SHAPE)}, [2.0, 20.0], [3.0, 9.0])["flat"]
    pixels = np.argwhere(np.ones(SHAPE))
    assert found == pytest.approx(cdist(pixels, [[2, 3], [20, 9]]).mean())


def test_equally_bright_pixels_count_wherever_they_stand_in_the_array():
    values = np.round(np.random.default_rng(2).random(SHAPE), 1)
    one = view_distances({"edge": values}, [4, 20], [7, 30])["edge"]
    other = view_distances({"edge": values[::-1, ::-1]}, [25, 9], [32, 9])["edge"]
    assert one == pytest.approx(other)


def test_more_points_than_pixels_take_every_pixel():
    maps = {"edge": np.array([[1.0, 0.0]])}
    assert view_distances(maps, [0, 0, 0], [0, 0, 0]) == {"edge": 0.5}


def test_weights_do_not_depend_on_the_size_of_the_image():
    view = {"a": 10.0, "b": 30.0, "c": 20.0}
    twice = {channel: 2 * value for channel, value in view.items()}
    assert euclidean_weights([view]) == euclidean_weights([twice]) == {"a": 1.0, "b": 0.0, "c": 0.5}


def test_weights_are_averaged_over_the_views_with_points():
    views = [{"a": 1.0, "b": 2.0}, {}, {"a": 5.0, "b": 3.0}, {"a": 1.0, "b": 9.0}]
    assert euclidean_weights(views) == pytest.approx({"a": 2 / 3, "b": 1 / 3})


def test_channels_that_are_equally_far_all_get_one():
    assert euclidean_weights([{"a": 3.0, "b": 3.0}]) == {"a": 1.0, "b": 1.0}


def test_a_view_without_points_has_no_distances():
    assert view_distances({"edge": peaks((4, 5))}, [], []) == {}


def test_no_points_in_any_view_is_an_error():
    with pytest.raises(ValueError, match="no view shows a ground truth point"):
        euclidean_weights([{}, {}])


def test_views_of_different_channels_are_an_error():
    with pytest.raises(ValueError, match="different channels: a and b"):
        average([{"a": 1.0}, {"b": 1.0}])


def test_a_distance_that_is_not_finite_is_an_error():
    with pytest.raises(ValueError, match="finite"):
        euclidean_weights([{"a": 1.0, "b": float("nan")}])


@pytest.mark.parametrize(
    ("maps", "rows", "columns", "message"),
    [
        ({}, [1], [1], "no conspicuity maps"),
        ({"edge": np.full(SHAPE, np.nan)}, [1], [1], "NaN.*edge"),
        ({"edge": np.zeros(SHAPE), "dkl": np.zeros((3, 3))}, [1], [1], "one shape"),
        ({"edge": np.zeros(9)}, [1], [1], "one shape"),
        ({"edge": np.zeros(SHAPE)}, [1, 30], [1, 1], r"points off the map of 30 x 40 pixels: \[\[30.0, 1.0\]\]"),
        ({"edge": np.zeros(SHAPE)}, [np.nan], [1], "points off the map"),
        ({"edge": np.zeros(SHAPE)}, [1, 2], [1], "two arrays"),
    ],
)
def test_bad_input_is_named(maps, rows, columns, message):
    with pytest.raises(ValueError, match=message):
        view_distances(maps, rows, columns)

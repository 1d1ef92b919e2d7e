"""Interest points of maps and surfaces: the fusion of maps, their peaks, regions, and the order of visits."""

import numpy as np
import pytest

from haptic_glance.look.points import fuse, select_by_centroid, select_by_suppression
from haptic_glance.look.points.options import visited

RADIUS = 5
MAPS = {"color": np.full((3, 4), 0.2), "edge": np.full((3, 4), 0.8)}


@pytest.mark.parametrize(
    ("channel_weights", "fused"),
    [(None, 0.5), ({"color": 1, "edge": 3}, 0.65), ({"color": 10, "edge": 30}, 0.65), ({"edge": 0.3}, 0.8)],
)
def test_fusion_is_the_mean_by_weights_whatever_their_scale(channel_weights, fused):
    assert np.allclose(fuse(MAPS, channel_weights), fused)


@pytest.mark.parametrize(
    ("maps", "channel_weights", "message"),
    [
        ({}, None, "no conspicuity maps"),
        ({"a": np.ones((2, 2)), "b": np.ones((2, 3))}, None, "one shape"),
        (MAPS, {"edge": -1.0}, "not negative"),
        (MAPS, {"edge": np.nan}, "finite"),
        (MAPS, {"edge": 0.0}, "all weights are zero"),
        (MAPS, {"colour": 1.0}, "without a map: colour"),
    ],
)
def test_bad_maps_and_weights_are_errors(maps, channel_weights, message):
    with pytest.raises(ValueError, match=message):
        fuse(maps, channel_weights)


@pytest.fixture
def bumpy():
    return np.random.default_rng(0).random((60, 80)) ** 4


def line(*values):
    """A map with bright pixels 15 columns apart."""
    image = np.zeros((20, 60))
    image[10, 5 + 15 * np.arange(len(values))] = values
    return image


@pytest.mark.parametrize(
    ("image", "count", "values", "strong"),
    [
        (line(0.95, 1.0), None, [1.0, 0.95], 2),  # the brightest comes first
        (line(1.0, 0.91, 0.9, 0.5), None, [1.0, 0.91], 2),  # it stops at nine tenths of the maximum
        (line(1.0, 0.91, 0.9, 0.5), 10, [1.0, 0.91, 0.9, 0.5], 2),  # and goes on where a count is asked for
        (np.ones((40, 40)), 3, [1.0, 1.0, 1.0], 3),
        (np.diag([1.0] + [0.0] * 18 + [0.99]), None, [1.0, 0.99], 2),  # a corner clears only its side
        (np.zeros((10, 10)), None, [], 0),
    ],
)
def test_suppression_takes_the_brightest_pixels_in_turn(image, count, values, strong):
    picked = select_by_suppression(image, RADIUS, count=count)
    assert (picked.values.tolist(), picked.strong) == (values, strong)
    assert image[picked.rows, picked.columns].tolist() == values


def test_suppression_never_returns_two_points_within_the_radius_and_leaves_the_map_as_it_was(bumpy):
    before = bumpy.copy()
    picked = select_by_suppression(bumpy, RADIUS, count=50)
    pixels = np.stack([picked.rows, picked.columns], axis=1)
    apart = np.linalg.norm(pixels[:, None] - pixels, axis=2)[np.triu_indices(50, 1)]
    assert apart.min() > RADIUS and (bumpy == before).all()


def test_centroids_are_the_middles_of_the_most_salient_regions_the_brightest_first(bumpy):
    image = np.full((30, 60), 0.01)
    image[5:10, 5:15], image[20:25, 40:50] = 0.6, 0.8
    picked = select_by_centroid(image, share=100 / image.size)
    assert picked.values.tolist() == [0.8, 0.6]
    assert abs(picked.rows - [22, 7]).max() <= 1 and abs(picked.columns - [44.5, 9.5]).max() <= 1
    diagonal = select_by_centroid(np.eye(9), share=1)  # pixels that touch at a corner are one region
    assert (diagonal.rows.tolist(), diagonal.columns.tolist()) == ([4], [4])
    picked = select_by_centroid(bumpy)
    assert len(picked.rows) > 10 and (bumpy[picked.rows, picked.columns] >= np.quantile(bumpy, 0.7)).all()
    assert (len(select_by_centroid(np.zeros((10, 10))).rows), picked.strong > 0) == (0, True)


def test_centroid_of_a_disc_is_its_middle_and_of_a_ring_moves_onto_the_ring():
    r, c = np.mgrid[:60, :60]
    image = np.where((r - 20) ** 2 + (c - 31) ** 2 <= 36, 1.0, 0.0) + np.where((r > 45) & (c > 2) & (c < 57), 0.5, 0)
    picked = select_by_centroid(image, share=113 / (image > 0).sum())
    assert (picked.rows.tolist(), picked.columns.tolist()) == ([20], [31])
    ring = np.abs(np.hypot(r - 20, c - 20) - 15) < 2
    picked = select_by_centroid(ring.astype(float), share=1)
    assert len(picked.rows) == 1 and ring[picked.rows[0], picked.columns[0]]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        *[
            (lambda image=image, select=select: select(image), "saliency map must")
            for image in (np.zeros((0, 5)), np.ones(5), np.full((4, 4), np.nan), np.full((4, 4), -1.0))
            for select in (lambda image: select_by_suppression(image, RADIUS), select_by_centroid)
        ],
        (lambda: select_by_suppression(np.ones((4, 4)), -1), "radius"),
        (lambda: select_by_suppression(np.ones((4, 4)), 1, count=-1), "count"),
        (lambda: select_by_centroid(np.ones((4, 4)), share=0), "share"),
    ],
)
def test_bad_maps_and_settings_are_errors(call, message):
    with pytest.raises(ValueError, match=message):
        call()


PLACES = np.stack([*np.meshgrid(np.arange(60.0), np.arange(40.0), indexing="ij"), np.zeros((60, 40))], -1).reshape(
    -1, 3
)


def hills(*peaks):
    """Values at PLACES: the sum of (x, y, height, width)."""
    return sum(h * np.exp(-((PLACES - [x, y, 0]) ** 2).sum(axis=1) / (2 * w * w)) for x, y, h, w in peaks)


def test_hills_are_visited_from_the_highest_to_the_lowest_farther_apart_than_the_radius():
    order = visited(PLACES, hills((10, 10, 1, 3), (40, 20, 2, 3), (20, 30, 1.5, 3)), 8, count=3)
    assert PLACES[order, :2].tolist() == [[40, 20], [20, 30], [10, 10]]
    places = PLACES[visited(PLACES, hills((30, 20, 1, 15)), 6, count=20)]
    apart = np.linalg.norm(places[:, None] - places, axis=2)[np.triu_indices(20, 1)]
    assert len(places) == 20 and apart.min() > 6


def test_a_lower_hill_comes_before_the_slope_of_a_higher_one():
    """A disc cut out of the broad hill leaves a rim that is higher than the small hill's top."""
    broad, small = (20, 20, 1.0, 7.0), (48, 20, 0.75, 2.0)
    values = hills(broad, small)
    rim = np.linalg.norm(PLACES[:, :2] - [20, 20], axis=1) > 5
    assert values[rim & (PLACES[:, 0] < 35)].max() > 0.75
    assert PLACES[visited(PLACES, values, 5, count=2)[1], 0] == pytest.approx(48, abs=1)


def test_nothing_to_visit_gives_no_point():
    assert len(visited(PLACES, np.zeros(len(PLACES)), 5, count=3)) == 0
    assert len(visited(PLACES[:0], np.zeros(0), 5, count=3)) == 0
    assert len(visited(PLACES[:4], np.ones(4), 100, count=3)) == 1  # no room for a second

"""Interest points of one map."""

import numpy as np
import pytest

from haptic_glance.look.points import select_by_centroid, select_by_suppression

RADIUS = 5


@pytest.fixture
def bumpy():
    return np.random.default_rng(0).random((60, 80)) ** 4


def distances(picked):
    pixels = np.stack([picked.rows, picked.columns], axis=1)
    apart = np.linalg.norm(pixels[:, None] - pixels[None], axis=2)
    return apart[np.triu_indices(len(pixels), 1)]


def test_suppression_starts_at_the_brightest_pixel():
    image = np.zeros((20, 30))
    image[7, 11], image[15, 25] = 1.0, 0.95
    picked = select_by_suppression(image, RADIUS)
    assert list(zip(picked.rows, picked.columns, strict=True)) == [(7, 11), (15, 25)]


def test_suppression_never_returns_two_points_within_the_radius(bumpy):
    assert distances(select_by_suppression(bumpy, RADIUS, count=50)).min() > RADIUS


def test_suppression_stops_at_nine_tenths_of_the_maximum():
    image = np.zeros((20, 60))
    image[10, [5, 20, 35, 50]] = [1.0, 0.91, 0.9, 0.5]
    assert len(select_by_suppression(image, RADIUS).rows) == 2


def test_suppression_goes_on_below_the_threshold_when_a_count_is_asked():
    image = np.zeros((20, 60))
    image[10, [5, 20, 35, 50]] = [1.0, 0.91, 0.9, 0.5]
    picked = select_by_suppression(image, RADIUS, count=10)
    assert list(picked.values) == [1.0, 0.91, 0.9, 0.5]
    assert picked.strong == 2


def test_suppression_keeps_a_count_below_the_strong_points():
    picked = select_by_suppression(np.ones((40, 40)), RADIUS, count=3)
    assert (len(picked.rows), picked.strong) == (3, 3)


def test_suppression_at_the_border_clears_only_its_side():
    image = np.zeros((20, 20))
    image[0, 0], image[19, 19] = 1.0, 0.99
    assert len(select_by_suppression(image, RADIUS).rows) == 2


def test_suppression_leaves_the_map_as_it_was(bumpy):
    before = bumpy.copy()
    select_by_suppression(bumpy, RADIUS)
    assert (bumpy == before).all()


@pytest.mark.parametrize("select", [lambda m: select_by_suppression(m, RADIUS), select_by_centroid])
def test_a_map_of_zeros_has_no_points(select):
    picked = select(np.zeros((10, 10)))
    assert (len(picked.rows), picked.strong) == (0, 0)


def test_centroid_of_a_disc_is_its_middle():
    r, c = np.mgrid[:60, :60]
    image = np.where((r - 20) ** 2 + (c - 31) ** 2 <= 36, 1.0, 0.0) + np.where((r > 45) & (c > 2) & (c < 57), 0.5, 0)
    picked = select_by_centroid(image, share=113 / (image > 0).sum())
    assert (picked.rows.tolist(), picked.columns.tolist()) == ([20], [31])


def test_centroid_of_a_ring_moves_onto_the_ring():
    r, c = np.mgrid[:41, :41]
    ring = np.abs(np.hypot(r - 20, c - 20) - 15) < 2
    picked = select_by_centroid(ring.astype(float), share=1)
    assert len(picked.rows) == 1
    assert ring[picked.rows[0], picked.columns[0]]


def test_centroids_lie_in_the_most_salient_share(bumpy):
    picked = select_by_centroid(bumpy)
    assert len(picked.rows) > 10
    assert (bumpy[picked.rows, picked.columns] >= np.quantile(bumpy, 0.7)).all()


def test_every_region_has_one_centroid_and_the_brightest_comes_first():
    image = np.full((30, 60), 0.01)
    image[5:10, 5:15], image[20:25, 40:50] = 0.6, 0.8
    picked = select_by_centroid(image, share=100 / image.size)
    assert picked.values.tolist() == [0.8, 0.6]
    assert abs(picked.rows - [22, 7]).max() <= 1
    assert abs(picked.columns - [44.5, 9.5]).max() <= 1


def test_pixels_that_touch_at_a_corner_are_one_region():
    image = np.eye(9)
    picked = select_by_centroid(image, share=1)
    assert (picked.rows.tolist(), picked.columns.tolist()) == ([4], [4])


@pytest.mark.parametrize(
    "image", [np.zeros((0, 5)), np.ones(5), np.full((4, 4), np.nan), np.full((4, 4), -1.0), np.full((4, 4), np.inf)]
)
def test_a_bad_map_is_an_error(image):
    with pytest.raises(ValueError, match="saliency map must"):
        select_by_suppression(image, RADIUS)
    with pytest.raises(ValueError, match="saliency map must"):
        select_by_centroid(image)


def test_bad_radius_count_and_share_are_errors():
    with pytest.raises(ValueError, match="radius"):
        select_by_suppression(np.ones((4, 4)), -1)
    with pytest.raises(ValueError, match="count"):
        select_by_suppression(np.ones((4, 4)), 1, count=-1)
    with pytest.raises(ValueError, match="share"):
        select_by_centroid(np.ones((4, 4)), share=0)

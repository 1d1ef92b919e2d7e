"""The channels that look at the image alone, on images with a known answer."""

import numpy as np
import pytest
from skimage.filters.rank import entropy as rank_entropy
from skimage.morphology import footprint_rectangle

from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.channels.colour import MECHANISMS, RGB_TO_LMS
from haptic_glance.look.channels.texture import energy, laplacian_of_gaussian, local_entropy, local_variance
from haptic_glance.look.views import View, Viewpoint
from haptic_glance.mesh.mesh import Mesh

TRIANGLE = Mesh([[0, -0.5, -0.5], [0, 0.5, -0.5], [0, 0, 0.5]], [[0, 1, 2]])
IMAGE_CHANNELS = sorted(set(CHANNELS) - {"curvature", "symmetry"})


def view_of(rgb, mask=None):
    """A view whose every pixel (or those of the mask) shows face 0."""
    mask = np.ones(rgb.shape[:2], dtype=bool) if mask is None else mask
    depth = np.where(mask, 10, np.inf).astype(np.float32)
    return View(rgb, depth, np.where(mask, 0, -1).astype(np.int32), Viewpoint(0, 0))


def grey(level=120, size=(450, 600)):
    return np.full((*size, 3), level, dtype=np.uint8)


def maps(rgb, *names, mask=None):
    return conspicuity(TRIANGLE, view_of(rgb, mask), names)


def peak(values):
    """(row, column) in the view (maps are a quarter of it)."""
    return np.array(np.unravel_index(values.argmax(), values.shape)) * 4 + 1.5


@pytest.mark.slow
@pytest.mark.parametrize("channel", IMAGE_CHANNELS)
@pytest.mark.parametrize("color", [(0, 0, 0), (120, 120, 120), (200, 40, 90), (255, 255, 255)])
def test_one_colour_gives_nothing(channel, color):
    assert not maps(np.full((450, 600, 3), color, dtype=np.uint8), channel)[channel].any()


@pytest.mark.parametrize("channel", IMAGE_CHANNELS)
def test_a_uniform_disc_on_black_gives_nothing(channel):
    y, x = np.mgrid[:450, :600]
    disc = np.hypot(y - 220, x - 290) < 150
    rgb = np.where(disc[..., None], np.uint8(150), np.uint8(0)).repeat(3, axis=2)
    assert not maps(rgb, channel, mask=disc)[channel].any()


@pytest.mark.parametrize("channel", ["intensity", "dkl", "contrast", "orientation", "edge", "entropy"])
def test_a_bright_dot_stands_out(channel):
    rgb = grey()
    y, x = np.mgrid[:450, :600]
    rgb[np.hypot(y - 160, x - 400) < 16] = 240
    found = maps(rgb, channel)[channel]
    # Contrast and entropy see the dot from anywhere in their window.
    assert np.hypot(*(peak(found) - (160, 400))) < 30
    assert found.max() > 0.3 or channel in ("edge", "entropy", "orientation")


def test_red_among_greys_of_its_brightness_is_color_and_not_intensity():
    rgb = grey(100)
    rgb[150:180, 380:410] = 240, 30, 30
    found = maps(rgb, "color", "intensity", "dkl")
    assert np.hypot(*(peak(found["color"]) - (165, 395))) < 24
    assert np.hypot(*(peak(found["dkl"]) - (165, 395))) < 24
    assert found["color"].max() > 0.5 and found["intensity"].max() == 0


def test_red_on_green_stands_out_where_the_printed_sign_would_cancel_it():
    rgb = np.full((450, 600, 3), (40, 160, 40), dtype=np.uint8)
    rgb[150:180, 380:410] = 160, 40, 40
    found = maps(rgb, "color")["color"]
    assert np.hypot(*(peak(found) - (165, 395))) < 24


def test_the_odd_bar_stands_out_in_orientation():
    rgb = grey(60)
    bars = [(r, c) for r in range(60, 420, 70) for c in range(60, 560, 80)]
    odd = bars[24]
    for r, c in bars:
        tall, wide = (20, 4) if (r, c) != odd else (4, 20)
        rgb[r - tall : r + tall, c - wide : c + wide] = 220
    found = maps(rgb, "orientation")["orientation"]
    assert np.hypot(*(peak(found) - odd)) < 24


def test_gabor_energy_prefers_its_own_angle_and_ignores_slopes():
    y, x = np.mgrid[:64, :64].astype(np.float32)
    lying, rising = np.cos(np.pi / 2 * y), np.cos(np.pi / 2 * (x + y) / np.sqrt(2))
    inner = (slice(16, 48), slice(16, 48))
    assert energy(lying, 0)[inner].min() > 5 * energy(lying, 90)[inner].max()
    assert energy(rising, 45)[inner].min() > 5 * energy(rising, 135)[inner].max()
    assert energy(x / 64 + y / 32, 45)[inner].max() < 1e-5


def test_contrast_is_the_variance_of_the_object_alone():
    rng = np.random.default_rng(0)
    image, counted = rng.integers(0, 256, (60, 70)).astype(np.uint8), rng.random((60, 70)) < 0.7
    found = local_variance(image, counted, 9)
    window = (slice(26, 35), slice(36, 45))
    assert found[30, 40] == pytest.approx(np.var(image[window][counted[window]] / 255), rel=1e-5)
    assert not local_variance(image, np.zeros_like(counted), 9).any()


@pytest.mark.parametrize("levels", [2, 17, 256])
def test_entropy_equals_rank_entropy(levels):
    image = np.random.default_rng(levels).integers(0, levels, (80, 90)).astype(np.uint8)
    rows, columns = (axis.ravel() for axis in np.mgrid[:80:3, :90:3])
    ours = local_entropy(image, np.ones(image.shape, dtype=bool), rows, columns)
    np.testing.assert_allclose(ours, rank_entropy(image, footprint_rectangle((9, 9)))[rows, columns], atol=1e-5)


def test_entropy_counts_the_object_alone():
    rng = np.random.default_rng(3)
    image, mask = rng.integers(0, 9, (80, 90)).astype(np.uint8), rng.random((80, 90)) < 0.5
    rows, columns = np.nonzero(mask)
    expected = rank_entropy(image, footprint_rectangle((9, 9)), mask=mask.astype(np.uint8))[rows, columns]
    np.testing.assert_allclose(local_entropy(image, mask, rows, columns), expected, atol=1e-5)
    assert not local_entropy(image, np.zeros_like(mask), rows, columns).any()


def test_dkl_axes_are_blind_to_grey_and_to_each_other():
    np.testing.assert_allclose(MECHANISMS.sum(axis=1), [1, 0, 0], atol=1e-12)
    cones = np.linalg.inv(RGB_TO_LMS)
    lum, red_green, blue_yellow = MECHANISMS @ cones
    np.testing.assert_allclose([lum[2], red_green[2]], 0, atol=1e-12)  # S cones feed neither
    assert lum[0] == pytest.approx(lum[1])
    assert MECHANISMS[1, 0] > 0 > MECHANISMS[1, 1] and MECHANISMS[2, 2] > 0


def test_log_is_zero_on_a_slope_and_strong_beside_a_step():
    slope = np.tile(np.arange(80, dtype=np.uint8), (40, 1))
    assert np.abs(laplacian_of_gaussian(slope, 2)[10:30, 10:70]).max() < 1e-5
    step = np.where(slope < 40, 0, 200).astype(np.uint8)
    row = np.abs(laplacian_of_gaussian(step, 2))[20]
    assert abs(int(row.argmax()) - 39.5) <= 3 and row[10:30].max() < 1e-4
    # Extremes of the second derivative of a blurred step: height / sqrt(2 pi e) at one sigma.
    assert row.max() == pytest.approx(200 / 255 / np.sqrt(2 * np.pi * np.e), rel=0.12)

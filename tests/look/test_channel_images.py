"""The channels that look at the image alone, and their formulas in T3.1.1, on images with a known answer."""

import numpy as np
import pytest
from skimage.filters.rank import entropy as rank_entropy
from skimage.morphology import footprint_rectangle

from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.channels.colour import LINEAR, MECHANISMS, RGB_TO_LMS, mechanisms, opponency
from haptic_glance.look.channels.texture import local_entropy, local_variance
from haptic_glance.look.views import View, Viewpoint
from haptic_glance.mesh.mesh import Mesh

TRIANGLE = Mesh([[0, -0.5, -0.5], [0, 0.5, -0.5], [0, 0, 0.5]], [[0, 1, 2]])
IMAGE_CHANNELS = sorted(set(CHANNELS) - {"curvature", "symmetry"})


def maps(rgb, *names, mask=None):
    """Maps of an image whose every pixel (or the pixels of the mask) shows face 0."""
    mask = np.ones(rgb.shape[:2], dtype=bool) if mask is None else mask
    depth = np.where(mask, 10, np.inf).astype(np.float32)
    view = View(rgb, depth, np.where(mask, 0, -1).astype(np.int32), Viewpoint(0, 0))
    return conspicuity(TRIANGLE, view, names)


def grey(image):
    return np.asarray(image, dtype=np.uint8)[..., None].repeat(3, axis=2)


def distance_from(values, row, column):
    """Pixels of the view between the maximum of a map, a quarter of its size, and a place."""
    return np.hypot(*(np.array(np.unravel_index(values.argmax(), values.shape)) * 4 + 1.5 - (row, column)))


@pytest.mark.parametrize("level", [150, 0])
def test_a_uniform_disc_on_black_gives_nothing(level):
    y, x = np.mgrid[:225, :300]
    disc = np.hypot(y - 110, x - 145) < 75
    for channel, values in maps(grey(np.where(disc, level, 0)), *IMAGE_CHANNELS, mask=disc).items():
        assert not values.any(), channel


def test_a_bright_dot_stands_out():
    y, x = np.mgrid[:450, :600]
    image = grey(np.where(np.hypot(y - 160, x - 400) < 16, 240, 120))
    for channel, values in maps(image, "intensity", "dkl", "contrast", "orientation", "edge", "entropy").items():
        assert distance_from(values, 160, 400) < 30, channel  # contrast and entropy see it from all of their window
        assert values.max() > 0.3 or channel in ("edge", "entropy", "orientation")


@pytest.mark.parametrize(
    ("rgb", "answer"),
    [
        ((255, 0, 0), (1, 0)),
        ((0, 255, 0), (-1, 0)),
        ((0, 0, 255), (0, 1)),
        ((255, 255, 0), (0, -1)),
        ((90, 90, 90), (0, 0)),
        ((255, 153, 0), (0.7 - 0.1, -0.6)),  # R = 1 - 0.3, G = 0.6 - 0.5, Y = 0.8 - 0.2
    ],
)
def test_opponency_by_hand(rgb, answer):
    planes = opponency(np.full((2, 2, 3), rgb, dtype=np.uint8))
    np.testing.assert_allclose([plane[0, 0] for plane in planes], answer, atol=1e-6)


def test_dkl_is_the_cited_matrix_and_greys_are_luminance_alone():
    # Vienot, Brettel and Mollon 1999, equation 4: L + M of the white is 100.
    np.testing.assert_allclose(RGB_TO_LMS[:2].sum(), 100, atol=0.01)
    np.testing.assert_allclose(MECHANISMS[0], RGB_TO_LMS[:2].sum(axis=0) / RGB_TO_LMS[:2].sum())
    cones = np.linalg.solve(RGB_TO_LMS.T, MECHANISMS.T).T  # the mechanisms as sums of L, M, S
    np.testing.assert_allclose(cones[:2, 2], 0, atol=1e-12)
    assert cones[1, 0] > 0 > cones[1, 1] and cones[2, 2] > 0 > cones[2, 0] == pytest.approx(cones[2, 1])
    greys = mechanisms(LINEAR.astype(np.float32)[grey(np.arange(256)[None])])[0]
    assert (np.diff(greys[:, 0]) > 0).all() and greys[0, 0] == 0 and greys[-1, 0] == pytest.approx(1)
    assert np.abs(greys[:, 1:]).max() < 1e-6


def test_contrast_is_the_variance_of_the_object_alone():
    rng = np.random.default_rng(0)
    image, counted = rng.integers(0, 256, (60, 70)).astype(np.uint8), rng.random((60, 70)) < 0.7
    variances = local_variance(image, counted, 9)
    window = (slice(26, 35), slice(36, 45))
    assert variances[30, 40] == pytest.approx(np.var(image[window][counted[window]] / 255), rel=1e-5)
    assert not local_variance(image, np.zeros_like(counted), 9).any()


def test_entropy_is_that_of_scikit_image_and_counts_the_object_alone():
    rng = np.random.default_rng(3)
    image, mask = rng.integers(0, 17, (80, 90)).astype(np.uint8), rng.random((80, 90)) < 0.5
    rows, columns = np.nonzero(mask)
    for counted in (mask, np.ones_like(mask)):
        expected = rank_entropy(image, footprint_rectangle((9, 9)), mask=counted.astype(np.uint8))[rows, columns]
        np.testing.assert_allclose(local_entropy(image, counted, rows, columns), expected, atol=1e-5)
    assert not local_entropy(image, np.zeros_like(mask), rows, columns).any()


def test_a_lone_salt_pixel_is_no_entropy_but_a_block_is():
    image = np.full((300, 400), 120)
    image[150, 200] = 255
    assert local_entropy(image.astype(np.uint8), image > 0, np.array([150]), np.array([200]))[0] > 0
    assert not maps(grey(image), "entropy")["entropy"].any()
    image[149:152, 199:202] = 255
    assert distance_from(maps(grey(image), "entropy")["entropy"], 150, 200) < 12

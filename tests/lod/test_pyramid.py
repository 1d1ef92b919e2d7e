"""The Laplacian-pyramid distances: scores of a published library, and what the formulas say."""

import numpy as np
import pytest

from haptic_glance.lod import picture_errors
from haptic_glance.lod.perceptual import laplacian_pyramid, normalise

# plenoptic 1.2.0 in double precision: metric.nlpd, and the same pooling over simulate.LaplacianPyramid(6, True).
SCORES = {
    ("shift", 225, 300): (0.36543885290173156, 0.016516276691764212),
    ("dim", 225, 300): (0.13332724018625994, 0.027690308494356164),
    ("disc", 225, 300): (0.06712956759611077, 0.0023228889528150677),
    ("shift", 96, 128): (0.34549342832544944, 0.015222016290472165),
    ("dim", 96, 128): (0.1572109614085762, 0.0295562749060366),
    ("disc", 96, 128): (0.0662592337732514, 0.002353971171430144),
    ("shift", 67, 81): (0.5243430908999467, 0.0224654911279288),
    ("dim", 67, 81): (0.167706308298362, 0.029703061685613277),
    ("disc", 67, 81): (0.06685266749247444, 0.002492714241497552),
    ("shift", 64, 50): (0.6052396636084998, 0.025705877132114367),
    ("dim", 64, 50): (0.18945094342219282, 0.03045388886340861),
    ("disc", 64, 50): (0.06196616933962821, 0.002474239311256318),
}


def waves(rows, columns):
    r, c = np.mgrid[:rows, :columns].astype(float)
    return 0.5 + 0.25 * np.sin(r / 7 + 0.3 * np.sin(c / 11)) + 0.2 * np.cos(c / 5 - r / 13)


def pair(kind, rows, columns):
    """Two pictures, 0 to 255: waves moved by two pixels, waves dimmed, a disc of waves on black with a fine pattern."""
    image = waves(rows, columns)
    r, c = np.mgrid[:rows, :columns].astype(float)
    if kind == "disc":
        inside = (r - rows / 2) ** 2 + (c - columns / 2) ** 2 < (min(rows, columns) / 3) ** 2
        return 255 * inside * image, 255 * inside * (image + 0.05 * np.cos(r * 1.7) * np.cos(c * 1.3))
    return 255 * image, 255 * (np.roll(image, 2, 1) if kind == "shift" else 0.8 * image)


def distances(one, other):
    """(2,) the plain and the normalised distance of two pictures."""
    errors = picture_errors(one[None], other[None])
    return np.array([errors["dlap"], errors["dnor"]])


@pytest.mark.parametrize("case", SCORES)
def test_distances_are_those_of_plenoptic(case):
    plain, normalised = distances(*pair(*case))
    assert plain == pytest.approx(SCORES[case][1], rel=1e-6)  # in single precision
    assert normalised == pytest.approx(SCORES[case][0], abs=2e-6)  # plenoptic adds 1e-10 under the root of every band


def test_distances_are_a_symmetric_zero_for_equal_pictures():
    one, other = pair("disc", 60, 80)
    assert not distances(one, one).any()
    assert (distances(one, other) == distances(other, one)).all() and (distances(one, other) > 0).all()


def test_distances_grow_with_the_difference():
    image = 255 * waves(60, 80)
    noise = np.random.default_rng(0).normal(size=image.shape)
    errors = np.stack([distances(image, image + size * noise) for size in (0, 1, 4, 16)])
    assert (np.diff(errors, axis=0) > 0).all()


def test_bands_add_up_to_the_picture():
    import cv2

    image = 255 * waves(64, 96)
    rest, *bands = laplacian_pyramid(image)[::-1]
    for band in bands:
        rimmed = cv2.copyMakeBorder(rest, 1, 1, 1, 1, cv2.BORDER_REFLECT_101)
        rest = band + cv2.pyrUp(rimmed)[2 : 2 + band.shape[0], 2 : 2 + band.shape[1]]
    assert 255 * rest == pytest.approx(image, abs=1e-4)


def test_an_even_picture_has_only_its_mean():
    *bands, rest = laplacian_pyramid(np.full((64, 96), 102.0))
    assert max(np.abs(band).max() for band in bands) < 1e-7
    assert rest == pytest.approx(np.full(rest.shape, 0.4), rel=1e-6)


def test_plain_distance_is_linear_and_the_normalised_one_forgives_contrast():
    one, other = pair("disc", 60, 80)
    assert distances(one / 2, other / 2)[0] == pytest.approx(distances(one, other)[0] / 2)
    weak, strong = (normalise(laplacian_pyramid(gain * one))[0] for gain in (0.5, 1.0))
    assert np.abs(strong).max() < 2 * np.abs(weak).max()


def test_the_ground_beside_an_object_thins_the_error():
    one, other = pair("disc", 60, 80)
    wide = distances(*(np.pad(image, ((30, 30), (40, 40))) for image in (one, other)))
    assert (wide > 0).all() and (wide < distances(one, other)).all()


def test_small_pictures_give_finite_distances():
    for size in (11, 12, 13):
        found = distances(np.zeros((size, size + 1)), np.eye(size, size + 1) * 255)
        assert (found > 0).all() and np.isfinite(found).all()

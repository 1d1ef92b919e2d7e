"""The errors of pictures: SSIM as published, and Laplacian pyramids as a published library has them."""

import numpy as np
import pytest
import trimesh
from skimage.metrics import structural_similarity

from haptic_glance.base.similarity import local_moments
from haptic_glance.lod import perceptual, picture_errors, simplify, take_pictures
from haptic_glance.lod.perceptual import ssim_error
from haptic_glance.look.views import FOUR
from haptic_glance.mesh.mesh import Mesh

KNOT = trimesh.creation.torus(0.33, 0.14, major_sections=48, minor_sections=24)
RING = Mesh(KNOT.vertices, KNOT.faces)
SMALL = (60, 80)


def test_errors_grow_as_faces_go_from_none():
    assert perceptual(RING, RING, FOUR[:1], SMALL) == {"ssim": 0.0, "dlap": 0.0, "dnor": 0.0}
    first, other = (perceptual(RING, simplify(RING, faces), FOUR[:1], SMALL) for faces in (800, 100))
    assert all(0 < first[name] < other[name] for name in ("ssim", "dlap", "dnor"))


def test_errors_are_means_over_the_views():
    reference, other = (take_pictures(mesh, FOUR[:2], SMALL) for mesh in (RING, simplify(RING, 300)))
    alone = [picture_errors(reference[[k]], other[[k]]) for k in range(2)]
    errors = picture_errors(reference, other)
    assert errors == pytest.approx({name: (alone[0][name] + alone[1][name]) / 2 for name in errors}, rel=1e-12)
    assert alone[0]["ssim"] == ssim_error(reference[0], other[0]) > 0


@pytest.mark.parametrize("corner", [(2, 5), (30, 50), (58, 95), (0, 50)])
def test_ssim_error_is_that_of_scikit_image_near_the_border_and_in_the_middle(corner):
    reference, other = np.zeros((90, 120)), np.zeros((90, 120))
    noise, (row, column) = np.random.default_rng(0).uniform(1, 255, (30, 20)), corner
    reference[row + 2 : row + 32, column - 5 : column + 15] = noise
    other[row : row + 30, column : column + 20] = noise[::-1]
    expected = 1 - structural_similarity(
        reference, other, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255
    )
    assert ssim_error(reference, other) == pytest.approx(expected, rel=1e-9)
    assert ssim_error(reference, other, local_moments(reference)) == pytest.approx(expected, rel=1e-9)


def test_ssim_error_leaves_the_border_out_and_needs_one_whole_window():
    reference, other = np.zeros((40, 50)), np.zeros((40, 50))
    other[0, :], other[:, -1] = 255, 255
    inside = 1 - structural_similarity(
        reference, other, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255
    )
    assert ssim_error(reference, other) == pytest.approx(inside, rel=1e-9) and inside > 0
    assert 0 < ssim_error(np.zeros((11, 11)), np.full((11, 11), 9.0)) < 1
    with pytest.raises(ValueError, match="window of 11"):
        ssim_error(np.zeros((10, 50)), np.zeros((10, 50)))


def test_constant_shift_has_the_published_value():
    # Without contrast only the luminance term is left: (2 a b + C1) / (a^2 + b^2 + C1); Wang et al. 2004, eq. 6.
    a, b, c1 = 100.0, 140.0, (0.01 * 255) ** 2
    expected = 1 - (2 * a * b + c1) / (a * a + b * b + c1)
    assert ssim_error(np.full((40, 50), a), np.full((40, 50), b)) == pytest.approx(expected, rel=1e-9)
    assert ssim_error(np.zeros((20, 20)), np.zeros((20, 20))) == 0


# plenoptic 1.2.0 in double precision: metric.nlpd, and the same pooling over simulate.LaplacianPyramid(6, True).
SCORES = {
    ("shift", 225, 300): (0.36543885290173156, 0.016516276691764212),
    ("dim", 67, 81): (0.167706308298362, 0.029703061685613277),
    ("disc", 67, 81): (0.06685266749247444, 0.002492714241497552),
    ("shift", 64, 50): (0.6052396636084998, 0.025705877132114367),
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


def distances(image, other):
    """(2,) the plain and the normalised distance of two pictures."""
    errors = picture_errors(image[None], other[None])
    return np.array([errors["dlap"], errors["dnor"]])


@pytest.mark.parametrize("case", SCORES)
def test_distances_are_those_of_plenoptic(case):
    plain, normalised = distances(*pair(*case))
    assert plain == pytest.approx(SCORES[case][1], rel=1e-6)  # in single precision
    assert normalised == pytest.approx(SCORES[case][0], abs=2e-6)  # plenoptic adds 1e-10 under the root of every band


def test_distances_are_a_symmetric_zero_for_equal_pictures():
    first, other = pair("disc", 60, 80)
    assert not distances(first, first).any()
    assert (distances(first, other) == distances(other, first)).all() and (distances(first, other) > 0).all()
    smallest = distances(np.zeros((11, 12)), np.eye(11, 12) * 255)
    assert (smallest > 0).all() and np.isfinite(smallest).all()

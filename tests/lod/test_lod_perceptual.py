"""The picture errors: zero for equal, larger for coarser, and SSIM as published."""

import numpy as np
import pytest
import trimesh
from skimage.metrics import structural_similarity

from stages.kit import Mesh
from stages.lod import perceptual, picture_errors, simplify, take_pictures
from stages.lod.perceptual import ssim_error
from stages.views import FOUR

KNOT = trimesh.creation.torus(0.33, 0.14, major_sections=48, minor_sections=24)
RING = Mesh(KNOT.vertices, KNOT.faces)
SMALL = (60, 80)


def test_equal_meshes_have_no_error():
    assert perceptual(RING, RING, FOUR, SMALL) == {"ssim": 0.0}


def test_error_grows_as_faces_go():
    errors = [perceptual(RING, simplify(RING, faces), FOUR[:2], SMALL)["ssim"] for faces in (1500, 400, 100)]
    assert 0 < errors[0] < errors[1] < errors[2] < 1


def test_pictures_made_once_give_the_same_error():
    coarse = simplify(RING, 300)
    reference = take_pictures(RING, FOUR, SMALL)
    assert reference.shape == (4, *SMALL)
    assert picture_errors(reference, take_pictures(coarse, FOUR, SMALL)) == perceptual(RING, coarse, FOUR, SMALL)


def test_the_box_changes_nothing():
    reference, other = np.zeros((90, 120)), np.zeros((90, 120))
    noise = np.random.default_rng(0).uniform(1, 255, (30, 20))
    reference[40:70, 50:70], other[38:68, 55:75] = noise, noise[::-1]
    _, whole = structural_similarity(
        reference, other, win_size=11, gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
        data_range=255, full=True,
    )  # fmt: skip
    assert ssim_error(reference, other) == pytest.approx(1 - whole.mean(), rel=1e-9)


def test_constant_shift_has_the_published_value():
    # Without contrast only the luminance term is left: (2 a b + C1) / (a^2 + b^2 + C1); Wang et al. 2004, eq. 6.
    a, b, c1 = 100.0, 140.0, (0.01 * 255) ** 2
    expected = 1 - (2 * a * b + c1) / (a * a + b * b + c1)
    assert ssim_error(np.full((40, 50), a), np.full((40, 50), b)) == pytest.approx(expected, rel=1e-9)


def test_empty_pictures_are_alike():
    assert ssim_error(np.zeros((20, 20)), np.zeros((20, 20))) == 0


def test_bad_arguments_are_named():
    with pytest.raises(ValueError, match="one viewpoint"):
        take_pictures(RING, (), SMALL)
    with pytest.raises(ValueError, match="11 pixels"):
        take_pictures(RING, FOUR, (8, 8))
    with pytest.raises(ValueError, match="compared"):
        picture_errors(np.zeros((2, 20, 20)), np.zeros((1, 20, 20)))

"""The picture errors: zero for equal, larger for coarser, and SSIM as published."""

import numpy as np
import pytest
import trimesh
from skimage.metrics import structural_similarity

from haptic_glance.base.similarity import local_moments
from haptic_glance.lod import perceptual, picture_errors, simplify, take_pictures
from haptic_glance.lod.perceptual import analyse, ssim_error
from haptic_glance.look.views import FOUR
from haptic_glance.mesh.mesh import Mesh

KNOT = trimesh.creation.torus(0.33, 0.14, major_sections=48, minor_sections=24)
RING = Mesh(KNOT.vertices, KNOT.faces)
SMALL = (60, 80)


def test_equal_meshes_have_no_error():
    assert perceptual(RING, RING, FOUR, SMALL) == {"ssim": 0.0, "dlap": 0.0, "dnor": 0.0}


def test_errors_grow_as_faces_go():
    found = [perceptual(RING, simplify(RING, faces), FOUR[:2], SMALL) for faces in (1500, 400, 100)]
    for name in ("ssim", "dlap", "dnor"):
        errors = [each[name] for each in found]
        assert 0 < errors[0] < errors[1] < errors[2], name


def test_errors_are_means_over_the_views():
    coarse = simplify(RING, 300)
    both = [perceptual(RING, coarse, (viewpoint,), SMALL) for viewpoint in FOUR[:2]]
    found = perceptual(RING, coarse, FOUR[:2], SMALL)
    assert found == pytest.approx({name: (both[0][name] + both[1][name]) / 2 for name in found}, rel=1e-12)


def test_the_ssim_of_one_view_is_that_of_its_pictures():
    reference, other = (take_pictures(mesh, FOUR[:1], SMALL) for mesh in (RING, simplify(RING, 200)))
    assert picture_errors(reference, other)["ssim"] == ssim_error(reference[0], other[0]) > 0


def test_pictures_made_once_give_the_same_error():
    coarse = simplify(RING, 300)
    reference = take_pictures(RING, FOUR, SMALL)
    assert reference.shape == (4, *SMALL)
    pictures = take_pictures(coarse, FOUR, SMALL)
    assert picture_errors(reference, pictures, analyse(reference)) == perceptual(RING, coarse, FOUR, SMALL)


@pytest.mark.parametrize("corner", [(2, 5), (38, 55), (58, 95)])
def test_the_box_changes_nothing(corner):
    reference, other = np.zeros((90, 120)), np.zeros((90, 120))
    noise, (row, column) = np.random.default_rng(0).uniform(1, 255, (30, 20)), corner
    reference[row + 2 : row + 32, column - 5 : column + 15] = noise
    other[row : row + 30, column : column + 20] = noise[::-1]
    _, whole = structural_similarity(
        reference, other, win_size=11, gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
        data_range=255, full=True,
    )  # fmt: skip
    assert ssim_error(reference, other) == pytest.approx(1 - whole.mean(), rel=1e-9)
    assert ssim_error(reference, other, local_moments(reference)) == pytest.approx(1 - whole.mean(), rel=1e-9)


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
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 3)))
    for pair in ((empty, RING), (RING, empty)):
        with pytest.raises(ValueError, match="a mesh without faces has no picture to compare"):
            perceptual(*pair, FOUR, SMALL)
    with pytest.raises(ValueError, match="compared"):
        picture_errors(np.zeros((2, 20, 20)), np.zeros((1, 20, 20)))

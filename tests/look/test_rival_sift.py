"""3D-SIFT (Godil 2011) on shapes whose keypoints are known."""

import numpy as np
import pytest
from scipy.ndimage import maximum_filter
from scipy.special import erf

from haptic_glance.look.kernels import scale_peaks, spaced, splat
from haptic_glance.look.rivals import sift
from haptic_glance.mesh.mesh import Mesh

X = np.array([1.0, 0, 0])


def test_peaks_are_the_maxima_of_their_neighbourhood_in_space_and_scale():
    values = np.random.default_rng(0).integers(0, 40, (5, 7, 8, 9)).astype(np.float32)  # many ties
    expected = (values == maximum_filter(values, 3)) & (values > 38)
    expected[[0, -1]] = False
    assert scale_peaks(values, 38.0).tolist() == np.flatnonzero(expected).tolist() != []


def test_values_on_a_grid_keep_their_sum_and_their_centre():
    places = np.random.default_rng(0).uniform(0, 5, (20, 3))
    field = splat(places, np.ones((20, 1)), (6, 7, 8))[0]
    assert field.sum() == pytest.approx(20)
    centre = [(np.arange(n) * field.sum(axis=tuple({0, 1, 2} - {axis}))).sum() / 20 for axis, n in enumerate((6, 7, 8))]
    assert centre == pytest.approx(places.mean(axis=0))


def test_spaced_positions_are_the_first_ones_that_keep_the_distance():
    line = np.array([0, 0.5, 1.2, 1.3, 2.5])[:, None] * X
    assert spaced(line, 1.0, 0, 5).tolist() == [0, 2, 4]
    assert spaced(line, 1.0, 2, 5).tolist() == [0, 1, 4]
    assert spaced(line, 1.0, 0, 2).tolist() == [0, 2]


@pytest.mark.slow
def test_a_bump_of_the_right_size_is_the_only_point_and_a_wide_swell_has_no_saliency(
    bump_and_swell, sphere, saliency_of
):
    values = saliency_of(sift, bump_and_swell)
    found = sift.points(bump_and_swell, values)
    assert len(found) == 1
    assert np.linalg.norm(bump_and_swell.vertices[found[0]] - 1.06 * X) < 0.05
    assert values[sphere(5).vertices[:, 0].argmin()] == 0


@pytest.mark.slow
def test_a_bump_below_a_voxel_has_no_saliency(sphere, raised):
    assert sift.saliency(raised(sphere(5).vertices[[1]], [0.013], [0.01])).max() == 0


@pytest.mark.slow
def test_a_small_ball_is_a_keypoint_of_its_own_size(sphere):
    """The difference of Gaussians answers a ball of radius r most at its centre, at sigma = r / sqrt(3)."""
    large, small = sphere(5), 0.12 * sphere(2).vertices + [0, 0, 1.5]
    mesh = Mesh(np.r_[large.vertices, small], np.r_[large.faces, sphere(2).faces + len(large.vertices)])
    values = sift.saliency(mesh)
    assert values.argmax() >= len(large.vertices)
    keypoint = sift._keypoints(mesh)
    best = keypoint.responses.argmax()
    np.testing.assert_allclose(keypoint.positions[best], [0, 0, 1.5], atol=0.03)
    ratio = keypoint.sigmas[best] * 2 ** (1 / 6) * np.sqrt(3) / 0.12  # the middle of the two Gaussians
    assert 2 ** (-1 / 3) < ratio < 2 ** (1 / 3)


def test_the_scale_space_is_that_of_the_solid_ball(sphere):
    """At the centre of a ball a Gaussian sees erf(u) - 2 u exp(-u^2) / sqrt(pi) of it, u = radius / (sqrt(2) sigma)."""
    mesh = sphere(5, 0.1)
    speck = [[1, 0, 0], [1, 1e-4, 0], [1, 0, 1e-4]]  # makes the ball small in the grid
    mesh = Mesh(np.r_[mesh.vertices, speck], np.r_[mesh.faces, [len(mesh.vertices) + np.arange(3)]])
    origin, step, dogs = sift._scale_space(mesh.vertices[mesh.faces])
    voxel = np.round(-origin / step).astype(int)
    u = 0.1 / step / (np.sqrt(2) * sift.SIGMA * 2 ** (np.arange(len(dogs) + 1) / sift.INTERVALS))
    held = erf(u) - 2 * u * np.exp(-(u**2)) / np.sqrt(np.pi)
    np.testing.assert_allclose([dog[tuple(voxel)] for dog in dogs], np.diff(held), atol=0.01)


@pytest.mark.slow
def test_a_dent_counts_like_a_bump_and_a_hole_elsewhere_does_not_matter(raised):
    dent = raised([X], [0.08], [-0.06])
    bump = raised([X], [0.08], [0.06])
    open_ = Mesh(bump.vertices, bump.faces[(bump.vertices[bump.faces][:, :, 0] > -0.8).all(axis=1)])
    for mesh in dent, open_:
        assert np.linalg.norm(mesh.vertices[sift.points(mesh)[0]] - X) < 0.15

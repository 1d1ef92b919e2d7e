"""Detectors by centre and surround (mesh saliency, salient points, 3D-SIFT, corners) on shapes of known scales."""

import numpy as np
import pytest
import trimesh
from scipy.ndimage import maximum_filter
from scipy.special import erf

from haptic_glance.look.points.fuse import spaced
from haptic_glance.look.rivals import corners, mesh_saliency, salient_points, sift
from haptic_glance.look.rivals.maxima import local_maxima
from haptic_glance.look.rivals.samples import gaussian_average, gaussian_sums, subdivide, surface_elements
from haptic_glance.look.rivals.sift import scale_peaks, splat
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, flat_grid, mesh_of, raised_ball

X = np.array([1.0, 0, 0])
TOPS = [[0, 0, 1], [0, 1, 0]]
MESH = ball_mesh(3)
CUBE = mesh_of(trimesh.creation.box().subdivide().subdivide().subdivide().subdivide().subdivide())


@pytest.mark.parametrize(("rival", "swollen"), [(mesh_saliency, 0.1), (salient_points, 0.3), (sift, 0)])
@pytest.mark.slow
def test_a_bump_of_the_right_size_is_the_first_point_and_a_wide_swell_is_none(rival, swollen):
    """A bump of 2 % of the diagonal at +x and a swell of 14 % at -x."""
    mesh = raised_ball([X, -X], [0.08, 0.5], [0.06, 0.12])
    values = rival.saliency(mesh)
    points = rival.points(mesh, values)
    along = ball_mesh(4).vertices[:, 0]
    top, swell = along.argmax(), along.argmin()
    assert np.linalg.norm(mesh.vertices[points[0]] - 1.06 * X) < 0.05 and swell not in points
    assert values[swell] <= swollen * values[top]
    assert points[0] == top if rival is not sift else len(points) == 1


def test_salient_points_exceed_three_tenths_of_the_maximum():
    mesh = raised_ball(np.eye(3), [0.08, 0.08, 0.08], [0.06, 0.006, 0.04])
    values = salient_points.saliency(mesh)
    points = salient_points.points(mesh, values)
    assert len(points) == 2 and values[points].min() > 0.3


def test_peaks_are_those_of_a_plain_search_whatever_the_order_of_vertices():
    values = np.random.default_rng(0).random(len(MESH.vertices)) - 0.2
    apart = np.linalg.norm(MESH.vertices[:, None] - MESH.vertices[None], axis=2)
    best = np.where(apart <= 0.3, values, -np.inf).max(axis=1)
    expected = np.flatnonzero((values == best) & (values > 0))
    np.testing.assert_array_equal(local_maxima(MESH, values, 0.3), expected[np.argsort(-values[expected])])
    among = values < 0.7  # the higher ones still outrank them
    np.testing.assert_array_equal(
        local_maxima(MESH, values, 0.15, among), [p for p in local_maxima(MESH, values, 0.15) if among[p]]
    )
    assert len(local_maxima(MESH, np.ones(len(MESH.vertices)), 0.5)) == 0  # a plateau has no peak
    values = (np.abs(MESH.vertices[:, 0]) > 0.97).astype(float)
    order = np.random.default_rng(1).permutation(len(values))
    shuffled = Mesh(MESH.vertices[order], np.argsort(order)[MESH.faces])
    peaks = local_maxima(MESH, values, 0.6)  # equal ones, told apart by position
    assert len(peaks) == 2
    np.testing.assert_array_equal(order[local_maxima(shuffled, values[order], 0.6)], peaks)


def test_pieces_are_short_and_keep_the_area():
    sliver = Mesh([[0, 0, 0], [1, 0, 0], [0.5, 0.001, 0]], [[0, 1, 2]])
    for mesh in MESH, sliver:
        pieces = subdivide(mesh, mesh.vertices)
        assert np.linalg.norm(np.roll(pieces, 1, axis=1) - pieces, axis=2).max() <= 0.01 * mesh.diagonal * 1.5
        np.testing.assert_allclose(surface_elements(mesh, mesh.vertices).areas.sum(), mesh.face_areas.sum())
        np.testing.assert_allclose(pieces[..., 3:], pieces[..., :3], atol=1e-12)


def test_an_average_of_one_value_is_that_value_and_of_a_sphere_lies_below_it():
    """Within 2 sigma of the Gaussian a sphere of radius 1 sinks by the mean of distance^2 / 2 along the normal."""
    sigma, mesh = 0.1, ball_mesh(5)
    averages = gaussian_average(MESH, surface_elements(MESH, np.ones((len(MESH.vertices), 1))), sigma)
    np.testing.assert_allclose(averages, 1)
    means = gaussian_average(mesh, surface_elements(mesh, mesh.vertices), sigma)
    sunk = 1 - np.einsum("ij,ij->i", means, mesh.vertices)
    mean_square = 2 * sigma**2 * (1 - 2 * np.exp(-2) / (1 - np.exp(-2)))  # of a Gaussian in the plane, cut at 2 sigma
    np.testing.assert_allclose(sunk.mean(), mean_square / 2, rtol=0.05)


@pytest.mark.parametrize("sigma", [1e-3, 0.1, 3.0])
def test_gaussian_sums_are_those_over_all_pairs_within_two_sigma(sigma):
    draw = np.random.default_rng(0)
    places, points, values = draw.uniform(-1, 2, (40, 3)), draw.uniform(size=(300, 3)), draw.uniform(size=(300, 2))
    places[:20] = points[:20]
    squared = ((places[:, None] - points) ** 2).sum(axis=2)
    weights = np.where(squared <= 4 * sigma**2, np.exp(squared / (-2 * sigma**2)), 0)
    np.testing.assert_allclose(gaussian_sums(places, points, values, sigma), weights @ values, atol=1e-12)


def test_an_average_does_not_follow_the_tessellation_and_is_none_where_no_surface_is_near():
    rng = np.random.default_rng(2)
    box = trimesh.creation.box()
    fine = trimesh.Trimesh(*trimesh.remesh.subdivide(box.vertices, box.faces, rng.choice(12, 5, replace=False)))
    coarse, other = Mesh(np.r_[box.vertices, [[9, 9, 9]]], box.faces), mesh_of(fine)
    first, second = (gaussian_average(mesh, surface_elements(mesh, mesh.vertices), 0.1) for mesh in (coarse, other))
    np.testing.assert_allclose(first[:-1], second[: len(first) - 1], atol=0.003)
    assert np.isnan(first[-1]).all()


def test_peaks_of_a_scale_space_are_the_maxima_of_their_neighbourhood():
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


def test_a_small_ball_is_a_keypoint_of_its_own_size():
    """The difference of Gaussians answers a ball of radius r most at its centre, at sigma = r / sqrt(3)."""
    large, small = ball_mesh(4), 0.12 * ball_mesh(2).vertices + [0, 0, 1.5]
    mesh = Mesh(np.r_[large.vertices, small], np.r_[large.faces, ball_mesh(2).faces + len(large.vertices)])
    assert sift.saliency(mesh).argmax() >= len(large.vertices)
    keypoint = sift._keypoints(mesh)
    best = keypoint.responses.argmax()
    np.testing.assert_allclose(keypoint.positions[best], [0, 0, 1.5], atol=0.03)
    ratio = keypoint.sigmas[best] * 2 ** (1 / 6) * np.sqrt(3) / 0.12  # the middle of the two Gaussians
    assert 2 ** (-1 / 3) < ratio < 2 ** (1 / 3)


def test_the_scale_space_is_that_of_the_solid_ball():
    """At the centre of a ball a Gaussian sees erf(u) - 2 u exp(-u^2) / sqrt(pi) of it, u = radius / (sqrt(2) sigma)."""
    mesh = ball_mesh(5, 0.1)
    speck = [[1, 0, 0], [1, 1e-4, 0], [1, 0, 1e-4]]  # makes the ball small in the grid
    mesh = Mesh(np.r_[mesh.vertices, speck], np.r_[mesh.faces, [len(mesh.vertices) + np.arange(3)]])
    origin, step, dogs = sift._scale_space(mesh.vertices[mesh.faces])
    voxel = np.round(-origin / step).astype(int)
    u = 0.1 / step / (np.sqrt(2) * sift.SIGMA * 2 ** (np.arange(len(dogs) + 1) / sift.INTERVALS))
    held = erf(u) - 2 * u * np.exp(-(u**2)) / np.sqrt(np.pi)
    np.testing.assert_allclose([dog[tuple(voxel)] for dog in dogs], np.diff(held), atol=0.01)


def test_the_corner_value_on_a_sphere_is_the_largest_scale_over_the_radius():
    values = corners.saliency(ball_mesh(4, 3))
    assert values.mean() == pytest.approx(corners.SCALES[-1] * np.sqrt(4 * np.pi), rel=0.02)
    assert values.std() < 0.02 * values.mean()


def test_the_corners_of_a_cube_are_its_points_and_edges_and_faces_are_far_below():
    values = corners.saliency(CUBE)
    points = corners.points(CUBE, 5 * values)  # which do not depend on the scale of the values
    assert len(points) == 8 and np.allclose(np.abs(CUBE.vertices[points]), 0.5, atol=0.02)
    extent = np.sort(np.abs(CUBE.vertices), axis=1)
    corner, edge, face = extent[:, 0] > 0.49, (extent[:, 1] > 0.49) & (extent[:, 0] < 0.1), extent[:, 1] < 0.1
    assert corner.sum() == 8 and edge.any() and face.any()
    assert values[edge].max() < 0.3 * values[corner].min() and values[face].max() < 0.3 * values[corner].min()


def test_corners_of_two_sizes_are_found_each_at_its_own_scale(monkeypatch):
    mesh, directions = raised_ball(TOPS, [0.1, 0.2], [0.3, 0.6]), ball_mesh(4).vertices
    responses, points = corners._responses(mesh), corners.points(mesh, corners.saliency(mesh))
    assert ((directions[points[:2]] @ np.transpose(TOPS)).max(axis=0) > np.cos(0.05)).all()
    best = responses[:, points].max(axis=0)
    assert (np.abs(responses[:, points] - best) < 1e-12).any(axis=1).sum() > 1
    peaks = np.unique(np.concatenate([corners.ring_maxima(mesh, response, 1) for response in responses]))
    assert len(points) < 0.7 * len(peaks)  # a peak that is higher at the next scale is none
    tops = (directions @ np.transpose(TOPS)).argmax(axis=0)
    together, single = corners.saliency(mesh)[tops], []
    for scale in corners.SCALES[[0, -1]]:
        monkeypatch.setattr(corners, "SCALES", [scale])
        single.append(corners.saliency(Mesh(mesh.vertices, mesh.faces))[tops])
    assert single[0][0] > 1.2 * single[0][1] and single[1][1] > 1.2 * single[1][0]
    assert (together > single[0]).all()


def test_smoothing_spreads_a_spike_to_the_variance_asked_for():
    grid = flat_grid(81, 81)
    plane = grid.vertices / 80 - [0.5, 0.5, 0]
    spike = np.zeros((6561, 1))
    spike[np.abs(plane).sum(axis=1).argmin()] = 1
    smooth = corners._smoother(Mesh(plane, grid.faces), 0.05**2)(spike)[:, 0]
    assert smooth.sum() == pytest.approx(1, rel=1e-6)
    assert smooth @ plane[:, 0] ** 2 == pytest.approx(0.05**2, rel=0.01)

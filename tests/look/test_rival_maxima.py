"""Peaks and averages that the rival detectors share, against plain loops and known integrals."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.kernels import gaussian_sums
from haptic_glance.look.rivals.maxima import local_maxima
from haptic_glance.look.rivals.samples import gaussian_average, subdivide, surface_elements
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=3)
MESH = Mesh(BALL.vertices, BALL.faces)


def test_peaks_are_those_of_a_plain_search():
    values = np.random.default_rng(0).random(len(MESH.vertices)) - 0.2
    apart = np.linalg.norm(MESH.vertices[:, None] - MESH.vertices[None], axis=2)
    best = np.where(apart <= 0.3, values, -np.inf).max(axis=1)
    expected = np.flatnonzero((values == best) & (values > 0))
    np.testing.assert_array_equal(local_maxima(MESH, values, 0.3), expected[np.argsort(-values[expected])])


def test_a_plateau_has_no_peak_and_equal_peaks_are_told_apart_by_position():
    assert len(local_maxima(MESH, np.ones(len(MESH.vertices)), 0.5)) == 0
    values = (np.abs(MESH.vertices[:, 0]) > 0.97).astype(float)
    order = np.random.default_rng(1).permutation(len(values))
    shuffled = Mesh(MESH.vertices[order], np.argsort(order)[MESH.faces])
    found = local_maxima(MESH, values, 0.6)
    assert len(found) == 2
    np.testing.assert_array_equal(order[local_maxima(shuffled, values[order], 0.6)], found)


@pytest.mark.parametrize(("values", "radius"), [(np.ones(3), 1), (np.full(642, np.nan), 1), (np.ones(642), 0)])
def test_values_that_do_not_fit_and_radii_of_nothing_are_refused(values, radius):
    with pytest.raises(ValueError, match="must be"):
        local_maxima(MESH, values, radius)


def test_pieces_are_short_and_keep_the_area():
    sliver = Mesh([[0, 0, 0], [1, 0, 0], [0.5, 0.001, 0]], [[0, 1, 2]])
    for mesh in MESH, sliver:
        corners = subdivide(mesh, mesh.vertices)
        assert np.linalg.norm(np.roll(corners, 1, axis=1) - corners, axis=2).max() <= 0.01 * mesh.diagonal * 1.5
        np.testing.assert_allclose(surface_elements(mesh, mesh.vertices).areas.sum(), mesh.face_areas.sum())
        np.testing.assert_allclose(corners[..., 3:], corners[..., :3], atol=1e-12)


def test_an_average_of_one_value_is_that_value_and_of_a_sphere_lies_below_it():
    """Within 2 sigma of the Gaussian a sphere of radius 1 sinks by the mean of distance^2 / 2 along the normal."""
    sigma = 0.1
    ones = gaussian_average(MESH, surface_elements(MESH, np.ones((len(MESH.vertices), 1))), sigma)
    np.testing.assert_allclose(ones, 1)
    fine = trimesh.creation.icosphere(subdivisions=5)
    mesh = Mesh(fine.vertices, fine.faces)
    sunk = 1 - np.einsum(
        "ij,ij->i", gaussian_average(mesh, surface_elements(mesh, mesh.vertices), sigma), mesh.vertices
    )
    mean_square = 2 * sigma**2 * (1 - 2 * np.exp(-2) / (1 - np.exp(-2)))  # of a Gaussian in the plane, cut at 2 sigma
    np.testing.assert_allclose(sunk.mean(), mean_square / 2, rtol=0.05)


@pytest.mark.parametrize("sigma", [1e-3, 0.1, 3.0])
def test_gaussian_sums_are_those_over_all_pairs_within_two_sigma(sigma):
    draw = np.random.default_rng(0)
    places, points, values = draw.uniform(-1, 2, (40, 3)), draw.uniform(size=(300, 3)), draw.uniform(size=(300, 2))
    places[:20] = points[:20]
    square = ((places[:, None] - points) ** 2).sum(axis=2)
    weights = np.where(square <= 4 * sigma**2, np.exp(square / (-2 * sigma**2)), 0)
    np.testing.assert_allclose(gaussian_sums(places, points, values, sigma), weights @ values, atol=1e-12)


def test_an_average_does_not_follow_the_tessellation():
    rng = np.random.default_rng(2)
    box = trimesh.creation.box()
    fine = trimesh.Trimesh(*trimesh.remesh.subdivide(box.vertices, box.faces, rng.choice(12, 5, replace=False)))
    coarse, other = Mesh(box.vertices, box.faces), Mesh(fine.vertices, fine.faces)
    first = gaussian_average(coarse, surface_elements(coarse, coarse.vertices), 0.1)
    second = gaussian_average(other, surface_elements(other, other.vertices), 0.1)[: len(first)]
    np.testing.assert_allclose(first, second, atol=0.003)


def test_a_vertex_with_no_surface_near_has_no_average():
    mesh = Mesh(np.r_[MESH.vertices, [[9, 9, 9]]], MESH.faces)
    means = gaussian_average(mesh, surface_elements(mesh, mesh.vertices), 0.1)
    assert np.isnan(means[-1]).all()
    assert np.isfinite(means[:-1]).all()

"""Scale-dependent corners on shapes whose corners and scales are known."""

import numpy as np
import pytest

from haptic_glance.look.rivals import corners
from haptic_glance.mesh.mesh import Mesh

TOPS = [[0, 0, 1], [0, 1, 0]]


@pytest.mark.slow
def test_the_value_on_a_sphere_is_the_largest_scale_over_the_radius(sphere):
    ball = sphere(4, 3)
    values = corners.saliency(ball)
    assert values.mean() == pytest.approx(corners.SCALES[-1] * np.sqrt(4 * np.pi), rel=0.02)
    assert values.std() < 0.02 * values.mean()


def test_the_points_of_a_cube_are_its_corners(cube):
    box = cube(5)
    points = corners.points(box)
    assert len(points) == 8 and np.allclose(np.abs(box.vertices[points]), 0.5, atol=0.02)


def test_a_weak_corner_is_a_point_beside_a_strong_one(raised, sphere):
    mesh, directions = raised(TOPS, [0.15, 0.15], [0.05, 0.6], subdivisions=4), sphere(4).vertices
    tops = (directions @ np.transpose(TOPS)).argmax(axis=0)
    values = corners.saliency(mesh)[tops]
    assert values[0] < 0.6 * values[1]
    near = directions[corners.points(mesh)] @ np.transpose(TOPS) > np.cos(0.1)
    assert near.any(axis=0).all() and near[0, 1]


def test_a_peak_that_is_higher_at_the_next_scale_is_no_point(raised):
    mesh = raised(TOPS, [0.1, 0.2], [0.3, 0.6], subdivisions=4)
    responses = corners._responses(mesh)
    points = corners.points(mesh)
    best = responses[:, points].max(axis=0)
    assert len(points) and (np.abs(responses[:, points] - best) < 1e-12).any(axis=1).sum() > 1
    every = np.unique(np.concatenate([corners.ring_maxima(mesh, own, 1) for own in responses]))
    assert len(points) < 0.7 * len(every)


def test_points_do_not_depend_on_the_scale_of_the_values(cube):
    box = cube(4)
    assert (corners.points(box, 5 * corners.saliency(box)) == corners.points(box)).all()


def test_edges_and_faces_are_far_below_corners(cube):
    box = cube(5)
    values = corners.saliency(box)
    extent = np.sort(np.abs(box.vertices), axis=1)
    corner, edge, face = extent[:, 0] > 0.49, (extent[:, 1] > 0.49) & (extent[:, 0] < 0.1), extent[:, 1] < 0.1
    assert corner.sum() == 8 and edge.any() and face.any()
    assert values[edge].max() < 0.3 * values[corner].min() and values[face].max() < 0.3 * values[corner].min()


def test_bumps_of_two_sizes_are_both_found_at_the_top(raised, sphere):
    mesh, directions = raised(TOPS, [0.1, 0.2], [0.3, 0.6], subdivisions=4), sphere(4).vertices
    points = corners.points(mesh)
    assert ((directions[points[:2]] @ np.transpose(TOPS)).max(axis=0) > np.cos(0.05)).all()


def test_the_small_bump_stands_out_at_the_fine_scale_and_the_large_one_at_the_coarse(raised, sphere, monkeypatch):
    mesh, directions = raised(TOPS, [0.1, 0.2], [0.3, 0.6], subdivisions=4), sphere(4).vertices
    tops = (directions @ np.transpose(TOPS)).argmax(axis=0)
    both = corners.saliency(mesh)[tops]
    single = []
    for scale in corners.SCALES[[0, -1]]:
        monkeypatch.setattr(corners, "SCALES", [scale])
        single.append(corners.saliency(Mesh(mesh.vertices, mesh.faces))[tops])
    assert single[0][0] > 1.2 * single[0][1] and single[1][1] > 1.2 * single[1][0]
    assert (both > single[0]).all()


def test_smoothing_spreads_a_spike_to_the_variance_asked_for(grid):
    vertices, faces = grid(81, 81)
    plane = vertices / 80 - [0.5, 0.5, 0]
    spike = np.zeros((6561, 1))
    spike[np.abs(plane).sum(axis=1).argmin()] = 1
    smooth = corners._smoother(Mesh(plane, faces), 0.05**2)(spike)[:, 0]
    assert smooth.sum() == pytest.approx(1, rel=1e-6)
    assert smooth @ plane[:, 0] ** 2 == pytest.approx(0.05**2, rel=0.01)

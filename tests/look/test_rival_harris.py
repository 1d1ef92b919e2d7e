"""3D-Harris on shapes whose corners, edges and curvature are known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.rivals import harris
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture(scope="module")
def round_cube(sphere):
    """A cube with round edges, |x|^6 + |y|^6 + |z|^6 = 1."""
    ball = sphere(4)
    radius = (np.abs(ball.vertices) ** 6).sum(axis=1) ** (-1 / 6)
    return Mesh(ball.vertices * radius[:, None], ball.faces)


def test_the_value_on_a_sphere_is_the_closed_form(sphere):
    """On z = r - sqrt(r^2 - x^2 - y^2) the fit has p1 = p3 = extent / r, so E = 2 p1^2 I and R = (4 - 0.04 16) p1^4."""
    ball = sphere(5, 0.7)
    values = harris.saliency(ball)
    extent = harris.EXTENT * 2  # of the size, a diameter, in radii
    assert values.mean() == pytest.approx((4 - 16 * harris.HARRIS) ** 0.25 * extent, rel=0.02)
    assert values.std() < 0.02 * values.mean()


def test_a_plane_and_a_cylinder_have_no_corner(grid):
    plane, faces = grid(40, 40)
    plane = plane / 39
    assert harris.saliency(Mesh(plane, faces)).max() < 1e-3
    rolled = np.stack([np.cos(3 * plane[:, 0]), np.sin(3 * plane[:, 0]), 3 * plane[:, 1]], axis=1)
    inner = (np.abs(plane[:, :2] - 0.5) < 0.4).all(axis=1)  # at a border the neighbourhoods are one-sided
    assert harris.saliency(Mesh(rolled, faces))[inner].max() < 1e-3


def test_the_eight_best_points_of_a_cube_are_its_corners(round_cube):
    best = round_cube.vertices[harris.points(round_cube)[:8]]
    assert np.allclose(np.abs(best), 3 ** (-1 / 6), atol=0.08)
    assert len(np.unique(np.sign(best), axis=0)) == 8


def test_a_bump_on_a_sphere_is_the_best_point(raised, sphere):
    top = trimesh.util.unitize(np.array([0.4, 0.5, 0.7]))
    bumped = raised([top], [0.12], [0.15], subdivisions=4)
    best = harris.points(bumped)[0]
    assert sphere(4).vertices[best] @ top > np.cos(0.05)


def test_points_are_one_of_each_cluster(round_cube):
    places = round_cube.vertices[harris.points(round_cube)]
    distance = np.linalg.norm(places[:, None] - places, axis=2) + np.eye(len(places))
    assert len(places) >= 8 and distance.min() > harris.SPACING * 2 * 3 ** (1 / 3)  # from corner to corner


def test_neighbourhoods_grow_until_they_reach_far_enough(sphere):
    ball = sphere(4)
    members = harris._neighbourhoods(ball, 0.25)
    for vertex in (0, 100, 2000):
        ring = 2
        while np.linalg.norm(ball.vertices[ball.rings([vertex], ring)] - ball.vertices[vertex], axis=1).max() < 0.25:
            ring += 1
        assert set(members[vertex].indices) == set(np.flatnonzero(ball.rings([vertex], ring))) and ring > 2

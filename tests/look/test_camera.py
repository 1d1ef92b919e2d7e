"""The camera of T3.2.6 and the rays through its pixels."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from haptic_glance.look.camera import Viewpoint, pixel_rays, pixels_per_unit, project
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene, barycentric

SIZE = (900, 1200)
angles = st.builds(Viewpoint, st.floats(-360, 360), st.floats(-90, 90), st.floats(-180, 180))


def test_pixels_per_unit_is_the_thesis_s():
    assert pixels_per_unit(900) == pytest.approx(858.7, abs=0.05)  # T eq. 3.11 at distance 10, 6 degrees


@pytest.mark.slow
@given(angles)
@settings(max_examples=50, deadline=None)
def test_camera_axes_are_a_rotation(viewpoint):
    np.testing.assert_allclose(viewpoint.axes @ viewpoint.axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(viewpoint.axes) == pytest.approx(1)


@given(angles, st.floats(0, 899), st.floats(0, 1199), st.floats(0, 20))
@settings(max_examples=50, deadline=None)
def test_projecting_a_point_on_a_pixel_s_ray_gives_the_pixel(viewpoint, row, column, depth):
    origins, directions = pixel_rays(np.array([row]), np.array([column]), viewpoint, SIZE)
    rows, columns, depths = project(origins + depth * directions, viewpoint, SIZE)
    np.testing.assert_allclose([rows[0], columns[0], depths[0]], [row, column, depth], atol=1e-8)


@pytest.mark.parametrize("angles", [(np.nan, 0), (0, np.inf), (0, 0, np.nan)])
def test_a_viewpoint_at_no_angle_is_named(angles):
    with pytest.raises(ValueError, match="a viewpoint has finite angles in degrees, got azimuth"):
        Viewpoint(*angles)


def test_up_is_up_and_left_turn_shows_the_right_side():
    rows, columns, _ = project(np.array([(0, 0, 0.4), (0, 0.4, 0)]), Viewpoint(0, 0), SIZE)
    assert rows[0] < 449 and columns[0] == pytest.approx(599.5)
    assert columns[1] > 600 and rows[1] == pytest.approx(449.5)


def test_rays_meet_a_sphere_where_geometry_says():
    sphere = trimesh.creation.icosphere(5, radius=0.5)
    mesh = Mesh(sphere.vertices, sphere.faces)
    viewpoint = Viewpoint(40, 20)
    hits = RayScene(mesh).cast(*pixel_rays(np.array([449.5, 0.0]), np.array([599.5, 0.0]), viewpoint, SIZE))
    assert hits.hit.tolist() == [True, False]
    assert hits.distance[0] == pytest.approx(9.5, abs=1e-3) and np.isinf(hits.distance[1])


def test_barycentric_coordinates_rebuild_the_point():
    mesh = Mesh(np.random.default_rng(0).normal(size=(9, 3)), np.arange(9).reshape(3, 3))
    weights = np.random.default_rng(1).dirichlet([1, 1, 1], size=3)
    points = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces])
    np.testing.assert_allclose(barycentric(mesh, np.arange(3), points), weights, atol=1e-9)


def test_rays_against_an_empty_mesh_miss():
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 3)))
    assert not RayScene(empty).cast(np.zeros((2, 3)), np.ones((2, 3))).hit.any()

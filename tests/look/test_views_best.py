"""The best set of views has the highest average level, with views added where rays find hidden surface."""

from collections import Counter

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import CANDIDATES, PERPENDICULAR_SETS, best_viewpoints, hidden_surface
from haptic_glance.look.views.best import BETWEEN
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, mesh_of

BALL = ball_mesh(3, 0.5)
ALONG, ACROSS = [Viewpoint(90, 0), Viewpoint(270, 0)], [Viewpoint(0, 0), Viewpoint(180, 0), Viewpoint(0, 90)]


@pytest.fixture(scope="module")
def row():
    """Three balls in a row along y: seen along y they hide each other, seen across it they do not."""
    balls = [trimesh.creation.icosphere(2, radius=0.1).apply_translation([0, y, 0]) for y in (-0.4, 0, 0.4)]
    return mesh_of(trimesh.util.concatenate(balls))


def flat_level(_):
    return 1.0


def test_a_convex_body_hides_nothing_and_gets_no_added_view():
    assert not hidden_surface(BALL, CANDIDATES).any()
    assert best_viewpoints(BALL, flat_level) == list(PERPENDICULAR_SETS[0])
    doubled = Mesh(BALL.vertices, np.r_[BALL.faces, BALL.faces[:, ::-1]])  # coincident faces count once
    assert not hidden_surface(doubled, CANDIDATES[::6]).any()


def test_things_in_a_row_hide_each_other_along_it_alone_whatever_their_size_and_winding(row):
    moved = Mesh(row.vertices * 1e-4 + 3, row.faces)
    odd = Mesh(np.r_[row.vertices, [[50, 50, 50]]], row.faces[:, ::-1])
    for mesh in (row, moved, odd):
        assert hidden_surface(mesh, ALONG).all() and not hidden_surface(mesh, ACROSS).any()


def test_the_added_view_stands_between_the_hiding_one_and_the_next(row):
    calls = Counter()

    def level(view):
        calls[view] += 1
        return 10.0 * (view in PERPENDICULAR_SETS[9]) + 1.0 * (view in BETWEEN[9])

    assert {view.name for view in PERPENDICULAR_SETS[9]} == {"az90_el0", "az0_el90", "az270_el0", "az0_el-90"}
    assert best_viewpoints(row, level) == [*PERPENDICULAR_SETS[9], Viewpoint(90, 45), Viewpoint(270, -45)]
    assert set(CANDIDATES) < set(calls) and set(calls.values()) == {1}


def test_added_views_count_in_the_average(row):
    """With poor added views, a set that needs none beats one whose four are a little better."""

    def level(view):
        return 10.0 * (view in PERPENDICULAR_SETS[9]) + 9.0 * (view in PERPENDICULAR_SETS[0])

    assert best_viewpoints(row, level) == list(PERPENDICULAR_SETS[0])


def test_equal_sets_go_by_order_whatever_the_rounding():
    for level in (lambda view: 0.1 + 1e-17 * view.azimuth, lambda view: 0.0):
        assert best_viewpoints(BALL, level) == list(PERPENDICULAR_SETS[0])


def test_the_rays_of_a_view_depend_on_the_seed_and_the_view_alone():
    torus = mesh_of(trimesh.creation.torus(0.4, 0.05, major_sections=32, minor_sections=12))
    views = [Viewpoint(azimuth, 8) for azimuth in range(0, 360, 10)]
    hidden = hidden_surface(torus, views, seed=3)
    assert 0 < hidden.sum() < len(views)
    assert (hidden_surface(torus, views[::-1], seed=3)[::-1] == hidden).all()
    assert (hidden_surface(torus, views, seed=4) != hidden).any()


def test_one_triangle_has_four_views_and_a_mesh_without_area_is_refused():
    corners = np.array([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]])
    assert best_viewpoints(Mesh(corners, np.array([[0, 1, 2]])), flat_level) == list(PERPENDICULAR_SETS[0])
    for vertices, faces in ((np.zeros((0, 3)), np.zeros((0, 3), dtype=int)), (corners[[0, 1, 1]], [[0, 1, 2]])):
        with pytest.raises(ValueError, match="no visible surface"):
            best_viewpoints(Mesh(vertices, faces), flat_level)

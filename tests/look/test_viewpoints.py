"""The camera of T3.2.6, the sets of viewpoints of T figure 3.2, and the 62 candidates that T3.2.4 counts."""

from collections import Counter

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint, pixel_rays, project
from haptic_glance.look.views import CANDIDATES, FOUR, PERPENDICULAR_SETS, TWELVE, viewpoint_set
from haptic_glance.look.views.best import BETWEEN, on_circle
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene, barycentric
from tests.shapes import mesh_of

SIZE = (900, 1200)
CAPTION = {  # T figure 3.2: turns of the object in degrees, around z, then around x
    "a": (0, 0), "b": (90, 0), "c": (180, 0), "d": (270, 0), "e": (0, 45), "f": (120, 45), "g": (240, 45),
    "h": (0, -45), "i": (120, -45), "j": (240, -45), "k": (90, 0), "l": (0, 180),
}  # fmt: skip


def backs(views):
    return np.array([view.axes[2] for view in views])


def test_camera_axes_are_a_rotation_and_a_point_on_a_pixel_s_ray_is_projected_to_the_pixel():
    draw = np.random.default_rng(0)
    for _ in range(20):
        viewpoint = Viewpoint(*draw.uniform([-360, -90, -180], [360, 90, 180]))
        np.testing.assert_allclose(viewpoint.axes @ viewpoint.axes.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(viewpoint.axes) == pytest.approx(1)
        row, column, depth = draw.uniform(0, [899, 1199, 20])
        origins, directions = pixel_rays(np.array([row]), np.array([column]), viewpoint, SIZE)
        projected = np.ravel(project(origins + depth * directions, viewpoint, SIZE))
        np.testing.assert_allclose(projected, [row, column, depth], atol=1e-8)


def test_up_is_up_and_left_turn_shows_the_right_side():
    rows, columns, _ = project(np.array([(0, 0, 0.4), (0, 0.4, 0)]), Viewpoint(0, 0), SIZE)
    assert rows[0] < 449 and columns[0] == pytest.approx(599.5)
    assert columns[1] > 600 and rows[1] == pytest.approx(449.5)


def test_rays_meet_a_sphere_where_geometry_says_and_an_empty_mesh_nowhere():
    mesh = mesh_of(trimesh.creation.icosphere(5, radius=0.5))
    rays = pixel_rays(np.array([449.5, 0.0]), np.array([599.5, 0.0]), Viewpoint(40, 20), SIZE)
    hits = RayScene(mesh).cast(*rays)
    assert hits.hit.tolist() == [True, False]
    assert hits.distance[0] == pytest.approx(9.5, abs=1e-3) and np.isinf(hits.distance[1])
    assert not RayScene(Mesh(np.zeros((0, 3)), np.zeros((0, 3)))).cast(*rays).hit.any()


def test_barycentric_coordinates_rebuild_the_point():
    mesh = Mesh(np.random.default_rng(0).normal(size=(9, 3)), np.arange(9).reshape(3, 3))
    weights = np.random.default_rng(1).dirichlet([1, 1, 1], size=3)
    points = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces])
    np.testing.assert_allclose(barycentric(mesh, np.arange(3), points), weights, atol=1e-9)


def test_unknown_viewpoints_and_sets_are_named():
    for angles in ((np.nan, 0), (0, np.inf), (0, 0, np.nan)):
        with pytest.raises(ValueError, match="a viewpoint has finite angles in degrees, got azimuth"):
            Viewpoint(*angles)
    with pytest.raises(ValueError, match="twelve, four, principal"):
        viewpoint_set("thirteen")


def test_four_stand_all_round_and_principal_views_at_both_ends_of_y_and_z():
    np.testing.assert_allclose(backs(FOUR), [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], atol=1e-12)
    principal = backs(viewpoint_set("principal")).round(9)
    np.testing.assert_allclose(sorted(principal.tolist()), [[0, -1, 0], [0, 0, -1], [0, 0, 1], [0, 1, 0]])


def camera_after(around_z, around_x):
    """Where the first camera stands as seen from the object, once that has turned; x: to the right of the image."""
    right, _, back = TWELVE[0].axes
    z, x = np.radians([around_z, around_x])
    up = np.array([0.0, 0.0, 1.0])
    tilted = np.cos(x) * back - np.sin(x) * np.cross(right, back)
    return np.cos(z) * tilted - np.sin(z) * np.cross(up, tilted) + (1 - np.cos(z)) * (up @ tilted) * up


def rounded(back):
    return tuple(back.round(9) + 0.0)


def test_ten_viewpoints_are_as_captioned_and_two_are_not():
    captioned = {letter: rounded(camera_after(*turns)) for letter, turns in CAPTION.items()}
    assert set(map(rounded, backs(TWELVE[:10]))) == {captioned[letter] for letter in "abcdefghij"}
    assert captioned["k"] == captioned["b"] and captioned["l"] == captioned["c"]  # as printed: no view of top or bottom
    assert set(map(rounded, backs(TWELVE[10:]))) == {rounded(camera_after(0, turn)) for turn in (90, -90)}


def test_ten_of_the_72_views_of_18_different_sets_are_repetitions_at_the_poles():
    assert [len(views) for views in PERPENDICULAR_SETS] == [4] * 18
    assert len({frozenset(views) for views in PERPENDICULAR_SETS}) == 18
    times = Counter(view for views in PERPENDICULAR_SETS for view in views)
    assert set(CANDIDATES) == set(times) and len({view.name for view in CANDIDATES}) == len(CANDIDATES) == 62
    assert {view.elevation: count for view, count in times.items() if count > 1} == {90: 6, -90: 6}
    assert Counter(view.elevation for view in CANDIDATES) == {el: 12 for el in (-60, -30, 0, 30, 60)} | {90: 1, -90: 1}
    assert {view.azimuth for view in CANDIDATES} == set(range(0, 360, 30))


def test_the_views_of_a_set_are_perpendicular_in_turn_and_added_views_stand_half_way_between_two():
    for views, between in zip(PERPENDICULAR_SETS, BETWEEN, strict=True):
        looks, turn = backs(views), np.roll(backs(views), -1, axis=0)
        np.testing.assert_allclose(np.einsum("ij,ij->i", looks, turn), 0, atol=1e-12)
        np.testing.assert_allclose(looks, -np.roll(turn, -1, axis=0), atol=1e-12)
        axis = np.cross(looks[0], looks[1])
        assert np.allclose(looks @ axis, 0) and np.isclose(axis[2], 0)
        for neighbours in (looks, turn):
            np.testing.assert_allclose(np.einsum("ij,ij->i", neighbours, backs(between)), np.cos(np.radians(45)))
        for view in (*views, *between):
            assert -90 <= view.elevation <= 90 and 0 <= view.azimuth < 360 and view.roll == 0
    principal = {rounded(end) for end in np.vstack([np.eye(3)[1:], -np.eye(3)[1:]])}
    assert sum(set(map(rounded, backs(views))) == principal for views in PERPENDICULAR_SETS) == 1


@pytest.mark.parametrize(
    "angle, expected", [(0, (30, 0)), (60, (30, 60)), (90, (0, 90)), (120, (210, 60)), (180, (210, 0)),
                        (210, (210, -30)), (270, (0, -90)), (315, (30, -45)), (405, (30, 45))]
)  # fmt: skip
def test_a_circle_passes_over_both_poles(angle, expected):
    view = on_circle(30, angle)
    assert (view.azimuth, view.elevation) == expected

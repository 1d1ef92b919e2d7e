"""What views see of shapes where the answer is known, and that no fewer views would do."""

from functools import reduce
from itertools import combinations
from operator import or_

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import CANDIDATES, cumulative_coverage, fewest_views, greedy_views, point_visibility
from haptic_glance.look.views.best import POINTS, _fewest, _greedy, surface_points
from haptic_glance.mesh.mesh import Mesh

ABOVE, BELOW, FRONT = Viewpoint(0, 90), Viewpoint(0, -90), Viewpoint(0, 0)


def as_mesh(shape):
    return Mesh(shape.vertices, shape.faces)


def cup(wall=0.02):
    """A thick-walled open cup, bottom down, revolved from its outline (radius, height)."""
    outline = [(0, -0.3), (0.2, -0.3), (0.2, 0.3), (0.2 - wall, 0.3), (0.2 - wall, -0.3 + wall), (0, -0.3 + wall)]
    return as_mesh(trimesh.creation.revolve(np.array(outline), sections=64))


@pytest.fixture(scope="module")
def shapes():
    shells = [trimesh.creation.icosphere(subdivisions=3, radius=radius) for radius in (0.5, 0.4)]
    return {
        "sphere": as_mesh(trimesh.creation.icosphere(subdivisions=4, radius=0.5)),
        "cube": as_mesh(trimesh.creation.box(extents=[0.5, 0.5, 0.5])),
        "torus": as_mesh(trimesh.creation.torus(0.3, 0.15, major_sections=64, minor_sections=32)),
        "shells": as_mesh(trimesh.util.concatenate(shells)),
        "cup": cup(),
    }


def test_points_lie_on_their_faces_in_proportion_to_area(shapes):
    mesh = shapes["cup"]
    points, faces = surface_points(mesh)
    counts = np.bincount(faces, minlength=len(mesh.faces))
    assert np.abs(counts - mesh.face_areas / mesh.face_areas.sum() * POINTS).max() < 1 + 1e-6
    height = np.einsum("ij,ij->i", points - mesh.vertices[mesh.faces[faces, 0]], mesh.face_normals[faces])
    assert np.abs(height).max() < 1e-12


def test_points_fill_a_face_evenly():
    triangle = Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    points, _ = surface_points(triangle)
    np.testing.assert_allclose(points.mean(axis=0), [1 / 3, 1 / 3, 0], atol=0.01)
    assert abs((points[:, :2].sum(axis=1) < 0.5).mean() - 0.25) < 0.02


@pytest.mark.slow
def test_a_view_sees_half_of_a_sphere_and_that_is_the_half_that_faces_it(shapes):
    sphere = shapes["sphere"]
    seen = point_visibility(sphere, CANDIDATES)
    np.testing.assert_allclose(seen.mean(axis=1), 0.5, atol=0.01)
    normals = sphere.face_normals[surface_points(sphere)[1]]
    facing = np.array([normals @ view.axes[2] for view in CANDIDATES])
    wrong = (seen != (facing > 0)) & (np.abs(facing) > 1e-3)  # faces seen edge-on may count either way
    assert not wrong[np.abs(facing) > 0.05].any()  # at the very limb, front and back are nearer than SAME_DEPTH
    assert wrong.mean() < 1e-4


def test_a_face_of_a_cube_is_a_sixth_and_a_corner_view_sees_a_half(shapes):
    shares = point_visibility(shapes["cube"], [FRONT, Viewpoint(45, 0), Viewpoint(30, 30)]).mean(axis=1)
    np.testing.assert_allclose(shares, [1 / 6, 2 / 6, 3 / 6], atol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sphere", "cube"])
def test_two_opposite_views_see_all_of_a_convex_body(shapes, name):
    views, shares = fewest_views(shapes[name])
    assert len(views) == 2 and shares[-1] >= 0.99
    assert views[0].axes[2] @ views[1].axes[2] == pytest.approx(-1)


def test_a_torus_is_seen_from_both_sides_of_its_hole(shapes):
    assert cumulative_coverage(shapes["torus"], [ABOVE, BELOW])[-1] > 0.99
    assert cumulative_coverage(shapes["torus"], [FRONT, Viewpoint(180, 0)])[-1] < 0.9


@pytest.mark.slow
def test_an_inner_shell_is_not_visible_and_does_not_count(shapes):
    points, _ = surface_points(shapes["shells"])
    seen = point_visibility(shapes["shells"], CANDIDATES).any(axis=0)
    assert (seen == (np.linalg.norm(points, axis=1) > 0.45)).mean() > 0.999
    assert len(fewest_views(shapes["shells"])[0]) == 2


def test_the_floor_of_a_cup_is_seen_from_above_alone(shapes):
    points, _ = surface_points(shapes["cup"])
    floor = (np.abs(points[:, 2] + 0.28) < 1e-6) & (np.hypot(*points[:, :2].T) < 0.17)
    assert floor.sum() > 50
    by_view = point_visibility(shapes["cup"], CANDIDATES)[:, floor].any(axis=1)
    elevation = np.array([view.elevation for view in CANDIDATES])
    assert by_view[elevation == 90].all() and not by_view[elevation < 60].any()


def test_the_fewest_views_of_a_cup_look_into_it(shapes):
    views, _ = fewest_views(shapes["cup"])
    assert max(view.elevation for view in views) >= 30


def test_what_a_nearer_sheet_covers_is_not_seen():
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    corners = np.r_[np.c_[np.full(4, 0.1), square / 8], np.c_[np.full(4, -0.1), square / 4]]
    mesh = Mesh(corners, np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]))
    share = point_visibility(mesh, [FRONT, Viewpoint(180, 0)]).mean(axis=1)
    np.testing.assert_allclose(share, [4 / 5, 4 / 5], atol=0.005)
    assert point_visibility(mesh, [FRONT, Viewpoint(180, 0)]).any(axis=0).all()


def test_shares_never_fall_and_each_view_adds_less_than_the_one_before(shapes):
    _, shares = greedy_views(shapes["cup"])
    gains = np.diff(shares, prepend=0)
    assert (gains > 0).all() and (np.diff(gains) <= 1e-12).all() and shares[-1] <= 1


def test_the_shares_are_those_of_the_views_named(shapes):
    views, shares = greedy_views(shapes["cup"], 5)
    np.testing.assert_allclose(cumulative_coverage(shapes["cup"], views), shares)
    views, shares = fewest_views(shapes["cup"])
    np.testing.assert_allclose(cumulative_coverage(shapes["cup"], views), shares)


def test_all_candidates_together_see_all_that_is_visible(shapes):
    assert cumulative_coverage(shapes["cup"], CANDIDATES)[-1] == 1
    assert fewest_views(shapes["cup"], 1.0)[1][-1] == pytest.approx(1)


def test_a_smaller_share_needs_no_more_views(shapes):
    numbers = [len(fewest_views(shapes["cup"], share)[0]) for share in (0.3, 0.6, 0.9, 0.99)]
    assert numbers == sorted(numbers) and numbers[0] == 1


def test_the_fewest_number_is_that_of_trying_all_subsets():
    rng, saved = np.random.default_rng(5), []
    for _ in range(20):
        seen = rng.random((16, 80)) < 0.25
        seen = seen[:, seen.any(axis=0)]
        found, shares = _fewest(seen, 0.95)
        assert seen[found].any(axis=0).mean() == pytest.approx(shares[-1]) and shares[-1] >= 0.95
        bits = [int("".join("01"[point] for point in row), 2) for row in seen.astype(int)]
        smaller = combinations(bits, len(found) - 1)
        assert max(reduce(or_, subset).bit_count() for subset in smaller) < 0.95 * seen.shape[1]
        saved.append(len(_greedy(seen, 0.95, 16)[0]) - len(found))
    assert max(saved) > 0  # greed does not find them all


def test_greed_can_be_beaten():
    """The middle row takes most and leaves two ends; the two others alone cover all."""
    seen = np.zeros((3, 12), dtype=bool)
    seen[0, 2:10] = seen[1, :6] = seen[2, 6:] = True
    assert len(_greedy(seen, 1.0, 3)[0]) == 3 and sorted(_fewest(seen, 1.0)[0]) == [1, 2]


@pytest.mark.slow
def test_vertex_order_size_and_place_do_not_matter(shapes):
    mesh = shapes["cup"]
    order = np.random.default_rng(2).permutation(len(mesh.vertices))
    shuffled = Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces])
    assert (point_visibility(shuffled, CANDIDATES) == point_visibility(mesh, CANDIDATES)).mean() > 0.9999
    moved = Mesh(mesh.vertices * 1e-3 - 2, mesh.faces)
    assert (point_visibility(moved, CANDIDATES) == point_visibility(mesh, CANDIDATES)).mean() > 0.9999


def test_turning_the_mesh_and_the_camera_together_changes_nothing(shapes):
    mesh = shapes["torus"]
    turn = trimesh.transformations.rotation_matrix(np.pi / 2, [0, 0, 1])[:3, :3]
    turned = Mesh(mesh.vertices @ turn.T, mesh.faces)
    views = [Viewpoint(azimuth, 30) for azimuth in range(0, 360, 30)]
    after = [Viewpoint(view.azimuth + 90, view.elevation) for view in views]
    assert (point_visibility(turned, after) == point_visibility(mesh, views)).mean() > 0.9999


@pytest.mark.slow
def test_inward_normals_doubled_faces_and_stray_vertices_do_not_matter(shapes):
    mesh = shapes["cup"]
    inward = Mesh(np.r_[mesh.vertices, [[9, 9, 9]]], mesh.faces[:, ::-1])
    assert len(fewest_views(inward)[0]) == len(fewest_views(mesh)[0])
    doubled = Mesh(mesh.vertices, np.r_[mesh.faces, mesh.faces[:, ::-1]])
    found, expected = (point_visibility(each, CANDIDATES).mean(axis=1) for each in (doubled, mesh))
    np.testing.assert_allclose(found, expected, atol=0.015)


@pytest.mark.slow
@pytest.mark.parametrize("mesh", [
    Mesh(np.array([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]]), np.array([[0, 1, 2]])),
    Mesh(np.array([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0], [9, 9, 9], [9.5, 9, 9], [9, 9.5, 9]]),
         np.array([[0, 1, 2], [3, 4, 5]])),
], ids=["one triangle", "two far apart"])  # fmt: skip
def test_flat_things_need_one_view(mesh):
    views, shares = fewest_views(mesh)
    assert len(views) == 1 and shares == [1]


@pytest.mark.parametrize("question", [lambda mesh: point_visibility(mesh, [FRONT]), fewest_views, greedy_views,
                                      lambda mesh: cumulative_coverage(mesh, [FRONT])])  # fmt: skip
def test_a_mesh_without_area_is_refused(question):
    with pytest.raises(ValueError, match="no visible surface"):
        question(Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]])))


@pytest.mark.parametrize("share", [0, -0.5, 1.5, np.nan])
def test_a_share_outside_its_range_is_refused(shapes, share):
    with pytest.raises(ValueError, match="share must be above 0"):
        fewest_views(shapes["cube"], share)


def test_a_count_below_one_is_refused(shapes):
    with pytest.raises(ValueError, match="count must be"):
        greedy_views(shapes["cube"], 0)

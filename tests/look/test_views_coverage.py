"""What views see of shapes where the answer is known, and that no fewer views would do."""

from functools import reduce
from itertools import combinations
from operator import or_

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import CANDIDATES, cumulative_coverage, fewest_views, greedy_views, point_visibility
from haptic_glance.look.views.coverage import POINTS, _fewest, _greedy, surface_points
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import mesh_of

FRONT = Viewpoint(0, 0)
SOME = CANDIDATES[::8]


@pytest.fixture(scope="module")
def shapes():
    shells = [trimesh.creation.icosphere(subdivisions=3, radius=radius) for radius in (0.5, 0.4)]
    outline = [(0, -0.3), (0.2, -0.3), (0.2, 0.3), (0.18, 0.3), (0.18, -0.28), (0, -0.28)]  # (radius, height)
    return {
        "sphere": mesh_of(trimesh.creation.icosphere(subdivisions=4, radius=0.5)),
        "cube": mesh_of(trimesh.creation.box(extents=[0.5, 0.5, 0.5])),
        "torus": mesh_of(trimesh.creation.torus(0.3, 0.15, major_sections=64, minor_sections=32)),
        "shells": mesh_of(trimesh.util.concatenate(shells)),
        "cup": mesh_of(trimesh.creation.revolve(np.array(outline), sections=64)),  # open, with a thick wall
    }


def test_points_lie_on_their_faces_in_proportion_to_area_and_fill_them_evenly(shapes):
    mesh = shapes["cup"]
    points, faces = surface_points(mesh)
    counts = np.bincount(faces, minlength=len(mesh.faces))
    assert np.abs(counts - mesh.face_areas / mesh.face_areas.sum() * POINTS).max() < 1 + 1e-6
    height = np.einsum("ij,ij->i", points - mesh.vertices[mesh.faces[faces, 0]], mesh.face_normals[faces])
    assert np.abs(height).max() < 1e-12
    points, _ = surface_points(Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])))
    np.testing.assert_allclose(points.mean(axis=0), [1 / 3, 1 / 3, 0], atol=0.01)
    assert abs((points[:, :2].sum(axis=1) < 0.5).mean() - 0.25) < 0.02


def test_a_view_sees_the_half_of_a_sphere_that_faces_it(shapes):
    sphere = shapes["sphere"]
    seen = point_visibility(sphere, SOME)
    np.testing.assert_allclose(seen.mean(axis=1), 0.5, atol=0.01)
    normals = sphere.face_normals[surface_points(sphere)[1]]
    facing = np.array([normals @ view.axes[2] for view in SOME])
    wrong = (seen != (facing > 0)) & (np.abs(facing) > 1e-3)  # faces seen edge-on may count either way
    assert not wrong[np.abs(facing) > 0.05].any()  # at the very limb, front and back are nearer than SAME_DEPTH
    assert wrong.mean() < 1e-4


@pytest.mark.slow
def test_an_inner_shell_is_not_visible_and_does_not_count(shapes):
    points, _ = surface_points(shapes["shells"])
    seen = point_visibility(shapes["shells"], CANDIDATES).any(axis=0)
    assert (seen == (np.linalg.norm(points, axis=1) > 0.45)).mean() > 0.999
    views, shares = fewest_views(shapes["shells"])
    assert len(views) == 2 and shares[-1] >= 0.99 and views[0].axes[2] @ views[1].axes[2] == pytest.approx(-1)


def test_a_face_of_a_cube_is_a_sixth_and_a_corner_view_sees_a_half(shapes):
    shares = point_visibility(shapes["cube"], [FRONT, Viewpoint(45, 0), Viewpoint(30, 30)]).mean(axis=1)
    np.testing.assert_allclose(shares, [1 / 6, 2 / 6, 3 / 6], atol=1e-3)
    assert len(fewest_views(shapes["cube"])[0]) == 2


def test_shares_are_those_of_the_views_named_and_each_view_adds_less_than_the_one_before(shapes):
    views, shares = greedy_views(shapes["cup"])
    np.testing.assert_allclose(cumulative_coverage(shapes["cup"], views), shares)
    gains = np.diff(shares, prepend=0)
    assert (gains > 0).all() and (np.diff(gains) <= 1e-12).all() and shares[-1] <= 1
    assert len(greedy_views(shapes["cup"], 2)[0]) == 2
    fewest = {share: fewest_views(shapes["cup"], share) for share in (0.3, 0.9, 1.0)}
    numbers = [len(views) for views, _ in fewest.values()]
    assert numbers == sorted(numbers) and numbers[0] == 1
    views, shares = fewest[1.0]
    np.testing.assert_allclose(cumulative_coverage(shapes["cup"], views), shares)
    assert shares[-1] == pytest.approx(1) == cumulative_coverage(shapes["cup"], CANDIDATES)[-1]


def test_the_fewest_number_is_that_of_trying_all_subsets():
    rng, saved = np.random.default_rng(5), []
    for _ in range(10):
        seen = rng.random((16, 80)) < 0.25
        seen = seen[:, seen.any(axis=0)]
        chosen, shares = _fewest(seen, 0.95)
        assert seen[chosen].any(axis=0).mean() == pytest.approx(shares[-1]) and shares[-1] >= 0.95
        bits = [int("".join("01"[point] for point in row), 2) for row in seen.astype(int)]
        smaller = combinations(bits, len(chosen) - 1)
        assert max(reduce(or_, subset).bit_count() for subset in smaller) < 0.95 * seen.shape[1]
        saved.append(len(_greedy(seen, 0.95, 16)[0]) - len(chosen))
    assert max(saved) > 0  # greed does not find them all


def test_vertex_order_winding_size_place_and_turns_do_not_matter(shapes):
    mesh = shapes["torus"]
    order = np.random.default_rng(2).permutation(len(mesh.vertices))
    turn = trimesh.transformations.rotation_matrix(np.pi / 2, [0, 0, 1])[:3, :3]
    turned = Mesh((mesh.vertices @ turn.T * 1e-3 - 2), mesh.faces)
    untidy = Mesh(np.r_[mesh.vertices[order], [[9, 9, 9]]], np.argsort(order)[mesh.faces][:, ::-1])
    views = [Viewpoint(azimuth, 30) for azimuth in range(0, 360, 60)]
    after = [Viewpoint(view.azimuth + 90, view.elevation) for view in views]
    seen = point_visibility(mesh, views)
    assert (point_visibility(turned, after) == seen).mean() > 0.9999
    doubled = Mesh(mesh.vertices, np.r_[mesh.faces, mesh.faces[:, ::-1]])
    for other in (untidy, doubled):
        np.testing.assert_allclose(point_visibility(other, views).mean(axis=1), seen.mean(axis=1), atol=0.015)


@pytest.mark.parametrize(
    ("question", "says"),
    [
        (lambda mesh: fewest_views(Mesh(np.zeros((3, 3)), [[0, 1, 2]])), "no visible surface"),
        (lambda mesh: point_visibility(Mesh(np.zeros((3, 3)), [[0, 1, 2]]), [FRONT]), "no visible surface"),
        (lambda mesh: fewest_views(mesh, 0), "share must be above 0"),
        (lambda mesh: fewest_views(mesh, 1.5), "share must be above 0"),
        (lambda mesh: greedy_views(mesh, 0), "count must be"),
    ],
)
def test_bad_questions_are_refused(shapes, question, says):
    with pytest.raises(ValueError, match=says):
        question(shapes["cube"])
